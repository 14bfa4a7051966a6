// Where tangents come from.

import { generateTangents } from 'darboux';

import { derivativeTangents } from './derivative-tangents';
import { gathered, type Surface } from './surface';

/** What a side of the picture can show. */
export const SOURCES = ['file', 'mikktspace', 'angle-area', 'lengyel', 'derivatives'] as const;

export type Source = (typeof SOURCES)[number];

/** How they are called. */
export const SOURCE_NAMES: Record<Source, string> = {
  file: 'In the file',
  mikktspace: 'MikkTSpace',
  'angle-area': 'Angle and area',
  lengyel: 'Lengyel',
  derivatives: 'Shader derivatives',
};

/** The tangent of every corner (4 floats), with signs as the file's renderer expects them; null where the file has none. */
export function tangentsFrom(surface: Surface, source: Source): Float32Array | null {
  if (source === 'file') return surface.tangents && gathered(surface.tangents, 4, surface.indices);
  if (source === 'derivatives') return derivativeTangents(surface);
  return computedTangents(surface, source);
}

/** As {@link tangentsFrom}, computed. */
export function computedTangents(
  { positions, normals, uvs, indices, vDown }: Surface,
  method: 'mikktspace' | 'angle-area' | 'lengyel',
  mode: 'repaired' | 'reference' = 'repaired',
): Float32Array<ArrayBuffer> {
  const tangents = generateTangents(positions, normals, uvs, indices, { method, mode });
  if (vDown) for (let w = 3; w < tangents.length; w += 4) tangents[w] = -tangents[w];
  return tangents;
}
