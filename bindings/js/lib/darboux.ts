// `darboux`: every function of the package that runs on the CPU.

import { checkIndices, checkOut, checkType, choice, degrees, optionsOf, rowCount, wholeRows } from './core/checks.js';
import { ENCODINGS, NORMAL_WEIGHTS, SHADINGS, SMOOTHING_SEAMS } from './core/choices.js';
import { fullModule, readReport, tangentMesh, tangentOptions } from './core/full.js';
import { checkedMesh, indexError, readFloats, writeArrays, writeMesh, type Copy } from './core/mesh.js';
import type * as types from './types.js';

export * as gpuResume from './core/gpu-resume.js';
export { CONVENTIONS } from './core/choices.js';
export { convert, convertTexels } from './core/convert.js';
export { Plan } from './core/plan.js';
export { planTopology } from './core/gpu-plan.js';
export { skinFrames, transformFrames } from './core/transform.js';
export type * from './types.js';

/** For each encoding, the type of its array and the number of elements per tangent. */
const CODE_ARRAYS = [[Int8Array, 4], [Uint32Array, 1], [Int16Array, 4], [Int16Array, 2], [Uint16Array, 1]] as const;

/** Resolves when the other functions can be called. */
export const ready: Promise<void> = fullModule.ready;

/**
 * Computes the tangent of every corner: unit xyz and the sign w, with bitangent = w * cross(normal, xyz). The sign is that of MikkTSpace
 * for the UVs as given.
 *
 * Corners of one vertex may have different tangents, as at mirrored seams. {@link splitVertices} turns tangents of corners into vertices
 * and new indices. Without indices, every corner is a vertex.
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
  indices?: types.Indices | null,
  options?: (types.TangentOptions & { returnReport?: false }) | null,
  out?: Out | null,
): Out;
/** As above, and also returns the report of the run. */
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
  options?: (types.TangentOptions & { returnReport?: boolean }) | null,
  out?: Float32Array | null,
): Float32Array | types.ReportedTangents {
  const mesh = tangentMesh(positions, normals, uvs, indices, options);
  const codes = tangentOptions(options);
  if (out) checkOut(out, mesh.corners);
  return fullModule.call((exports) => {
    writeMesh(exports, mesh);
    const address = exports.generate_tangents(...codes);
    if (!address) throw indexError(mesh);
    if (!options?.returnReport) return readFloats<Float32Array>(exports, address, 4 * mesh.corners, out);
    return { tangents: readFloats(exports, address, 4 * mesh.corners), report: readReport(exports) };
  });
}

/**
 * Computes the whole frame of every corner: tangent, bitangent, magnitudes and sign. Also returns the report of the run.
 *
 * Parameters, errors and tangents are those of {@link generateTangents}.
 */
export function generateFrames(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: types.Indices | null,
  options?: types.TangentOptions | null,
): types.Frames {
  const mesh = tangentMesh(positions, normals, uvs, indices, options);
  const codes = tangentOptions(options);
  return fullModule.call((exports) => {
    writeMesh(exports, mesh);
    const address = exports.generate_frames(...codes);
    if (!address) throw indexError(mesh);
    return {
      tangents: readFloats(exports, address, 4 * mesh.corners),
      bitangents: readFloats(exports, exports.frame_bitangents(), 3 * mesh.corners),
      magnitudes: readFloats(exports, exports.frame_magnitudes(), 2 * mesh.corners),
      report: readReport(exports),
    };
  });
}

/**
 * Splits the vertices whose corners need different tangents: one new vertex per distinct pair of old vertex and tangent, all four floats
 * compared as bits, NaN equal to NaN. Old vertices keep their numbers, and further vertices follow them.
 *
 * @param indices The vertex of each corner.
 * @param tangents 4 per corner, as {@link generateTangents} returns them.
 * @param vertexCount The number of old vertices, used or not.
 */
export function splitVertices(indices: types.Indices, tangents: Float32Array, vertexCount: number): types.VertexSplit {
  checkIndices(indices);
  const corners = rowCount('tangents', tangents, 4);
  if (corners !== indices.length) {
    throw new RangeError(`there are ${corners} tangents but ${indices.length} indices; pass the tangents of this mesh`);
  }
  if (!Number.isInteger(vertexCount) || vertexCount < 0 || vertexCount > 2 ** 30) {
    throw new RangeError(`vertexCount is ${vertexCount}; it must be the number of vertices`);
  }
  return fullModule.call((exports) => {
    writeArrays(exports, [[tangents, exports.given_tangents(corners)]], [[indices, exports.indices(corners)]]);
    const count = exports.split_vertices(vertexCount);
    if (count < 0) throw indexError({ indices, vertices: vertexCount });
    const integers = (address: number, length: number) => new Uint32Array(exports.memory.buffer, address >>> 0, length).slice();
    return {
      tangentOfVertex: readFloats(exports, exports.split_tangents(), 4 * count),
      indices: integers(exports.split_indices(), corners),
      sourceOfVertex: integers(exports.split_sources(), count),
    };
  });
}

/**
 * Turns normals of corners, as `generateNormals` returns them, into vertices with one normal each.
 *
 * @param indices The vertex of each corner.
 * @param normals 3 per corner.
 * @param vertexCount The number of vertices of the mesh.
 * @throws As {@link splitVertices}.
 */
export function splitNormals(indices: types.Indices, normals: Float32Array, vertexCount: number): types.NormalSplit {
  const corners = rowCount('normals', normals, 3);
  // w = 0 marks used vertices, because unused ones get w = 1.
  const tangents = new Float32Array(4 * corners);
  for (let corner = 0; corner < corners; corner++) tangents.set(normals.subarray(3 * corner, 3 * corner + 3), 4 * corner);
  if (corners !== indices.length) throw new RangeError(`there are ${corners} normals but ${indices.length} indices; pass the normals of this mesh`);
  const { tangentOfVertex, indices: newIndices, sourceOfVertex } = splitVertices(indices, tangents, vertexCount);
  const normalOfVertex = new Float32Array(3 * sourceOfVertex.length);
  for (let vertex = 0; vertex < sourceOfVertex.length; vertex++) {
    const isUsed = tangentOfVertex[4 * vertex + 3] === 0;
    normalOfVertex.set(isUsed ? tangentOfVertex.subarray(4 * vertex, 4 * vertex + 3) : [0, 0, 1], 3 * vertex);
  }
  return { normalOfVertex, indices: newIndices, sourceOfVertex };
}

/**
 * Computes a unit normal for every corner: flat, smooth or creased.
 *
 * @param positions 3 per vertex, any values. The winding of a face is counter-clockwise seen from its front.
 * @param indices The vertex of each corner. Without indices, the corners are the vertices in order.
 * @param options May be left out, undefined or null, and so may each option.
 * @returns 3 per corner.
 * @throws The errors of {@link generateTangents}.
 */
export function generateNormals(
  positions: Float32Array,
  indices?: types.Indices | null,
  options?: types.NormalOptions | null,
): Float32Array<ArrayBuffer> {
  const given = optionsOf(options);
  const mesh = checkedMesh(positions, [], indices, given.faces);
  const shading = choice('shading', given.shading, SHADINGS, 'smooth');
  const weight = choice('weight', given.weight, NORMAL_WEIGHTS, 'angle');
  const seams = choice('seams', given.seams, SMOOTHING_SEAMS, 'ignored');
  const crease = degrees('crease', given.crease);
  return fullModule.call((exports) => {
    writeMesh(exports, mesh);
    const address = exports.generate_normals(shading, weight, crease, seams);
    if (!address) throw indexError(mesh);
    return readFloats(exports, address, 3 * mesh.corners);
  });
}

/**
 * Compares two sets of tangents, corner by corner.
 *
 * @param a 4 per corner.
 * @param b 4 per corner, for the same corners and in the same convention.
 */
export function measureTangents(a: Float32Array, b: Float32Array): types.TangentDifference {
  const [count, other] = [rowCount('a', a, 4), rowCount('b', b, 4)];
  if (count !== other) throw new RangeError(`b has ${other} tangents but a has ${count}; compare tangents of one mesh`);
  return fullModule.call((exports) => {
    writeArrays(exports, [[a, exports.given_tangents(count)], [b, exports.other_tangents(count)]]);
    const address = exports.measure_tangents() >>> 0;
    const read = (at: number, length: number) => Array.from(new Float64Array(exports.memory.buffer, address + 8 * at, length));
    const [corners, identical, signFlips, withoutAngle, mean, min, median, p95, max] = read(0, 9) as Nine;
    const worst = Array.from({ length: read(19, 1)[0]! }, (_, at) => {
      const [corner, angle] = read(20 + 2 * at, 2) as [number, number];
      return { corner, angle };
    });
    return { corners, identical, signFlips, withoutAngle, mean, min, median, p95, max, histogram: read(9, 10), worst };
  });
}

/**
 * Measures tangents against the directions in which u grows on the triangles. The angle is not zero where normals are smooth: tangents are
 * perpendicular to them, while the derivatives lie in the faces.
 *
 * @param positions 3 per vertex.
 * @param normals 3 per vertex.
 * @param uvs 2 per vertex.
 * @param indices The vertex of each corner; null where corners are vertices.
 * @param tangents 4 per corner.
 * @throws As {@link generateTangents}; RangeError for another number of tangents than corners.
 */
export function measureUvFidelity(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices | null | undefined,
  tangents: Float32Array,
  options?: { faces?: types.Faces | null } | null,
): types.UvFidelity {
  const mesh = tangentMesh(positions, normals, uvs, indices, options);
  const rows = rowCount('tangents', tangents, 4);
  if (rows !== mesh.corners) throw new RangeError(`there are ${rows} tangents but ${mesh.corners} corners; give one per corner`);
  return fullModule.call((exports) => {
    writeMesh(exports, mesh);
    writeArrays(exports, [[tangents, exports.given_tangents(rows)]]);
    const address = exports.measure_uv_fidelity() >>> 0;
    if (!address) throw indexError(mesh);
    const [mean, rootMeanSquare, area, unmeasuredTriangles] = new Float64Array(exports.memory.buffer, address, 4);
    return { mean: mean!, rootMeanSquare: rootMeanSquare!, area: area!, unmeasuredTriangles: unmeasuredTriangles! };
  });
}

type Nine = [number, number, number, number, number, number, number, number, number];

/**
 * Encodes tangents in fewer bytes: 'snorm8', 'snorm10', 'snorm16', 'octahedral' or 'diamond'. 'diamond' takes two bytes, and is the only
 * encoding that needs normals.
 *
 * @param tangents 4 per element: unit xyz and the sign w.
 * @param normals 3 per element, unit length, with the same bits that the decoder will get.
 */
export function encodeTangents<E extends types.TangentEncoding>(
  tangents: Float32Array,
  encoding: E,
  normals?: Float32Array,
): types.TangentCodes[E] {
  const code = choice<types.TangentEncoding>('encoding', encoding, ENCODINGS);
  const count = rowCount('tangents', tangents, 4);
  const basis = checkedBasis(encoding, normals, count);
  const [Codes, width] = CODE_ARRAYS[code]!;
  return fullModule.call((exports) => {
    const arrays: Copy<Float32Array>[] = [[tangents, exports.given_tangents(count)]];
    if (basis) arrays.push([basis, exports.normals(count)]);
    writeArrays(exports, arrays);
    const address = exports.encode_tangents(code) >>> 0;
    const bytes = exports.memory.buffer.slice(address, address + count * width * Codes.BYTES_PER_ELEMENT);
    return new Codes(bytes as ArrayBuffer) as types.TangentCodes[E];
  });
}

/** Decodes the result of {@link encodeTangents}: 4 floats per tangent, of unit length except in the SNORM encodings. */
export function decodeTangents<E extends types.TangentEncoding>(
  codes: types.TangentCodes[E],
  encoding: E,
  normals?: Float32Array,
): Float32Array<ArrayBuffer> {
  const code = choice<types.TangentEncoding>('encoding', encoding, ENCODINGS);
  const [Codes, width] = CODE_ARRAYS[code]!;
  checkType('codes', codes, [Codes.name]);
  const count = wholeRows('codes', codes, width);
  const basis = checkedBasis(encoding, normals, count);
  return fullModule.call((exports) => {
    const address = exports.encoded_bytes(codes.byteLength);
    if (basis) writeArrays(exports, [[basis, exports.normals(count)]]);
    const bytes = new Uint8Array(codes.buffer, codes.byteOffset, codes.byteLength);
    new Uint8Array(exports.memory.buffer, address >>> 0, bytes.length).set(bytes);
    return readFloats(exports, exports.decode_tangents(code), 4 * count);
  });
}

/** The normals that 'diamond' needs; null for the other encodings. */
function checkedBasis(encoding: string, normals: Float32Array | undefined, count: number): Float32Array | null {
  if (encoding !== 'diamond') return null;
  const rows = rowCount('normals', normals!, 3);
  if (rows === count) return normals!;
  throw new RangeError(`normals has ${rows} elements but there are ${count} tangents; give one per tangent`);
}
