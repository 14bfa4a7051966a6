// `darboux/tangents`: MikkTSpace alone.

import { load, type Exports } from './core/wasm-module.js';
import { checkOut, choice, degrees, floats, indexError, mesh, write } from './core/mesh.js';
import type { Indices, MikkTSpaceOptions } from './types.js';
import simd from './wasm/tangents.simd.wasm';

export type * from './types.js';

interface TangentExports extends Exports {
  generate_tangents(mode: number, threshold: number): number;
}

const MODES = ['reference', 'repaired', 'corrected'] as const;

const engine = load<TangentExports>(simd, () => import('./tangents.scalar.js'));

/** Resolves when {@link generateTangents} may be called. */
export const ready: Promise<void> = engine.ready;

/**
 * The tangent of every corner: unit xyz and the sign w, bitangent = w * cross(normal, xyz). The sign is MikkTSpace's for the UVs as given.
 *
 * These are not vertex tangents: corners of one vertex may disagree, as at mirrored seams. Without indices they are the vertices' own.
 *
 * @param positions 3 per vertex, any values.
 * @param normals 3 per vertex, used as given; they should be unit length.
 * @param uvs 2 per vertex.
 * @param indices The vertex of each corner; without, every vertex is a corner of its own.
 * @param out Receives the tangents, 4 per corner, and is returned: arrays that are used again cost less than new ones.
 * @returns 4 per corner.
 * @throws TypeError for arrays of another kind; RangeError for lengths that differ, an index out of range, corners that are not whole faces.
 */
export function generateTangents<Out extends Float32Array = Float32Array<ArrayBuffer>>(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: Indices | null,
  options: MikkTSpaceOptions = {},
  out?: Out,
): Out {
  const given = mesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, options.faces);
  const mode = choice('mode', options.mode ?? 'repaired', MODES);
  const threshold = degrees('threshold', options.threshold);
  if (out) checkOut(out, given.corners);
  return engine.call((exports) => {
    write(exports, given);
    const place = exports.generate_tangents(mode, threshold);
    if (!place) throw indexError(given);
    return floats(exports, place, 4 * given.corners, out);
  });
}
