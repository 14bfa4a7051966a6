// `convert` and `convertTexels`: vertex data and normal maps in another convention.

import { checkFaces, checkIndices, checkType, rowCount, wholeRows } from './checks.js';
import { CONVENTIONS } from './choices.js';
import { fullModule, type FullExports } from './full.js';
import { readFloats, writeArrays, writeTexts, type Copy } from './mesh.js';
import type * as types from '../types.js';

/** The arrays of vertex data, the number of floats per element, and where WebAssembly takes them. */
const ARRAYS = [['positions', 3, 'positions'], ['normals', 3, 'normals'], ['uvs', 2, 'uvs'], ['tangents', 4, 'given_tangents']] as const;

/**
 * Converts vertex data from one convention to another. The surface, its texture and its lighting do not change.
 *
 * The w of tangents from `generateTangents` is MikkTSpace's sign, which is not yet in any program's convention. For these, pass the convention
 * of the mesh as source, and `generated: true`. Even from 'gltf' to 'gltf' this negates w, because v points down in glTF.
 *
 * @throws TypeError for an array of another type. RangeError for an unknown convention, and for lengths that do not fit together.
 */
export function convert(source: types.Convention, target: types.Convention, data: types.VertexData): types.ConvertedVertexData {
  const counts = ARRAYS.map(([name, width]) => (data[name] ? rowCount(name, data[name], width) : 0));
  const { indices } = data;
  const faces = data.faces ?? 3;
  if (indices) {
    checkIndices(indices);
    checkFaces(faces, indices.length);
  }
  return fullModule.call((exports) => {
    exports.begin();
    const sourceBytes = writeTexts(exports, [source, target], exports.convention_texts);
    const addresses = ARRAYS.map(([, , reserve], at) => exports[reserve](counts[at]!));
    const corners = exports.indices(indices?.length ?? 0);
    const sizes = faces === 4 ? new Uint32Array((indices?.length ?? 0) / 4).fill(4) : faces;
    const integers: Copy<types.Indices>[] = indices ? [[indices, corners]] : [];
    if (indices && sizes !== 3) integers.push([sizes, exports.face_sizes(sizes.length)]);
    const floats = ARRAYS.map(([name], at) => [data[name] ?? new Float32Array(), addresses[at]!] as const);
    writeArrays(exports, floats, integers);
    const inverted = checkedCode(exports.convert(sourceBytes, Number(data.generated ?? false)), source, target);
    const converted = ARRAYS.map(([name, width], at) => [name, data[name] ? readFloats(exports, addresses[at]!, width * counts[at]!) : null]);
    return {
      ...(Object.fromEntries(converted) as Omit<types.ConvertedVertexData, 'indices' | 'invertsRed' | 'invertsGreen'>),
      indices: indices ? new Uint32Array(exports.memory.buffer, corners >>> 0, indices.length).slice() : null,
      invertsRed: (inverted & 1) !== 0,
      invertsGreen: (inverted & 2) !== 0,
    };
  });
}

/**
 * Converts the texels of a normal map: red and green are inverted where the conventions differ. This is exact, so that converting back restores the
 * texels. The image is not flipped.
 *
 * @param texels The channels of all texels; x and y come first, the other channels do not change. The data of an `ImageData` has 4 channels.
 * @param channels 2 to 4 channels per texel. Default: 4.
 * @returns A new array of the same type.
 * @throws TypeError for an array of another type. RangeError for an unknown convention, and for a part of a texel.
 */
export function convertTexels<T extends Uint8Array | Uint8ClampedArray | Uint16Array>(
  texels: T,
  source: types.Convention,
  target: types.Convention,
  channels: 2 | 3 | 4 = 4,
): T {
  checkType('texels', texels, ['Uint8Array', 'Uint8ClampedArray', 'Uint16Array']);
  if (![2, 3, 4].includes(channels)) throw new RangeError(`channels is ${channels}; it must be 2, 3 or 4`);
  wholeRows('texels', texels, channels);
  return fullModule.call((exports) => {
    const sourceBytes = writeTexts(exports, [source, target], exports.convention_texts);
    const address = exports.encoded_bytes(texels.byteLength) >>> 0;
    const bytes = () => new Uint8Array(exports.memory.buffer, address, texels.byteLength);
    bytes().set(new Uint8Array(texels.buffer, texels.byteOffset, texels.byteLength));
    checkedCode(exports.convert_texels(sourceBytes, Number(texels.BYTES_PER_ELEMENT === 2), channels), source, target);
    const converted = texels.slice() as T;
    new Uint8Array(converted.buffer, converted.byteOffset, converted.byteLength).set(bytes());
    return converted;
  });
}

/** The result of a conversion. Errors: the text of a convention was refused. */
function checkedCode(code: ReturnType<FullExports['convert']>, source: string, target: string): number {
  if (code >= 0) return code;
  const [name, text] = code === -1 ? ['source', source] : ['target', target];
  const known = CONVENTIONS.map((one) => `'${one}'`).join(', ');
  throw new RangeError(`${name} is '${text}'; it must be one of ${known}, optionally with changes after commas such as 'gltf,green=down'`);
}
