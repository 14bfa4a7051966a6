// Small meshes: positions, normals, UVs and indices.

/** A square. */
export const square = () => [
  new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]),
  new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]),
  new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]),
  new Uint16Array([0, 1, 2, 0, 2, 3]),
];

/** Two squares side by side, whose UVs mirror where they meet, at x = 0. */
export const mirrored = () => [
  new Float32Array([-1, 0, 0, 0, 0, 0, 0, 1, 0, -1, 1, 0, 1, 0, 0, 1, 1, 0]),
  new Float32Array(18).map((_, at) => (at % 3 === 2 ? 1 : 0)),
  new Float32Array([1, 0, 0, 0, 0, 1, 1, 1, 1, 0, 1, 1]),
  new Uint16Array([0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]),
];
