// Tangents that a GPU began, for `darboux/webgpu`. Not part of the API.

import { choices, engine, report, surface } from './full.js';
import { floats, indexError, write, writeArrays } from './mesh.js';
import type * as types from '../types.js';

/** What shaders need to know of a mesh that has been checked. */
export interface Begun {
  vertices: number;
  indices: types.Indices;
  /** The cosine that they compare with. */
  thresholdCosine: number;
}

/** Parameters and errors as those of `generateTangents`; null for faces other than triangles. */
export function begin(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices | null | undefined,
  options: types.MikkTSpaceOptions,
): Begun | null {
  const given = surface(positions, normals, uvs, indices, options);
  const [, threshold, method] = choices(options);
  if (method) throw new RangeError("shaders have the method 'mikktspace' alone; leave the method out");
  if (given.faces !== 3) return null;
  const list = given.indices ?? Uint32Array.from({ length: given.corners }, (_, corner) => corner);
  const thresholdCosine = engine.call((exports) => exports.threshold_cosine(threshold));
  return { vertices: given.vertices, indices: list, thresholdCosine };
}

/**
 * Decides the vertices that shaders left open.
 *
 * @param indices As {@link begin} gave them. @param welded Of each vertex the first that equals it. @param begun Tangents, 4 per corner, signs of
 * zero where the vertex is open.
 * @returns All tangents, the report, and how many corners were decided here. @throws RangeError for an index out of range.
 */
export function complete(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices,
  options: types.MikkTSpaceOptions,
  welded: Uint32Array,
  begun: Float32Array,
): types.ReportedTangents & { corners: number } {
  const given = surface(positions, normals, uvs, indices, options);
  const [mode, threshold] = choices(options);
  return engine.call((exports) => {
    write(exports, given);
    writeArrays(exports, [[begun, exports.given_tangents(given.corners)]], [[welded, exports.welded_vertices(given.vertices)]]);
    const corners = exports.complete_tangents(mode, threshold);
    if (corners < 0) throw indexError(given);
    const tangents = floats(exports, exports.given_tangents(given.corners), 4 * given.corners);
    return { tangents, report: report(exports), corners };
  });
}
