// The sources of tangents that the page compares.

import { generateTangents, type Method, type Mode } from 'darboux';

import { derivativeTangents } from './derivative-tangents';
import { METHODS } from './methods';
import { gathered, type Surface } from './surface';

/** A source of tangents: the file's own, a method's, or those that a shader derives. */
export type Source = 'file' | Method | 'mikktspace-reference' | 'mikktspace-corrected' | 'derivatives';

/** The sources that a side can show. */
export const SOURCES: readonly Source[] = [
  'file',
  'mikktspace',
  'mikktspace-reference',
  'mikktspace-corrected',
  ...METHODS.filter((method) => method !== 'mikktspace'),
  'derivatives',
];

/** What a side shows: a source of tangents on the open model, that model with the baked map, or the repaired or the high model as it is. */
export type Shown = Source | OtherModel | 'baked';

/** Models beside the open one. */
export type OtherModel = 'repaired' | 'high';

/** Whether a side shows another model, with other vertices than the open one. */
export function isOtherModel(shown: Shown): shown is OtherModel {
  return shown === 'repaired' || shown === 'high';
}

/** The names of methods on the page, where they say more than the method's own name. */
const METHOD_NAMES: Partial<Record<Method, string>> = {
  mikktspace: 'MikkTSpace',
  'angle-area': 'Angle and area',
  'angle-edge': 'Angle and edges (meshoptimizer)',
  lengyel: 'Lengyel',
  'lengyel-per-vertex': 'Lengyel per vertex (three.js)',
  average: 'Average',
  area: 'Area',
  face: 'Per face',
  'from-normal': 'From the normal',
};

/** The names on the page. */
export const SOURCE_NAMES = {
  ...Object.fromEntries(METHODS.map((method) => [method, METHOD_NAMES[method] ?? method])),
  file: 'In the file',
  'mikktspace-reference': 'MikkTSpace, reference mode',
  'mikktspace-corrected': 'MikkTSpace, corrected mode',
  derivatives: 'Shader derivatives',
  repaired: 'Repaired file',
  high: 'High model',
  baked: 'Baked map',
} as Record<Shown, string>;

/** The tangent of every corner, 4 floats each, with the sign convention of the file's format. Null where the file has no tangents. */
export function tangentsFrom(surface: Surface, source: Source): Float32Array | null {
  if (source === 'file') return surface.tangents && gathered(surface.tangents, 4, surface.indices);
  if (source === 'derivatives') return derivativeTangents(surface);
  const [, method = source, mode] = /^(mikktspace)-(.*)$/.exec(source) ?? [];
  return computedTangents(surface, method as Method, mode as Mode | undefined);
}

/** The tangents of a method, likewise. */
function computedTangents(
  { positions, normals, uvs, indices }: Surface,
  method: Method,
  mode?: Mode,
): Float32Array<ArrayBuffer> {
  const tangents = generateTangents(positions, normals, uvs, indices, { method, mode });
  // v points down the image, as in glTF, so that signs are the negated signs of MikkTSpace.
  for (let w = 3; w < tangents.length; w += 4) tangents[w] = -tangents[w];
  return tangents;
}
