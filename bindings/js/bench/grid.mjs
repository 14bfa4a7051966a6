// The mesh of the benchmark.

/** The positions, normals, UVs and indices of a wavy grid of columns by rows squares. */
export function grid(columns, rows) {
  const count = (columns + 1) * (rows + 1);
  const [positions, normals, uvs] = [3, 3, 2].map((width) => new Float32Array(width * count));
  for (let at = 0; at < count; at++) {
    const [x, y] = [at % (columns + 1), Math.floor(at / (columns + 1))];
    const slope = [-0.2 * Math.cos(x / 20) * Math.cos(y / 15), 0.3 * Math.sin(x / 20) * Math.sin(y / 15), 1];
    positions.set([x / 100, y / 100, Math.sin(x / 20) * Math.cos(y / 15) / 5], 3 * at);
    normals.set(slope.map((s) => s / Math.hypot(...slope)), 3 * at);
    uvs.set([x / columns, y / rows], 2 * at);
  }
  const indices = new Uint32Array(6 * columns * rows);
  for (let square = 0; square < columns * rows; square++) {
    const corner = square + Math.floor(square / columns);
    indices.set([corner, corner + 1, corner + columns + 2, corner, corner + columns + 2, corner + columns + 1], 6 * square);
  }
  return [positions, normals, uvs, indices];
}
