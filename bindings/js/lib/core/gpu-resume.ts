// Completes a run of MikkTSpace that a GPU started, for `darboux/webgpu`. Not part of the API.

import { fullModule, readReport, tangentMesh, tangentOptions } from './full.js';
import { indexError, readFloats, writeArrays, writeMesh } from './mesh.js';
import type * as types from '../types.js';

/** A checked mesh of triangles, as the shaders take it. */
export interface GpuInput {
  vertices: number;
  indices: types.Indices;
  /** The cosine of the angular threshold. */
  thresholdCosine: number;
}

/** Checks the arguments of `generateTangents`. Returns null for faces other than triangles. */
export function checkGpuInput(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices | null | undefined,
  options: types.MikkTSpaceOptions | null | undefined,
): GpuInput | null {
  const mesh = tangentMesh(positions, normals, uvs, indices, options);
  const [, threshold, method] = tangentOptions(options);
  if (method) throw new RangeError("the shaders compute the method 'mikktspace' only; leave the method out");
  if (mesh.faces !== 3) return null;
  const list = mesh.indices ?? Uint32Array.from({ length: mesh.corners }, (_, corner) => corner);
  const thresholdCosine = fullModule.call((exports) => exports.threshold_cosine(threshold));
  return { vertices: mesh.vertices, indices: list, thresholdCosine };
}

/**
 * Computes the tangents that the shaders left open.
 *
 * @param indices As {@link checkGpuInput} returned them.
 * @param welded For each vertex, the first vertex that equals it.
 * @param started Tangents of the shaders, 4 per corner; the sign is 0 where the tangent is open.
 * @returns All tangents, the report, and the number of corners computed here.
 * @throws RangeError for an index out of range.
 */
export function complete(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices,
  options: types.MikkTSpaceOptions | null | undefined,
  welded: Uint32Array,
  started: Float32Array,
): types.ReportedTangents & { corners: number } {
  const mesh = tangentMesh(positions, normals, uvs, indices, options);
  const [mode, threshold] = tangentOptions(options);
  return fullModule.call((exports) => {
    writeMesh(exports, mesh);
    const [tangentsAt, weldedAt] = [exports.given_tangents(mesh.corners), exports.welded_vertices(mesh.vertices)];
    writeArrays(exports, [[started, tangentsAt]], [[welded, weldedAt]]);
    const corners = exports.complete_tangents(mode, threshold);
    if (corners < 0) throw indexError(mesh);
    const tangents = readFloats(exports, exports.given_tangents(mesh.corners), 4 * mesh.corners);
    return { tangents, report: readReport(exports), corners };
  });
}
