// A surface made ready to be drawn with the tangents of two sources at once: its vertices split wherever either needs it.

import { splitVertices } from 'darboux';

import { angles } from './angles';
import { posed, posedTangents } from './skinning';
import { edgePairsOf, endsAt, seamCorners } from './mirrored-edges';
import { tangentsFrom, type Source } from './sources';
import { gathered, type Surface } from './surface';

/** What both sides are drawn from. */
export interface Arrangement {
  indices: Uint32Array;
  /** The given vertex that each new one copies. */
  sourceOfVertex: Uint32Array;
  positions: Float32Array;
  normals: Float32Array;
  uvs: Float32Array;
  /** Per side, 4 floats per vertex; null where a side's source has none. */
  tangents: [Float32Array | null, Float32Array | null];
  /** Degrees between the two, per vertex; see {@link angles}. Null where one is missing. */
  angles: Float32Array | null;
  /** Per side the ends of its mirrored seams, 6 floats each. */
  seams: [Float32Array, Float32Array];
}

/** Arranges a surface for two sources, in its pose. */
export function arranged(shape: Surface, sources: readonly [Source, Source]): Arrangement {
  const surface = posed(shape);
  const corners = sources.map((source) => {
    // Renderers turn vertex data with the skin; derivatives are those of what is seen.
    if (source === 'derivatives') return tangentsFrom(surface, source);
    const tangents = tangentsFrom(shape, source);
    return tangents && posedTangents(shape, tangents);
  }) as [Float32Array | null, Float32Array | null];
  const between = corners[0] && corners[1] && angles(corners[0], corners[1]);
  let indices = surface.indices;
  let sourceOfVertex: Uint32Array = Uint32Array.from({ length: surface.positions.length / 3 }, (_, vertex) => vertex);
  const fields = [...corners, between && spread(between)];
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
    tangents: corners.map((field) => field && ofVertices(field, 4, indices, count)) as Arrangement['tangents'],
    angles: between && ofVertices(between, 1, indices, count),
    seams: corners.map((field) => endsAt(surface, field ? seamCorners(field, edgePairsOf(shape)) : [])) as Arrangement['seams'],
  };
}

/** One float per corner as four, which is what vertices are split by. */
function spread(field: Float32Array): Float32Array {
  const out = new Float32Array(field.length * 4);
  field.forEach((value, corner) => (out[corner * 4] = value));
  return out;
}

/** What corners agree on, per vertex. */
function ofVertices(field: Float32Array, width: number, indices: Uint32Array, count: number): Float32Array {
  const out = new Float32Array(count * width);
  for (let corner = 0; corner < indices.length; corner++) {
    for (let i = 0; i < width; i++) out[indices[corner] * width + i] = field[corner * width + i];
  }
  return out;
}
