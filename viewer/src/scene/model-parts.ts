// Divides a model into parts: its meshes, with one material each.

import {
  Box3,
  type BufferGeometry,
  InstancedBufferAttribute,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  type Object3D,
  SkinnedMesh,
  Vector3,
} from 'three';

import { originOf, type Origin } from '../files/origin';
import type { GivenSurface } from '../surface/surface';
import { floatsOf, type Attribute } from './attribute-floats';
import { morphedShape, skinOf } from './morph-and-skin';

/** A copy of a part in the scene. */
export interface Copy {
  /** The world matrix of the node; the identity for skinned meshes, which the joints place. */
  place: Matrix4;
  /** The matrices of instances, or null without instances. */
  instances: InstancedBufferAttribute | null;
}

/** A mesh of the model, in the pose of its scene. */
export interface Part {
  name: string;
  /** The primitive of the document; null where it is unknown. */
  origin: Origin | null;
  geometry: BufferGeometry;
  material: MeshStandardMaterial;
  /** The name of the attribute with the UVs of the normal map. */
  uvName: string;
  copies: Copy[];
  surface: GivenSurface;
  /** Whether three.js negated the normal map's green channel, as it does where there are no tangents. */
  isGreenNegated: boolean;
}

/** The parts of a model, in the order of the scene. Errors: there are none. */
export function partsOf(scene: Object3D): Part[] {
  scene.updateMatrixWorld(true);
  const parts: Part[] = [];
  scene.traverse((object) => {
    if (object instanceof Mesh && object.geometry.getAttribute('position')?.count) parts.push(...partsOfMesh(object));
  });
  if (!parts.length) throw new Error('The model has no triangles to show.');
  return parts;
}

function partsOfMesh(mesh: Mesh): Part[] {
  const materials = [mesh.material].flat();
  const geometry = mesh.geometry as BufferGeometry;
  const count = geometry.index?.count ?? geometry.getAttribute('position').count;
  const copies = copiesOf(mesh);
  if (!copies.length) return [];
  const ranges = materials.length > 1 ? geometry.groups : [{ start: 0, count, materialIndex: 0 }];
  return ranges.map(({ start, count, materialIndex }, at) => {
    const found = materials[materialIndex ?? 0];
    const material = found instanceof MeshStandardMaterial ? found : new MeshStandardMaterial({ roughness: 0.6 });
    const channel = material.normalMap?.channel ?? 0;
    const uvName = channel ? `uv${channel}` : 'uv';
    const surface = surfaceOf(mesh, uvName, start, count);
    const name = [mesh.name || 'mesh', ranges.length > 1 && (material.name || at + 1)].filter(Boolean).join(' / ');
    const isGreenNegated = !surface.tangents;
    const own = originOf(mesh);
    const origin = own && { ...own, primitive: own.primitive + (ranges.length > 1 ? at : 0) };
    return { name, origin, geometry, material, uvName, copies, surface, isGreenNegated };
  });
}

function surfaceOf(mesh: Mesh, uvName: string, start: number, count: number): GivenSurface {
  const geometry = mesh.geometry as BufferGeometry;
  const floats = (name: string, width: number) => {
    const attribute = geometry.getAttribute(name) as Attribute | undefined;
    return attribute ? floatsOf(attribute, width) : null;
  };
  const list = geometry.index;
  const whole = count - (count % 3);
  const indices = Uint32Array.from({ length: whole }, (_, corner) => (list ? list.getX(start + corner) : start + corner));
  const vectors = { positions: floats('position', 3)!, normals: floats('normal', 3), tangents: floats('tangent', 4) };
  return { ...vectors, uvs: floats(uvName, 2), indices, shape: morphedShape(mesh, vectors), skin: skinOf(mesh) };
}

/** The copies of a mesh. Mirrored instances are a copy of their own, because three.js derives the winding from the node's matrix alone. */
function copiesOf(mesh: Mesh): Copy[] {
  if (mesh instanceof SkinnedMesh) return [{ place: new Matrix4(), instances: null }];
  if (!(mesh instanceof InstancedMesh)) return [{ place: mesh.matrixWorld, instances: null }];
  const all = matricesOf(mesh.instanceMatrix);
  return [new Matrix4(), new Matrix4().makeScale(-1, 1, 1)].flatMap((mirror) => {
    // A reflection is its own inverse.
    const matrices = all.filter((matrix) => matrix.determinant() < 0 === mirror.determinant() < 0).map((matrix) => matrix.clone().premultiply(mirror));
    if (!matrices.length) return [];
    const instances = new InstancedBufferAttribute(new Float32Array(matrices.flatMap((matrix) => matrix.elements)), 16);
    return [{ place: mesh.matrixWorld.clone().multiply(mirror), instances }];
  });
}

function matricesOf(instances: InstancedBufferAttribute): Matrix4[] {
  return Array.from({ length: instances.count }, (_, at) => new Matrix4().fromArray(instances.array, at * 16));
}

/** The world matrix of every copy and instance of a part. */
export function placesOf({ copies }: Part): Matrix4[] {
  return copies.flatMap(({ place, instances }) => (instances ? matricesOf(instances).map((matrix) => matrix.premultiply(place)) : [place]));
}

/** The bounding box of all copies of a part whose vertices are at `positions`. */
export function boundsOfCopies(part: Part, positions: Float32Array): Box3 {
  const [all, own, point] = [new Box3(), new Box3(), new Vector3()];
  for (let at = 0; at < positions.length; at += 3) {
    point.fromArray(positions, at);
    if (Number.isFinite(point.x + point.y + point.z)) own.expandByPoint(point);
  }
  if (!own.isEmpty()) placesOf(part).forEach((place) => all.union(own.clone().applyMatrix4(place)));
  return all;
}

/** The smallest square that contains the unit square and all UVs: its left, its bottom and its side. */
export function uvSquare(parts: Part[]): [number, number, number] {
  let [left, bottom, right, top] = [0, 0, 1, 1];
  for (const { surface } of parts) {
    const uvs = surface.uvs ?? [];
    for (let at = 0; at < uvs.length; at += 2) {
      const [x, y] = [uvs[at], 1 - uvs[at + 1]];
      if (!Number.isFinite(x + y)) continue;
      [left, right, bottom, top] = [Math.min(left, x), Math.max(right, x), Math.min(bottom, y), Math.max(top, y)];
    }
  }
  return [left, bottom, Math.max(right - left, top - bottom)];
}
