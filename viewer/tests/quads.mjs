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
