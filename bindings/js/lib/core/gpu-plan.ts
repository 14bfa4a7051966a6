// `planTopology`: the part of a mesh that does not move, as arrays for the shaders of `darboux/webgpu`.

import { fullModule, tangentMesh, tangentOptions, type FullExports } from './full.js';
import { indexError, writeMesh } from './mesh.js';
import type * as types from '../types.js';

/** The largest number of triangles that one thread of a shader sums. */
const MAX_MEMBERS = 2 ** 15;

/**
 * Groups a mesh of triangles once, for the `Planner` of `darboux/webgpu`, which evaluates its tangents wherever its vertices are.
 *
 * Parameters and errors are those of `generateTangents`; also RangeError for faces other than triangles, for methods other than
 * 'mikktspace' and for vertices of more than 32,768 triangles.
 */
export function planTopology(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: types.Indices | null,
  options?: types.TangentOptions | null,
): types.PlanTopology {
  const mesh = tangentMesh(positions, normals, uvs, indices, options);
  const [mode, threshold, method] = tangentOptions(options);
  if (mesh.faces !== 3) throw new RangeError('the shaders take triangles; triangulate the faces first');
  if (method) throw new RangeError(`the shaders cannot plan the method '${options!.method}'; leave the method out`);
  return fullModule.call((exports) => {
    writeMesh(exports, mesh);
    const members = exports.plan_topology(mode, threshold, MAX_MEMBERS);
    if (members < 0) throw indexError(mesh);
    if (members > 0) throw new RangeError(`${members} triangles or more share one tangent, and a shader sums ${MAX_MEMBERS}; use Plan`);
    const [counts, triangles, representatives, sums, sumOfCorner, sumOfVertex] = readArrays(exports);
    exports.free_gpu_plan();
    const [triangleCount, degenerateCount, sumCount, repairs, splitVertices] = counts as unknown as [number, number, number, number, number];
    return {
      ...{ vertexCount: mesh.vertices, cornerCount: mesh.corners, triangleCount, degenerateCount, sumCount },
      ...{ repairs: repairs === 1, splitVertices, triangles, representatives, sums, sumOfCorner, sumOfVertex },
    };
  });
}

type Words = Uint32Array<ArrayBuffer>;

/** Copies of the six arrays of a plan. */
function readArrays(exports: FullExports): [Words, Words, Words, Words, Words, Words] {
  const read = (array: number) =>
    new Uint32Array(exports.memory.buffer, exports.gpu_plan_array(array) >>> 0, exports.gpu_plan_array_len(array)).slice();
  return [read(0), read(1), read(2), read(3), read(4), read(5)];
}
