// Prepares a surface for drawing with the tangents of two sources: vertices are split wherever either source needs it.

import { splitVertices } from 'darboux';

import { angles } from './angles';
import { skinned, skinnedTangents } from './skinning';
import { edgePairsOf, endsAt, mirroredEdges } from './mirrored-edges';
import { tangentsFrom, type Source } from './sources';
import { gathered, type Surface } from './surface';

/** The data of both sides. */
export interface Comparison {
  indices: Uint32Array;
  /** The original vertex that each vertex copies. */
  sourceOfVertex: Uint32Array;
  positions: Float32Array;
  normals: Float32Array;
  uvs: Float32Array;
  /** For each side 4 floats per vertex, or null where its source has no tangents. */
  tangents: [Float32Array | null, Float32Array | null];
  /** The angle between both tangents of each vertex (see {@link angles}), or null where a side has none. */
  angles: Float32Array | null;
  /** For each side the ends of its mirrored edges, 6 floats per edge. */
  seams: [Float32Array, Float32Array];
}

/** Computes the tangents of two sources for a surface in its pose. */
export function compareSources(morphed: Surface, sources: readonly [Source, Source]): Comparison {
  const surface = skinned(morphed);
  const corners = sources.map((source) => {
    // Renderers skin the tangents of vertices, whereas shaders take derivatives of the skinned surface.
    if (source === 'derivatives') return tangentsFrom(surface, source);
    const tangents = tangentsFrom(morphed, source);
    return tangents && skinnedTangents(morphed, tangents);
  }) as [Float32Array | null, Float32Array | null];
  const between = corners[0] && corners[1] && angles(corners[0], corners[1]);
  let indices = surface.indices;
  let sourceOfVertex: Uint32Array = Uint32Array.from({ length: surface.positions.length / 3 }, (_, vertex) => vertex);
  const fields = [...corners, between && asTangents(between)];
  for (const field of fields) {
    if (!field) continue;
    const split = splitVertices(indices, field, sourceOfVertex.length);
    const before = sourceOfVertex;
    indices = split.indices;
    sourceOfVertex = split.sourceOfVertex.map((vertex) => before[vertex]);
  }
  const count = sourceOfVertex.length;
  const { sourceOfVertex: given } = surface;
  return {
    indices,
    sourceOfVertex: given ? sourceOfVertex.map((vertex) => given[vertex]) : sourceOfVertex,
    positions: gathered(surface.positions, 3, sourceOfVertex),
    normals: gathered(surface.normals, 3, sourceOfVertex),
    uvs: gathered(surface.uvs, 2, sourceOfVertex),
    tangents: corners.map((field) => field && ofVertices(field, 4, indices, count)) as Comparison['tangents'],
    angles: between && ofVertices(between, 1, indices, count),
    seams: corners.map((field) => endsAt(surface, field ? mirroredEdges(field, edgePairsOf(morphed)) : [])) as Comparison['seams'],
  };
}

/** One float per corner as four floats, which `splitVertices` takes. */
function asTangents(field: Float32Array): Float32Array {
  const out = new Float32Array(field.length * 4);
  field.forEach((value, corner) => (out[corner * 4] = value));
  return out;
}

/** Values of corners as values of vertices, whose corners all have the same value. */
function ofVertices(field: Float32Array, width: number, indices: Uint32Array, count: number): Float32Array {
  const out = new Float32Array(count * width);
  for (let corner = 0; corner < indices.length; corner++) {
    for (let i = 0; i < width; i++) out[indices[corner] * width + i] = field[corner * width + i];
  }
  return out;
}
