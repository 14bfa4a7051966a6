// `transformFrames` and `skinFrames`: normals and tangents under matrices.

import { checkFrames, checkIndices, checkType, rowCount } from './checks.js';
import { fullModule, type FullExports } from './full.js';
import { readFloats, writeArrays, type Copy } from './mesh.js';
import type * as types from '../types.js';

/**
 * Transforms normals and tangents by a node's matrix, which may mirror or scale non-uniformly.
 *
 * Tangents transform by the matrix, normals by its inverse transpose, and w changes its sign where the matrix mirrors. A normal that the matrix
 * maps to zero does not change; a tangent that it maps to zero becomes a perpendicular of the normal.
 *
 * @param matrix 9 numbers (3 by 3) or 16 (4 by 4), by columns, as in glTF, three.js and WebGL.
 * @param normals 3 per vertex, of unit length.
 * @param tangents 4 per vertex: unit xyz and the sign w.
 * @throws TypeError for an array of another type. RangeError for lengths that do not fit together.
 */
export function transformFrames(matrix: ArrayLike<number>, normals: Float32Array, tangents: Float32Array): types.TransformedFrames {
  if (matrix?.length !== 9 && matrix?.length !== 16) throw new RangeError(`matrix has ${matrix?.length} numbers; it must have 9 or 16`);
  return movedFrames(normals, tangents, [linearPart(matrix, 0)], [], (exports) => ({ orientation: exports.transform_frames() as 1 | -1 }));
}

/**
 * Transforms normals and tangents by a skin: each by the weighted mean of its bones' matrices.
 *
 * The change of the weights over the surface is ignored, as is common practice, so normals of strongly bent skins are approximate. Source: B. Merry
 * et al., "Normal Transformations for Articulated Models", SIGGRAPH Sketches 2006.
 *
 * @param bones 16 per bone, by columns: its matrix from the pose of the given frames to the current pose.
 * @param joints The bones of each vertex, the same number for each.
 * @param weights The weight of each of these bones.
 * @param normals 3 per vertex, of unit length.
 * @param tangents 4 per vertex: unit xyz and the sign w.
 * @throws TypeError for an array of another type. RangeError for lengths that do not fit together, and for a joint that is no bone.
 */
export function skinFrames(
  bones: Float32Array,
  joints: types.Indices,
  weights: Float32Array,
  normals: Float32Array,
  tangents: Float32Array,
): types.MovedFrames {
  const [boneCount, vertices] = [rowCount('bones', bones, 16), checkFrames(normals, tangents)];
  checkIndices(joints, 'joints');
  checkType('weights', weights, ['Float32Array']);
  if (weights.length !== joints.length) throw new RangeError(`there are ${weights.length} weights but ${joints.length} joints`);
  const influences = vertices ? joints.length / vertices : 0;
  if (!Number.isInteger(influences) || (!vertices && joints.length)) {
    throw new RangeError(`there are ${joints.length} joints but ${vertices} vertices; give the same number of joints for each vertex`);
  }
  const wrong = joints.findIndex((joint) => joint >= boneCount);
  if (wrong >= 0) {
    throw new RangeError(`joint ${joints[wrong]} of vertex ${Math.floor(wrong / influences)} is out of range: there are ${boneCount} bones`);
  }
  const matrices = Array.from({ length: boneCount }, (_, bone) => linearPart(bones, 16 * bone));
  return movedFrames(normals, tangents, matrices, [joints, weights], (exports) => {
    exports.skin_frames(influences);
    return {};
  });
}

/** The upper left 3 by 3 of a matrix of 9 numbers, or of 16 from a place in the array on. */
function linearPart(numbers: ArrayLike<number>, from: number): number[] {
  const height = numbers.length === 9 ? 3 : 4;
  return [0, 1, 2].flatMap((column) => [0, 1, 2].map((row) => numbers[from + height * column + row]!));
}

/** Runs a function of WebAssembly that moves frames in place. `influences`: joints and weights, or nothing. */
function movedFrames<R extends object>(
  normals: Float32Array,
  tangents: Float32Array,
  matrices: number[][],
  influences: [] | [types.Indices, Float32Array],
  move: (exports: FullExports) => R,
): types.MovedFrames & R {
  const count = checkFrames(normals, tangents);
  const [joints, weights] = influences;
  return fullModule.call((exports) => {
    const [normalsAt, tangentsAt] = [exports.normals(count), exports.given_tangents(count)];
    const floats: Copy<Float32Array>[] = [
      [normals, normalsAt],
      [tangents, tangentsAt],
      [Float32Array.from(matrices.flat()), exports.matrices(matrices.length)],
    ];
    if (weights) floats.push([weights, exports.weights(weights.length)]);
    writeArrays(exports, floats, joints ? [[joints, exports.joints(joints.length)]] : []);
    const result = move(exports);
    return { normals: readFloats(exports, normalsAt, 3 * count), tangents: readFloats(exports, tangentsAt, 4 * count), ...result };
  });
}
