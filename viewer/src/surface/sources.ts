// The sources of tangents that the page compares.

import { generateTangents } from 'darboux';

import { derivativeTangents } from './derivative-tangents';
import { gathered, type Surface } from './surface';

/** The sources that a side can show. */
export const SOURCES = ['file', 'mikktspace', 'angle-area', 'lengyel', 'derivatives'] as const;

export type Source = (typeof SOURCES)[number];

/** What a side shows: a source of tangents on the open model, or the repaired model as it is. */
export type Shown = Source | 'repaired';

/** The names on the page. */
export const SOURCE_NAMES: Record<Shown, string> = {
  file: 'In the file',
  mikktspace: 'MikkTSpace',
  'angle-area': 'Angle and area',
  lengyel: 'Lengyel',
  derivatives: 'Shader derivatives',
  repaired: 'Repaired file',
};

/** The tangent of every corner, 4 floats each, with the sign convention of the file's format. Null where the file has no tangents. */
export function tangentsFrom(surface: Surface, source: Source): Float32Array | null {
  if (source === 'file') return surface.tangents && gathered(surface.tangents, 4, surface.indices);
  if (source === 'derivatives') return derivativeTangents(surface);
  return computedTangents(surface, source);
}

/** The tangents of a method, likewise. */
export function computedTangents(
  { positions, normals, uvs, indices, vDown }: Surface,
  method: 'mikktspace' | 'angle-area' | 'lengyel',
  mode: 'repaired' | 'reference' = 'repaired',
): Float32Array<ArrayBuffer> {
  const tangents = generateTangents(positions, normals, uvs, indices, { method, mode });
  if (vDown) for (let w = 3; w < tangents.length; w += 4) tangents[w] = -tangents[w];
  return tangents;
}
