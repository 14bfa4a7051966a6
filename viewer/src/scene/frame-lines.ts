// Lines over a model: the vectors of frames at its vertices, and mirrored edges.

import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments, Matrix3, Matrix4, Vector3 } from 'three';

import type { VectorName } from '../settings';

/** Lines of n dashes, so that vectors are told apart without their colours. */
export const VECTOR_DASHES: Record<VectorName, number> = { tangent: 1, bitangent: 3, normal: 2 };

/** The part of a dash's length that is drawn. */
const DRAWN = 0.6;

/** The usual colours of axes. */
export const VECTOR_COLORS: Record<VectorName, string> = { tangent: '#ff4d4d', bitangent: '#4dd24d', normal: '#5c8cff' };

export const SEAM_COLOR = '#ff4dd8';

/** The limit on lines per part. Beyond it only every n-th vertex has lines. */
const MAX_LINES = 50_000;

/** The vertices at which lines start. */
export interface LineVertices {
  positions: Float32Array;
  normals: Float32Array;
  /** 4 floats per vertex. */
  tangents: Float32Array;
  /** The world matrix of every copy of the part. */
  places: Matrix4[];
}

/** One kind of vector at the vertices, as lines of equal length. */
export function vectorLines(vertices: LineVertices, name: VectorName, length: number): LineSegments {
  const { positions, places } = vertices;
  const count = positions.length / 3;
  const step = Math.ceil((count * places.length) / MAX_LINES);
  const dashes = VECTOR_DASHES[name];
  const out = new Float32Array(Math.ceil((count * places.length) / step) * 6 * dashes);
  const [from, along, directions, end] = [new Vector3(), new Vector3(), new Matrix3(), new Vector3()];
  for (let line = 0, at = 0; line < count * places.length; line += step) {
    const [vertex, place] = [line % count, places[Math.floor(line / count)]];
    from.fromArray(positions, vertex * 3).applyMatrix4(place);
    direction(vertices, name, vertex, along).applyMatrix3(directions.setFromMatrix4(place)).setLength(length);
    for (let dash = 0; dash < dashes; dash++, at += 6) {
      end.copy(from).addScaledVector(along, dash / dashes).toArray(out, at);
      end.copy(from).addScaledVector(along, (dash + (dashes > 1 ? DRAWN : 1)) / dashes).toArray(out, at + 3);
    }
  }
  return segments(out, VECTOR_COLORS[name]);
}

function direction({ normals, tangents }: LineVertices, name: VectorName, vertex: number, out: Vector3): Vector3 {
  if (name === 'tangent') return out.fromArray(tangents, vertex * 4);
  out.fromArray(normals, vertex * 3);
  return name === 'normal' ? out : out.cross(new Vector3().fromArray(tangents, vertex * 4)).multiplyScalar(tangents[vertex * 4 + 3]);
}

/** Mirrored edges in every copy of a part. `ends` has 6 floats per edge. */
export function seamLines(ends: Float32Array, places: Matrix4[]): LineSegments {
  const out = new Float32Array(ends.length * places.length);
  const end = new Vector3();
  places.forEach((place, copy) => {
    for (let at = 0; at < ends.length; at += 3) end.fromArray(ends, at).applyMatrix4(place).toArray(out, copy * ends.length + at);
  });
  return segments(out, SEAM_COLOR);
}

function segments(ends: Float32Array, color: string): LineSegments {
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(ends, 3));
  const lines = new LineSegments(geometry, new LineBasicMaterial({ color, toneMapped: false }));
  lines.frustumCulled = false;
  return lines;
}
