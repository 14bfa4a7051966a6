// `darboux/tangents`: MikkTSpace alone, in a WebAssembly module a third of the size.

import { MODES } from './core/choices.js';
import { checkOut, choice, degrees, optionsOf } from './core/checks.js';
import { checkedMesh, indexError, readFloats, writeMesh } from './core/mesh.js';
import { load, type Exports } from './core/wasm-module.js';
import type { Indices, MikkTSpaceOptions } from './types.js';
import simd from './wasm/tangents.simd.wasm';

export type * from './types.js';

interface TangentExports extends Exports {
  generate_tangents(mode: number, threshold: number): number;
}

const smallModule = load<TangentExports>(simd, () => import('./tangents.scalar.js'));

/** Resolves when {@link generateTangents} can be called. */
export const ready: Promise<void> = smallModule.ready;

/**
 * Computes the tangent of every corner: unit xyz and the sign w, with bitangent = w * cross(normal, xyz). The sign is that of MikkTSpace
 * for the UVs as given.
 *
 * Corners of one vertex may have different tangents, as at mirrored seams. Without indices, every corner is a vertex.
 *
 * @param positions 3 per vertex, any values.
 * @param normals 3 per vertex, used as given. They should have unit length.
 * @param uvs 2 per vertex.
 * @param indices The vertex of each corner. Without indices, the corners are the vertices in order.
 * @param options May be left out, undefined or null, and so may each option.
 * @param out Receives the tangents, 4 per corner, and is returned. Reusing an array is faster than allocating one.
 * @returns 4 per corner.
 * @throws TypeError for an array of another type. RangeError for lengths that do not fit together, for an index out of range, and for a
 * number of corners that is not a multiple of the face size.
 */
export function generateTangents<Out extends Float32Array = Float32Array<ArrayBuffer>>(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: Indices | null,
  options?: MikkTSpaceOptions | null,
  out?: Out | null,
): Out {
  const given = optionsOf(options);
  const mesh = checkedMesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, given.faces);
  const mode = choice('mode', given.mode, MODES, 'repaired');
  const threshold = degrees('threshold', given.threshold);
  if (out) checkOut(out, mesh.corners);
  return smallModule.call((exports) => {
    writeMesh(exports, mesh);
    const address = exports.generate_tangents(mode, threshold);
    if (!address) throw indexError(mesh);
    return readFloats(exports, address, 4 * mesh.corners, out);
  });
}
