// Small glTF models for tests: a quad with mirrored halves, and variants of it.

const TYPES = { 1: 'SCALAR', 2: 'VEC2', 3: 'VEC3', 4: 'VEC4', 16: 'MAT4' };
const COMPONENTS = new Map([[Uint8Array, 5121], [Uint16Array, 5123], [Uint32Array, 5125], [Float32Array, 5126]]);

/** The quad spans x from -1 to 1 and y from -0.5 to 0.5 and faces +z. u grows from the middle to both sides. */
const CORNERS = [[-1, -0.5], [0, -0.5], [1, -0.5], [-1, 0.5], [0, 0.5], [1, 0.5]];

/** The vertex attributes of the quad, each an array and its width. */
export const QUAD = {
  POSITION: [Float32Array.from(CORNERS.flatMap(([x, y]) => [x, y, 0])), 3],
  NORMAL: [Float32Array.from(CORNERS.flatMap(() => [0, 0, 1])), 3],
  TEXCOORD_0: [Float32Array.from(CORNERS.flatMap(([x, y]) => [Math.abs(x), 0.5 - y])), 2],
};

/** Tangents of the vertices. The two in the middle are right for one half only. */
export const TANGENTS = [Float32Array.from([-1, 1, 1, -1, 1, 1].flatMap((x) => [x, 0, 0, Math.sign(x)])), 4];

/** Two triangles per half. */
export const INDICES = Uint16Array.from([0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4]);

/**
 * The text of a glTF with one mesh. `attributes` is like QUAD, and `targets` has the attributes of each morph target. `more` has further
 * arrays by name. `json` gets their accessor numbers and returns members that replace those of the file.
 */
export function gltf({ attributes = QUAD, indices = INDICES, targets = [], more = {}, mesh = {}, primitive = {}, json = () => ({}) } = {}) {
  const [accessors, bufferViews, bytes] = [[], [], []];
  let length = 0;
  const accessor = ([array, width]) => {
    const data = Buffer.from(array.buffer);
    bufferViews.push({ buffer: 0, byteOffset: length, byteLength: data.length });
    bytes.push(data, Buffer.alloc(-data.length & 3));
    length += data.length + (-data.length & 3);
    const bounds = width === 3 ? Object.fromEntries([['min', Math.min], ['max', Math.max]].map(([name, best]) => [name, [0, 1, 2].map((i) => best(...array.filter((_, at) => at % 3 === i)))])) : {};
    return accessors.push({ bufferView: bufferViews.length - 1, componentType: COMPONENTS.get(array.constructor), count: array.length / width, type: TYPES[width], ...bounds }) - 1;
  };
  const all = (arrays) => Object.fromEntries(Object.entries(arrays).map(([name, array]) => [name, accessor(array)]));
  const one = { attributes: all(attributes), indices: accessor([indices, 1]), ...primitive };
  if (targets.length) one.targets = targets.map(all);
  const others = json(all(more));
  const buffers = [{ byteLength: length, uri: `data:application/octet-stream;base64,${Buffer.concat(bytes).toString('base64')}` }];
  return JSON.stringify({ asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }], meshes: [{ primitives: [one], ...mesh }], accessors, bufferViews, buffers, ...others });
}

/**
 * The text of the same glTF with all attributes in one buffer view, which ends with its last element. The vertices `replaced` have other numbers
 * there, and sparse elements give them back where `isSparse`.
 */
export function interleaved({ attributes = QUAD, replaced = [], isSparse = true } = {}) {
  const file = JSON.parse(gltf({ attributes }));
  const parts = [Buffer.from(file.buffers[0].uri.split(',')[1], 'base64')];
  let length = parts[0].length;
  const view = (bytes, members = {}) => {
    parts.push(bytes, Buffer.alloc(-bytes.length & 3));
    file.bufferViews.push({ buffer: 0, byteOffset: length, byteLength: bytes.length, ...members });
    length += bytes.length + (-bytes.length & 3);
    return file.bufferViews.length - 1;
  };
  const all = Object.values(attributes);
  const byteStride = 8 + all.reduce((sum, [, width]) => sum + 4 * width, 0);
  const count = all[0][0].length / all[0][1];
  const rows = Buffer.alloc(byteStride * count, 0xff);
  let byteOffset = 0;
  const places = all.map(([array, width], at) => {
    array.forEach((x, i) => rows.writeFloatLE(replaced.includes(Math.floor(i / width)) ? 0.5 : x, Math.floor(i / width) * byteStride + byteOffset + (i % width) * 4));
    const accessor = Object.assign(file.accessors[at], { byteOffset });
    byteOffset += 4 * width;
    return accessor;
  });
  const shared = view(rows.subarray(0, rows.length - 8), { byteStride });
  places.forEach((accessor, at) => {
    accessor.bufferView = shared;
    if (!replaced.length || !isSparse) return;
    const [array, width] = all[at];
    const indices = { bufferView: view(Buffer.from(replaced)), componentType: 5121 };
    const values = { bufferView: view(Buffer.from(Float32Array.from(replaced.flatMap((vertex) => [...array.subarray(vertex * width, (vertex + 1) * width)])).buffer)) };
    accessor.sparse = { count: replaced.length, indices, values };
  });
  file.buffers = [{ byteLength: length, uri: `data:application/octet-stream;base64,${Buffer.concat(parts).toString('base64')}` }];
  return JSON.stringify(file);
}

/** A square grid of quads, for {@link gltf}. u grows from the middle to both sides. */
export function grid(side) {
  const line = Array.from({ length: side + 1 }, (_, at) => at / side - 0.5);
  const places = line.flatMap((y) => line.map((x) => [x, y]));
  const of = (width, values) => [Float32Array.from({ length: places.length * width }, (_, at) => values(places[Math.floor(at / width)])[at % width]), width];
  const POSITION = of(3, ([x, y]) => [x, y, 0.05 * Math.sin(20 * x) * Math.cos(20 * y)]);
  const attributes = { POSITION, NORMAL: of(3, () => [0, 0, 1]), TEXCOORD_0: of(2, ([x, y]) => [Math.abs(x), 0.5 - y]) };
  const corners = [0, 1, side + 2, 0, side + 2, side + 1];
  const indices = Uint32Array.from({ length: side * side * 6 }, (_, at) => {
    const quad = Math.floor(at / 6);
    return Math.floor(quad / side) * (side + 1) + (quad % side) + corners[at % 6];
  });
  return { attributes, indices };
}
