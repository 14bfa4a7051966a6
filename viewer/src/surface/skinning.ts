// Linear blend skinning of positions, normals and tangents, after morph targets.

import type { Skin, Surface } from './surface';

/** The surface after skinning. */
export function skinned(surface: Surface): Surface {
  if (!surface.skin) return surface;
  const { positions, normals } = surface;
  const vertices = Uint32Array.from({ length: positions.length / 3 }, (_, vertex) => vertex);
  return { ...surface, positions: transformed(surface, positions, 3, vertices, 1), normals: transformed(surface, normals, 3, vertices, 0) };
}

/** Tangents of corners (4 floats each) after skinning. Signs stay the same, as in renderers. */
export function skinnedTangents(surface: Surface, tangents: Float32Array): Float32Array {
  return surface.skin ? transformed(surface, tangents, 4, surface.indices, 0) : tangents;
}

/** Transforms vectors by the matrices of their vertices: points with `w` = 1, directions with `w` = 0. */
function transformed({ skin, sourceOfVertex }: Surface, array: Float32Array, width: number, vertices: Uint32Array, w: 0 | 1): Float32Array {
  const out = array.slice();
  const matrix = new Float32Array(16);
  for (let at = 0; at < vertices.length; at++) {
    blendMatrices(skin!, sourceOfVertex ? sourceOfVertex[vertices[at]] : vertices[at], matrix);
    const [x, y, z] = [array[at * width], array[at * width + 1], array[at * width + 2]];
    for (let i = 0; i < 3; i++) out[at * width + i] = matrix[i] * x + matrix[4 + i] * y + matrix[8 + i] * z + matrix[12 + i] * w;
  }
  return out;
}

/** The weighted sum of the matrices of a vertex's joints. */
function blendMatrices({ joints, weights, matrices }: Skin, vertex: number, out: Float32Array): void {
  out.fill(0);
  for (let influence = vertex * 4; influence < vertex * 4 + 4; influence++) {
    const weight = weights[influence];
    // A joint that does not exist has no influence.
    const start = joints[influence] * 16;
    if (weight === 0 || start >= matrices.length) continue;
    for (let i = 0; i < 16; i++) out[i] += weight * matrices[start + i];
  }
}
