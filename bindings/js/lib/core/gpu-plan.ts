// What of a mesh does not move.

import { choices, engine, surface, type AllExports } from './full.js';
import { indexError, write } from './mesh.js';
import type * as types from '../types.js';

/** Triangles of one sum that a thread adds up at most. */
const MOST_MEMBERS = 2 ** 15;

/**
 * The groups of a mesh of triangles, for `Planner` of `darboux/webgpu`, which evaluates its tangents wherever its vertices are.
 *
 * Parameters and errors as those of `generateTangents`; besides RangeError for faces other than triangles, methods other than 'mikktspace'
 * and vertices of more than 32,768 triangles.
 */
export function planTopology(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: types.Indices | null,
  options: types.TangentOptions = {},
): types.PlanTopology {
  const given = surface(positions, normals, uvs, indices, options);
  const [mode, threshold, method] = choices(options);
  if (given.faces !== 3) throw new RangeError('shaders take triangles; give the triangles that are drawn');
  if (method) throw new RangeError(`the method '${options.method}' has no plan for shaders; leave it out`);
  return engine.call((exports) => {
    write(exports, given);
    const members = exports.plan_topology(mode, threshold, MOST_MEMBERS);
    if (members < 0) throw indexError(given);
    if (members > 0) throw new RangeError(`${members} triangles or more share one tangent; shaders take ${MOST_MEMBERS}: use Plan`);
    const list = (at: number) => copied(exports, at);
    const [counts, triangles, representatives, sums, sumOfCorner, sumOfVertex] = [list(0), list(1), list(2), list(3), list(4), list(5)];
    exports.free_gpu_plan();
    const [triangleCount, degenerateCount, sumCount, repairs, splitVertices] = counts as unknown as [number, number, number, number, number];
    return {
      ...{ vertexCount: given.vertices, cornerCount: given.corners, triangleCount, degenerateCount, sumCount },
      ...{ repairs: repairs === 1, splitVertices, triangles, representatives, sums, sumOfCorner, sumOfVertex },
    };
  });
}

function copied(exports: AllExports, list: number): Uint32Array<ArrayBuffer> {
  return new Uint32Array(exports.memory.buffer, exports.gpu_plan_array(list) >>> 0, exports.gpu_plan_array_len(list)).slice();
}
