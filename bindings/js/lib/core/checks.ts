// Checks of arguments: each returns the checked value or throws one sentence that names the argument, the fault and what to pass.

import type { Faces, Indices } from '../types.js';

/** Errors: an array of another type. */
export function checkIndices(indices: Indices, name = 'indices'): void {
  checkType(name, indices, ['Uint32Array', 'Uint16Array', 'Uint8Array']);
}

/** The number of rows of `width` floats. Errors: an array of another type, or part of a row. */
export function rowCount(name: string, array: Float32Array, width: number): number {
  checkType(name, array, ['Float32Array']);
  return wholeRows(name, array, width);
}

/** Errors: another number of tangents than normals. */
export function checkFrames(normals: Float32Array, tangents: Float32Array): number {
  const [count, rows] = [rowCount('normals', normals, 3), rowCount('tangents', tangents, 4)];
  if (rows === count) return count;
  throw new RangeError(`there are ${rows} tangents but ${count} normals; give one of each per vertex`);
}

/** The number of rows of `width` elements. Errors: part of a row. */
export function wholeRows(name: string, array: { length: number }, width: number): number {
  const count = array.length / width;
  if (Number.isInteger(count)) return count;
  throw new RangeError(`${name} has a length of ${array.length}, which is not a multiple of ${width}`);
}

/** Errors: a value of another type. Compares names of types, because arrays of frames and workers have constructors of their own. */
export function checkType(name: string, value: unknown, types: readonly string[]): void {
  const type = Object.prototype.toString.call(value).slice(8, -1);
  if (!types.includes(type)) throw new TypeError(`${name} must be ${/^[AEIO]/.test(types[0] ?? '') ? 'an' : 'a'} ${types.join(' or ')}, not ${type}`);
}

/** Options, which may be left out, undefined or null. Errors: anything else that is not an object. */
export function optionsOf<O extends object>(options: O | null | undefined): Partial<O> {
  if (options == null) return {};
  if (typeof options === 'object') return options;
  throw new TypeError(`options must be an object, not ${JSON.stringify(options) ?? typeof options}`);
}

/** Errors: face sizes that do not add up to the corners. */
export function checkFaces(faces: Faces, corners: number): void {
  if (faces === 3 || faces === 4) {
    if (corners % faces) throw new RangeError(`${corners} corners are not a multiple of ${faces}, the corners of a face`);
    return;
  }
  if (typeof faces === 'number') throw new RangeError(`faces is ${faces}; it must be 3, 4 or a Uint32Array of sizes`);
  checkType('faces', faces, ['Uint32Array']);
  const sum = faces.reduce((sum, size) => sum + size, 0);
  if (sum !== corners) throw new RangeError(`the face sizes add up to ${sum} but there are ${corners} corners`);
}

/** Errors: an array of another type, or of another length than the result. */
export function checkOut(out: Float32Array, corners: number): void {
  const rows = rowCount('out', out, 4);
  if (rows !== corners) throw new RangeError(`out has room for ${rows} tangents but there are ${corners} corners`);
}

/** The position of an option's value in the list of values; of `fallback` where it is left out. Errors: the value is not in the list. */
export function choice<V extends string>(option: string, value: V | null | undefined, values: readonly V[], fallback?: V): number {
  const at = values.indexOf((value ?? fallback) as V);
  if (at >= 0) return at;
  throw new RangeError(`${option} is '${value}'; it must be one of ${values.map((one) => `'${one}'`).join(', ')}`);
}

/** An angle in degrees; 180 where it is left out. Errors: not a finite number. */
export function degrees(option: string, angle: number | null | undefined): number {
  const value = angle ?? 180;
  if (Number.isFinite(value)) return value;
  throw new RangeError(`${option} is ${value}; it must be a number of degrees`);
}
