// Where triangles and vertices of a surface are.

import type { Surface } from './surface';

/** A place on a surface. */
export interface Place {
  /** The middle of the triangle, or the vertex. */
  position: [number, number, number];
  normal: [number, number, number];
  /** The positions of a triangle's corners, 9 floats; null for a vertex. */
  corners: Float32Array<ArrayBuffer> | null;
}

/** The places of triangles or vertices with these numbers. Vertices are numbered as in the file. Numbers that do not exist are left out. */
export function placesOf(surface: Surface, kind: 'triangles' | 'vertices', numbers: number[]): Place[] {
  const found = numbers.map((number) => (kind === 'triangles' ? triangle(surface, number) : vertex(surface, number)));
  return found.filter((place) => place !== null);
}

function triangle({ indices, positions, normals }: Surface, number: number): Place | null {
  if (3 * number + 2 >= indices.length) return null;
  const vertices = [...indices.subarray(3 * number, 3 * number + 3)];
  const mean = (array: Float32Array) => [0, 1, 2].map((i) => vertices.reduce((sum, vertex) => sum + array[vertex * 3 + i] / 3, 0)) as Place['position'];
  const corners = Float32Array.from(vertices.flatMap((vertex) => [...positions.subarray(vertex * 3, vertex * 3 + 3)]));
  return { position: mean(positions), normal: mean(normals), corners };
}

function vertex({ positions, normals, sourceOfVertex }: Surface, number: number): Place | null {
  const own = sourceOfVertex ? sourceOfVertex.indexOf(number) : number;
  if (own < 0 || own * 3 >= positions.length) return null;
  const at = (array: Float32Array) => [...array.subarray(own * 3, own * 3 + 3)] as Place['position'];
  return { position: at(positions), normal: at(normals), corners: null };
}
