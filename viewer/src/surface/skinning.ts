// The pose that the file's scene has: where a skin moves what morph targets have moved.

import type { Skin, Surface } from './surface';

/** The surface where its skin moves it. */
export function posed(surface: Surface): Surface {
  if (!surface.skin) return surface;
  const { positions, normals } = surface;
  const vertices = Uint32Array.from({ length: positions.length / 3 }, (_, vertex) => vertex);
  return { ...surface, positions: moved(surface, positions, 3, vertices, 1), normals: moved(surface, normals, 3, vertices, 0) };
}

/** Tangents of corners (4 floats each) where the skin turns them. Signs stay, as renderers leave them. */
export function posedTangents(surface: Surface, tangents: Float32Array): Float32Array {
  return surface.skin ? moved(surface, tangents, 4, surface.indices, 0) : tangents;
}

/** Vectors moved by the matrices of their vertices. `along`: how much of the matrices' translation counts. */
function moved({ skin, sourceOfVertex }: Surface, array: Float32Array, width: number, vertices: Uint32Array, along: 0 | 1): Float32Array {
  const out = array.slice();
  const matrix = new Float32Array(16);
  for (let at = 0; at < vertices.length; at++) {
    blend(skin!, sourceOfVertex ? sourceOfVertex[vertices[at]] : vertices[at], matrix);
    const [x, y, z] = [array[at * width], array[at * width + 1], array[at * width + 2]];
    for (let i = 0; i < 3; i++) out[at * width + i] = matrix[i] * x + matrix[4 + i] * y + matrix[8 + i] * z + matrix[12 + i] * along;
  }
  return out;
}

/** The matrix of a vertex: its joints', weighted. */
function blend({ joints, weights, matrices }: Skin, vertex: number, out: Float32Array): void {
  out.fill(0);
  for (let influence = vertex * 4; influence < vertex * 4 + 4; influence++) {
    const weight = weights[influence];
    // A joint that does not exist moves nothing.
    const start = joints[influence] * 16;
    if (weight === 0 || start >= matrices.length) continue;
    for (let i = 0; i < 16; i++) out[i] += weight * matrices[start + i];
  }
}
