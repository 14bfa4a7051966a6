// The surface of one part of a model: what tangents are computed from.

import { generateNormals } from 'darboux';

/** Vertices with 3, 3 and 4 floats each. */
export interface Shape {
  positions: Float32Array;
  normals: Float32Array | null;
  tangents: Float32Array | null;
}

/** What moves vertices, in the file's numbering. */
export interface Skin {
  /** 4 per vertex. */
  joints: Uint16Array;
  /** 4 per vertex. */
  weights: Float32Array;
  /** 16 floats per joint, column after column: from the mesh to the scene. */
  matrices: Float32Array;
}

/** A part's vertices as the file has them. Arrays have 3, 3, 2 and 4 floats per vertex. */
export interface GivenSurface {
  positions: Float32Array;
  normals: Float32Array | null;
  uvs: Float32Array | null;
  tangents: Float32Array | null;
  indices: Uint32Array;
  /** Where morph targets move the vertices, as the file weights them; null where they do not. */
  shape: Shape | null;
  skin: Skin | null;
  /** Whether v runs down the image, as in glTF; then signs are the opposite of MikkTSpace's. */
  vDown: boolean;
}

/** A surface that has all that tangents need. */
export interface Surface extends GivenSurface {
  normals: Float32Array;
  uvs: Float32Array;
  /** The given vertex that each vertex copies; null where they are the same. */
  sourceOfVertex: Uint32Array | null;
  /** What was missing, and is made up so that the part can be shown. */
  without: { normals: boolean; uvs: boolean };
}

/** Makes up what is missing: flat normals, as glTF demands, and UVs that are all zero. */
export function completed(given: GivenSurface): Surface {
  const without = { normals: !given.normals, uvs: !given.uvs };
  const uvs = given.uvs ?? new Float32Array((given.positions.length / 3) * 2);
  if (given.normals) return { ...given, normals: given.normals, uvs, sourceOfVertex: null, without };
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
    without,
  };
}

/** The surface as morph targets shape it, whose tangents are computed from that shape. */
export function shaped(given: GivenSurface): Surface {
  return completed({ ...given, ...given.shape });
}

/** Elements of `width` floats, taken from the places `sources`. */
export function gathered(array: Float32Array, width: number, sources: Uint32Array): Float32Array<ArrayBuffer> {
  const out = new Float32Array(sources.length * width);
  for (let at = 0; at < sources.length; at++) {
    for (let i = 0; i < width; i++) out[at * width + i] = array[sources[at] * width + i];
  }
  return out;
}
