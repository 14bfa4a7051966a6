// `darboux`: everything.

import { choices, engine, report, surface } from './core/full.js';
import { checkIndices, checkOut, choice, degrees, floats, indexError, mesh, must, rows, whole, write, writeArrays } from './core/mesh.js';
import type * as types from './types.js';

export * as gpuResume from './core/gpu-resume.js';
export { Plan } from './core/plan.js';
export { planTopology } from './core/gpu-plan.js';
export type * from './types.js';

// In the order of the codes that the WebAssembly side knows.
const SHADINGS = ['flat', 'smooth'] as const;
const WEIGHTS = ['angle', 'area', 'angle-area'] as const;
const SEAMS = ['ignored', 'respected'] as const;
const FORMS = ['snorm8', 'snorm10', 'snorm16', 'octahedral', 'diamond'] as const;

/** The kind of array that each form has, and its elements per tangent. */
const CODES = [[Int8Array, 4], [Uint32Array, 1], [Int16Array, 4], [Int16Array, 2], [Uint16Array, 1]] as const;

/** Resolves when the other functions may be called. */
export const ready: Promise<void> = engine.ready;

/**
 * The tangent of every corner: unit xyz and the sign w, bitangent = w * cross(normal, xyz). The sign is MikkTSpace's for the UVs as given.
 *
 * These are not vertex tangents: corners of one vertex may disagree, as at mirrored seams. {@link splitVertices} gives vertices and new
 * indices. Without indices they are the vertices' own.
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
  indices?: types.Indices | null,
  options?: types.TangentOptions & { returnReport?: false },
  out?: Out,
): Out;
/** As above, with the report of the run. */
export function generateTangents(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices | null | undefined,
  options: types.TangentOptions & { returnReport: true },
): types.ReportedTangents;
export function generateTangents(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: types.Indices | null,
  options: types.TangentOptions & { returnReport?: boolean } = {},
  out?: Float32Array,
): Float32Array | types.ReportedTangents {
  const given = surface(positions, normals, uvs, indices, options);
  const chosen = choices(options);
  if (out) checkOut(out, given.corners);
  return engine.call((exports) => {
    write(exports, given);
    const place = exports.generate_tangents(...chosen);
    if (!place) throw indexError(given);
    if (!options.returnReport) return floats<Float32Array>(exports, place, 4 * given.corners, out);
    return { tangents: floats(exports, place, 4 * given.corners), report: report(exports) };
  });
}

/**
 * The whole frame of every corner: tangent, bitangent, magnitudes, sign, and the report of the run.
 *
 * Parameters and errors as those of {@link generateTangents}, whose tangents these are.
 */
export function generateFrames(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: types.Indices | null,
  options: types.TangentOptions = {},
): types.Frames {
  const given = surface(positions, normals, uvs, indices, options);
  const chosen = choices(options);
  return engine.call((exports) => {
    write(exports, given);
    const place = exports.generate_frames(...chosen);
    if (!place) throw indexError(given);
    return {
      tangents: floats(exports, place, 4 * given.corners),
      bitangents: floats(exports, exports.frame_bitangents(), 3 * given.corners),
      magnitudes: floats(exports, exports.frame_magnitudes(), 2 * given.corners),
      report: report(exports),
    };
  });
}

/**
 * Splits the vertices whose corners need different tangents, as few as correctness allows: one vertex per distinct pair of old vertex and
 * tangent (all four floats compared as bits). Old vertices keep their number, further ones come after them.
 *
 * @param indices The vertex of each corner.
 * @param tangents 4 per corner, as {@link generateTangents} gives them.
 * @param vertexCount The number of old vertices, used or not.
 */
export function splitVertices(indices: types.Indices, tangents: Float32Array, vertexCount: number): types.VertexSplit {
  checkIndices(indices);
  const corners = rows('tangents', tangents, 4);
  if (corners !== indices.length) {
    throw new RangeError(`${corners} tangents where the mesh has ${indices.length} corners; pass what was computed from this mesh`);
  }
  if (!Number.isInteger(vertexCount) || vertexCount < 0 || vertexCount > 2 ** 30) {
    throw new RangeError(`vertexCount is ${vertexCount}; it must be the number of vertices`);
  }
  return engine.call((exports) => {
    writeArrays(exports, [[tangents, exports.given_tangents(corners)]], [[indices, exports.indices(corners)]]);
    const count = exports.split_vertices(vertexCount);
    if (count < 0) throw indexError({ indices, vertices: vertexCount });
    const integers = (place: number, length: number) => new Uint32Array(exports.memory.buffer, place >>> 0, length).slice();
    return {
      tangentOfVertex: floats(exports, exports.split_tangents(), 4 * count),
      indices: integers(exports.split_indices(), corners),
      sourceOfVertex: integers(exports.split_sources(), count),
    };
  });
}

/**
 * A unit normal for every corner; flat, smooth or creased.
 *
 * @param positions 3 per vertex, any values. Faces wind counter-clockwise seen from where their normal points.
 * @param indices The vertex of each corner; without, every vertex is a corner of its own.
 * @returns 3 per corner.
 * @throws As {@link generateTangents}.
 */
export function generateNormals(
  positions: Float32Array,
  indices?: types.Indices | null,
  options: types.NormalOptions = {},
): Float32Array<ArrayBuffer> {
  const given = mesh(positions, [], indices, options.faces);
  const shading = choice('shading', options.shading ?? 'smooth', SHADINGS);
  const weight = choice('weight', options.weight ?? 'angle', WEIGHTS);
  const seams = choice('seams', options.seams ?? 'ignored', SEAMS);
  const crease = degrees('crease', options.crease);
  return engine.call((exports) => {
    write(exports, given);
    const place = exports.generate_normals(shading, weight, crease, seams);
    if (!place) throw indexError(given);
    return floats(exports, place, 3 * given.corners);
  });
}

/**
 * Compares two sets of tangents, corner by corner.
 *
 * @param a 4 per corner. @param b Those of the same corners, in the same convention.
 */
export function measureTangents(a: Float32Array, b: Float32Array): types.TangentDifference {
  const [count, other] = [rows('a', a, 4), rows('b', b, 4)];
  if (count !== other) throw new RangeError(`b has ${other} tangents but a has ${count}; compare tangents of one mesh`);
  return engine.call((exports) => {
    writeArrays(exports, [[a, exports.given_tangents(count)], [b, exports.other_tangents(count)]]);
    const place = exports.measure_tangents() >>> 0;
    const read = (at: number, length: number) => Array.from(new Float64Array(exports.memory.buffer, place + 8 * at, length));
    const [corners, identical, signFlips, withoutAngle, mean, min, median, p95, max] = read(0, 9) as Nine;
    const worst = Array.from({ length: read(19, 1)[0]! }, (_, at) => {
      const [corner, angle] = read(20 + 2 * at, 2) as [number, number];
      return { corner, angle };
    });
    return { corners, identical, signFlips, withoutAngle, mean, min, median, p95, max, histogram: read(9, 10), worst };
  });
}

type Nine = [number, number, number, number, number, number, number, number, number];

/**
 * Writes tangents in fewer bytes: 'snorm8', 'snorm10', 'snorm16', 'octahedral', or 'diamond', which has two bytes and alone needs normals.
 *
 * @param tangents 4 per element: unit xyz and the sign w.
 * @param normals 3 per element, unit, and bit for bit what the decoder will be given.
 */
export function encodeTangents<F extends types.TangentEncoding>(
  tangents: Float32Array,
  encoding: F,
  normals?: Float32Array,
): types.TangentCodes[F] {
  const form = choice('encoding', encoding, FORMS);
  const count = rows('tangents', tangents, 4);
  const basis = normalsOf(encoding, normals, count);
  const [Codes, width] = CODES[form]!;
  return engine.call((exports) => {
    writeArrays(exports, [[tangents, exports.given_tangents(count)], ...(basis ? [[basis, exports.normals(count)] as const] : [])]);
    const place = exports.encode_tangents(form) >>> 0;
    const bytes = exports.memory.buffer.slice(place, place + count * width * Codes.BYTES_PER_ELEMENT);
    return new Codes(bytes as ArrayBuffer) as types.TangentCodes[F];
  });
}

/** Reads what {@link encodeTangents} wrote: 4 floats per tangent, unit but in the SNORM forms. */
export function decodeTangents<F extends types.TangentEncoding>(
  codes: types.TangentCodes[F],
  encoding: F,
  normals?: Float32Array,
): Float32Array<ArrayBuffer> {
  const form = choice('encoding', encoding, FORMS);
  const [Codes, width] = CODES[form]!;
  must('codes', codes, [Codes.name]);
  const count = whole('codes', codes, width);
  const basis = normalsOf(encoding, normals, count);
  return engine.call((exports) => {
    const place = exports.encoded_bytes(codes.byteLength);
    if (basis) writeArrays(exports, [[basis, exports.normals(count)]]);
    const bytes = new Uint8Array(codes.buffer, codes.byteOffset, codes.byteLength);
    new Uint8Array(exports.memory.buffer, place >>> 0, bytes.length).set(bytes);
    return floats(exports, exports.decode_tangents(form), 4 * count);
  });
}

/** The normals that 'diamond' alone takes. */
function normalsOf(encoding: string, normals: Float32Array | undefined, count: number): Float32Array | null {
  if (encoding !== 'diamond') return null;
  const found = rows('normals', normals!, 3);
  if (found === count) return normals!;
  throw new RangeError(`normals has ${found} elements but there are ${count} tangents; give one per tangent`);
}
