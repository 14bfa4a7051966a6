// Small meshes: positions, normals, UVs and indices.

/** A unit square of two triangles. */
export const square = () => [
  new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]),
  new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]),
  new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]),
  new Uint16Array([0, 1, 2, 0, 2, 3]),
];

/** Two squares side by side with UVs mirrored at x = 0. */
export const mirrored = () => [
  new Float32Array([-1, 0, 0, 0, 0, 0, 0, 1, 0, -1, 1, 0, 1, 0, 0, 1, 1, 0]),
  new Float32Array(18).map((_, at) => (at % 3 === 2 ? 1 : 0)),
  new Float32Array([1, 0, 0, 0, 0, 1, 1, 1, 1, 0, 1, 1]),
  new Uint16Array([0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]),
];

/** A wavy grid of columns by rows squares, and one unused vertex. */
export function grid(columns, rows) {
  const vertices = Array.from({ length: (columns + 1) * (rows + 1) }, (_, at) => [at % (columns + 1), Math.floor(at / (columns + 1))]);
  const unit = (v) => v.map((x) => x / Math.hypot(...v));
  const positions = vertices.flatMap(([x, y]) => [x, y, 3 * Math.sin(x / 7) * Math.cos(y / 5)]);
  const normals = vertices.flatMap(([x, y]) => unit([(-3 / 7) * Math.cos(x / 7) * Math.cos(y / 5), (3 / 5) * Math.sin(x / 7) * Math.sin(y / 5), 1]));
  const uvs = vertices.flatMap(([x, y]) => [x / columns + 0.01 * Math.sin(y), y / rows]);
  const square = (at) => {
    const corner = at + Math.floor(at / columns);
    return [corner, corner + 1, corner + columns + 2, corner, corner + columns + 2, corner + columns + 1];
  };
  const indices = Array.from({ length: columns * rows }, (_, at) => square(at)).flat();
  return [Float32Array.of(...positions, 0, 0, 0), Float32Array.of(...normals, 0, 0, 1), Float32Array.of(...uvs, 0, 0), Uint32Array.from(indices)];
}

/** A grid with UVs mirrored in stripes. */
export function seams() {
  const mesh = grid(60, 40);
  mesh[2] = mesh[2].map((x, at) => (at % 2 ? x : Math.abs((8 * x) % 2 - 1)));
  return mesh;
}

/** Random triangles between a few positions, some of them degenerate. */
export function soup(triangles, seed) {
  let state = seed;
  const below = (n) => (state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0) % n;
  const [places, values] = [triangles >> 1, [0, -0, 1, -1, 0.5, 3, 1e-3]];
  const floats = (width) => Float32Array.from({ length: width * places }, () => values[(below(2 ** 31) >>> 8) % values.length]);
  return [floats(3), floats(3), floats(2), Uint32Array.from({ length: 3 * triangles }, () => (below(2 ** 31) >>> 8) % places)];
}

/** A grid with some degenerate triangles and some triangles without UV area. */
export function degenerates() {
  const mesh = grid(40, 30);
  const [, , uvs, indices] = mesh;
  for (let at = 0; at < indices.length; at += 3 * 37) indices[at + 1] = indices[at];
  for (let at = 5; at < indices.length; at += 3 * 53) for (const corner of [at, at + 1]) uvs.set([0.5, 0.5], 2 * indices[corner]);
  return mesh;
}
