// The surface of one part of a model: the input of the computation of tangents.

import { generateNormals } from 'darboux';

/** Vertex arrays with 3, 3 and 4 floats per vertex. */
export interface Shape {
  positions: Float32Array;
  normals: Float32Array | null;
  tangents: Float32Array | null;
}

/** A skin. Vertices are numbered as in the file. */
export interface Skin {
  /** 4 joint numbers per vertex. */
  joints: Uint16Array;
  /** 4 weights per vertex. */
  weights: Float32Array;
  /** The matrix of each joint from mesh space to scene space: 16 floats in column-major order. */
  matrices: Float32Array;
}

/** A part of the model as it is in the file. Arrays have 3, 3, 2 and 4 floats per vertex. */
export interface GivenSurface {
  positions: Float32Array;
  normals: Float32Array | null;
  uvs: Float32Array | null;
  tangents: Float32Array | null;
  indices: Uint32Array;
  /** The vertices after morph targets with the weights of the file; null where all weights are 0. */
  shape: Shape | null;
  skin: Skin | null;
}

/** A surface with normals and UVs. */
export interface Surface extends GivenSurface {
  normals: Float32Array;
  uvs: Float32Array;
  /** The vertex of the file that each vertex copies; null where the vertices are the same. */
  sourceOfVertex: Uint32Array | null;
}

/** Fills in missing arrays: flat normals, as glTF requires, and UVs that are all zero. */
function completed(given: GivenSurface): Surface {
  const uvs = given.uvs ?? new Float32Array((given.positions.length / 3) * 2);
  if (given.normals) return { ...given, normals: given.normals, uvs, sourceOfVertex: null };
  const corners = given.indices;
  const normals = generateNormals(given.positions, corners, { shading: 'flat' });
  return {
    ...given,
    positions: gathered(given.positions, 3, corners),
    normals,
    uvs: gathered(uvs, 2, corners),
    tangents: given.tangents && gathered(given.tangents, 4, corners),
    indices: corners.map((_, corner) => corner),
    sourceOfVertex: corners,
  };
}

/** The surface after morph targets. Its tangents are computed from the moved vertices. */
export function morphed(given: GivenSurface): Surface {
  return completed({ ...given, ...given.shape });
}

/** The elements of `width` floats at the places `sources`. */
export function gathered(array: Float32Array, width: number, sources: Uint32Array): Float32Array<ArrayBuffer> {
  const out = new Float32Array(sources.length * width);
  for (let at = 0; at < sources.length; at++) {
    for (let i = 0; i < width; i++) out[at * width + i] = array[sources[at] * width + i];
  }
  return out;
}
