// Where meshes of the scene come from: the primitive of the glTF document that the check and the export read.

import type { Mesh } from 'three';

/** Indices in the document: of a mesh, of its primitive, and of its material, if it has one. */
export interface Origin {
  mesh: number;
  primitive: number;
  material: number | null;
}

/** The key of the origin in an object's user data. */
const KEY = 'darbouxOrigin';

/** Stores the origin of a mesh. */
export function setOrigin(mesh: Mesh, origin: Origin): void {
  mesh.userData[KEY] = origin;
}

/** The origin of a mesh; null where it is unknown. */
export function originOf(mesh: Mesh): Origin | null {
  return mesh.userData[KEY] ?? null;
}
