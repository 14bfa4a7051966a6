// A mesh as the caller passes it: checked here, then copied into the memory of a WebAssembly instance.

import { checkFaces, checkIndices, rowCount } from './checks.js';
import type { Exports } from './wasm-module.js';
import type { Faces, Indices } from '../types.js';

/** Corner numbers have 30 bits. */
const MAX_CORNERS = 2 ** 30 - 1;

/** An array of floats per vertex, beside the positions: its name, the floats, and the number of floats per vertex. */
type Attribute = readonly ['normals' | 'uvs', Float32Array, number];

/** A mesh whose arrays fit together. Only indices may still be out of range. */
export interface Mesh {
  positions: Float32Array;
  attributes: readonly Attribute[];
  indices: Indices | null;
  faces: Faces;
  vertices: number;
  corners: number;
}

/** Errors: TypeError for arrays of another type, RangeError for lengths that do not fit together. */
export function checkedMesh(
  positions: Float32Array,
  attributes: readonly Attribute[],
  indices: Indices | null | undefined,
  faceSizes: Faces | null | undefined,
): Mesh {
  const vertices = rowCount('positions', positions, 3);
  for (const [name, array, width] of attributes) {
    const rows = rowCount(name, array, width);
    if (rows !== vertices) {
      throw new RangeError(`${name} has ${rows} elements but there are ${vertices} positions; give one per vertex`);
    }
  }
  if (indices) checkIndices(indices);
  const corners = indices?.length ?? vertices;
  const largest = Math.max(corners, vertices);
  if (largest > MAX_CORNERS) throw new RangeError(`${largest} corners are too many: the limit is ${MAX_CORNERS}; split the mesh`);
  const faces = faceSizes ?? 3;
  checkFaces(faces, corners);
  return { positions, attributes, indices: indices ?? null, faces, vertices, corners };
}

/** Copies a mesh into the memory of an instance. */
export function writeMesh(exports: Exports, mesh: Mesh): void {
  const { positions, attributes, vertices, indices, corners } = mesh;
  const faces = mesh.faces === 4 ? new Uint32Array(corners / 4).fill(4) : mesh.faces;
  exports.begin();
  const floats: Copy<Float32Array>[] = [[positions, exports.positions(vertices)]];
  for (const [name, array] of attributes) floats.push([array, exports[name](vertices)]);
  const integers: Copy<Indices>[] = [];
  if (indices) integers.push([indices, exports.indices(corners)]);
  if (faces !== 3) integers.push([faces, exports.face_sizes(faces.length)]);
  writeArrays(exports, floats, integers);
}

/** An array, and the address in the instance's memory that it is copied to. */
export type Copy<A> = readonly [array: A, address: number];

/**
 * Copies arrays into the memory of an instance. All addresses are asked for before the first copy, because memory moves when it grows.
 * Numbers of WebAssembly are signed, so addresses beyond 2 GiB are negative here.
 */
export function writeArrays(exports: Exports, floats: readonly Copy<Float32Array>[], integers: readonly Copy<Indices>[] = []): void {
  const { buffer } = exports.memory;
  for (const [array, address] of floats) new Float32Array(buffer, address >>> 0, array.length).set(array);
  for (const [array, address] of integers) new Uint32Array(buffer, address >>> 0, array.length).set(array);
}

/** Copies texts into the memory of an instance, one behind the other. Returns the number of bytes of the first. */
export function writeTexts(exports: Exports, texts: readonly string[], reserve: (bytes: number) => number): number {
  const encoded = texts.map((text) => new TextEncoder().encode(text));
  let address = reserve(encoded.reduce((sum, { length }) => sum + length, 0)) >>> 0;
  for (const bytes of encoded) {
    new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
    address += bytes.length;
  }
  return encoded[0]!.length;
}

/** A copy of floats in the memory of an instance, in `out` where there is one. */
export function readFloats<A extends Float32Array = Float32Array<ArrayBuffer>>(
  exports: Exports,
  address: number,
  length: number,
  out?: A | null,
): A {
  const result = new Float32Array(exports.memory.buffer, address >>> 0, length);
  if (!out) return result.slice() as Float32Array as A;
  out.set(result);
  return out;
}

/** The error for a mesh that WebAssembly refused: all else has been checked, so an index is out of range. */
export function indexError({ indices, vertices }: Pick<Mesh, 'indices' | 'vertices'>): RangeError {
  const at = indices!.findIndex((index) => index >= vertices);
  return new RangeError(`index ${indices![at]} at place ${at} is out of range: there are ${vertices} vertices`);
}
