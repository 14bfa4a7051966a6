// A mesh as it is given: checked, then written to where the WebAssembly side reads it.

import type { Exports } from './wasm-module.js';
import type { Faces, Indices } from '../types.js';

/** Ids of corners have 30 bits. */
const MAX_CORNERS = 2 ** 30 - 1;

/** Floats of vertices beside the positions: their name, the array, and how many each vertex has. */
type Attribute = readonly ['normals' | 'uvs', Float32Array, number];

/** A mesh whose arrays fit together. */
export interface Mesh {
  positions: Float32Array;
  attributes: readonly Attribute[];
  indices: Indices | null;
  faces: Faces;
  vertices: number;
  corners: number;
}

/** Errors: TypeError for arrays of another kind, RangeError for lengths that do not fit together. */
export function mesh(
  positions: Float32Array,
  attributes: readonly Attribute[],
  indices: Indices | null = null,
  faces: Faces = 3,
): Mesh {
  const vertices = rows('positions', positions, 3);
  for (const [name, array, width] of attributes) {
    const found = rows(name, array, width);
    if (found !== vertices) {
      throw new RangeError(`${name} has ${found} elements but there are ${vertices} positions; give one per vertex`);
    }
  }
  if (indices) checkIndices(indices);
  const corners = indices?.length ?? vertices;
  const most = Math.max(corners, vertices);
  if (most > MAX_CORNERS) throw new RangeError(`${most} corners are too many: the limit is ${MAX_CORNERS}; split the mesh`);
  checkFaces(faces, corners);
  return { positions, attributes, indices, faces, vertices, corners };
}

/** Errors: another kind of array. */
export function checkIndices(indices: Indices): void {
  must('indices', indices, ['Uint32Array', 'Uint16Array', 'Uint8Array']);
}

/** The number of elements. Errors: another kind of array, elements that are not whole. */
export function rows(name: string, array: Float32Array, width: number): number {
  must(name, array, ['Float32Array']);
  return whole(name, array, width);
}

/** The number of elements. Errors: they are not whole. */
export function whole(name: string, array: { length: number }, width: number): number {
  const count = array.length / width;
  if (Number.isInteger(count)) return count;
  throw new RangeError(`${name} has a length of ${array.length}, which is not a whole number of ${width}-component elements`);
}

/** Arrays of other realms (frames, workers) are as good, so the name decides. */
export function must(name: string, value: unknown, kinds: string[]): void {
  const kind = Object.prototype.toString.call(value).slice(8, -1);
  if (!kinds.includes(kind)) throw new TypeError(`${name} must be a ${kinds.join(' or ')}, not ${kind}`);
}

function checkFaces(faces: Faces, corners: number): void {
  if (faces === 3 || faces === 4) {
    if (corners % faces) throw new RangeError(`${corners} corners do not make whole faces of ${faces}`);
    return;
  }
  if (typeof faces === 'number') throw new RangeError(`faces is ${faces}; it must be 3, 4 or a Uint32Array of sizes`);
  must('faces', faces, ['Uint32Array']);
  const sum = faces.reduce((sum, size) => sum + size, 0);
  if (sum !== corners) throw new RangeError(`the face sizes add up to ${sum} but there are ${corners} corners`);
}

/** Writes a mesh. */
export function write(exports: Exports, mesh: Mesh): void {
  const { positions, attributes, vertices, indices, corners } = mesh;
  const faces = mesh.faces === 4 ? new Uint32Array(corners / 4).fill(4) : mesh.faces;
  exports.begin();
  const floats: Placed<Float32Array>[] = [[positions, exports.positions(vertices)]];
  for (const [name, array] of attributes) floats.push([array, exports[name](vertices)]);
  const integers: Placed<Indices>[] = [];
  if (indices) integers.push([indices, exports.indices(corners)]);
  if (faces !== 3) integers.push([faces, exports.face_sizes(faces.length)]);
  writeArrays(exports, floats, integers);
}

/** An array, and its place in the memory of the WebAssembly side. */
export type Placed<A> = readonly [array: A, place: number];

/**
 * Writes arrays. All places have been asked for before the first is written, as memory moves when it grows. WebAssembly's numbers are
 * signed: places beyond 2 GiB come as negative ones.
 */
export function writeArrays(
  exports: Exports,
  floats: readonly Placed<Float32Array>[],
  integers: readonly Placed<Indices>[] = [],
): void {
  const { buffer } = exports.memory;
  for (const [array, place] of floats) new Float32Array(buffer, place >>> 0, array.length).set(array);
  for (const [array, place] of integers) new Uint32Array(buffer, place >>> 0, array.length).set(array);
}

/** What the WebAssembly side found wrong with a mesh that is right but for its indices. */
export function indexError({ indices, vertices }: Pick<Mesh, 'indices' | 'vertices'>): RangeError {
  const at = indices!.findIndex((index) => index >= vertices);
  return new RangeError(`index ${indices![at]} at place ${at} is out of range: there are ${vertices} vertices`);
}

/** A copy of floats that the WebAssembly side made, in `out` if there is one. */
export function floats<A extends Float32Array = Float32Array<ArrayBuffer>>(
  exports: Exports,
  place: number,
  length: number,
  out?: A | null,
): A {
  const made = new Float32Array(exports.memory.buffer, place >>> 0, length);
  if (!out) return made.slice() as Float32Array as A;
  out.set(made);
  return out;
}

/** Errors: another kind of array, or another length. */
export function checkOut(out: Float32Array, corners: number): void {
  if (rows('out', out, 4) !== corners) throw new RangeError(`out has room for ${out.length / 4} tangents but there are ${corners} corners`);
}

/** The place of a name among names. */
export function choice(what: string, name: string, names: readonly string[]): number {
  const at = names.indexOf(name);
  if (at >= 0) return at;
  throw new RangeError(`${what} is '${name}'; it must be one of ${names.map((name) => `'${name}'`).join(', ')}`);
}

/** An angle that an option gives. */
export function degrees(what: string, angle = 180): number {
  if (Number.isFinite(angle)) return angle;
  throw new RangeError(`${what} is ${angle}; it must be a number of degrees`);
}
