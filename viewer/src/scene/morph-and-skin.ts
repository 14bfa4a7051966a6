// Reads morph targets and skins from three.js meshes.

import { Matrix4, type Mesh, SkinnedMesh, type BufferGeometry } from 'three';

import type { Shape, Skin } from '../surface/surface';
import { floatsOf, type Attribute } from './attribute-floats';

/** The key of the tangent offsets of morph targets in a geometry's user data. The loader stores them there, because three.js ignores them. */
export const TANGENT_TARGETS = 'tangentTargets';

/** The vertices after morph targets; null where all weights are 0. Offsets are relative, as in glTF. */
export function morphedShape(mesh: Mesh, { positions, normals, tangents }: Shape): Shape | null {
  const weights = mesh.morphTargetInfluences ?? [];
  if (!weights.some((weight) => weight !== 0)) return null;
  const { morphAttributes, userData } = mesh.geometry as BufferGeometry;
  const moved = (array: Float32Array, width: number, targets: (Attribute | undefined)[] | undefined) => {
    const out = array.slice();
    targets?.forEach((target, at) => {
      if (!target || !weights[at]) return;
      const offsets = floatsOf(target, 3);
      for (let vertex = 0; vertex < target.count; vertex++) {
        for (let i = 0; i < 3; i++) out[vertex * width + i] += weights[at] * offsets[vertex * 3 + i];
      }
    });
    return out;
  };
  return {
    positions: moved(positions, 3, morphAttributes.position),
    normals: normals && moved(normals, 3, morphAttributes.normal),
    tangents: tangents && moved(tangents, 4, userData[TANGENT_TARGETS]),
  };
}

/** The skin of a mesh; null without one. */
export function skinOf(mesh: Mesh): Skin | null {
  if (!(mesh instanceof SkinnedMesh)) return null;
  const [joints, weights] = ['skinIndex', 'skinWeight'].map((name) => floatsOf(mesh.geometry.getAttribute(name) as Attribute, 4));
  const { bones, boneInverses } = mesh.skeleton;
  const matrices = new Float32Array(bones.length * 16);
  bones.forEach((bone, at) => new Matrix4().multiplyMatrices(bone.matrixWorld, boneInverses[at]).toArray(matrices, at * 16));
  return { joints: Uint16Array.from(joints), weights, matrices };
}
