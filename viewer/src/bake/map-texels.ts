// The kinds of maps that a bake can have, and their numbers as images of 8 bits, as the command writes them.

import type { BakedImages, BakedMaps, MapKind } from 'darboux/bake';

/** A kind of map that can be baked beside the normal map. 'texture' needs the name of a texture, which the page does not ask for. */
export type FurtherKind = Exclude<MapKind, 'normal' | 'texture'>;

/** What the numbers of a map mean: 'signed' ones are from -1 to 1, 'shares' from 0 to 1, 'lengths' in units of the positions, 'light' linear. */
type Content = 'signed' | 'shares' | 'lengths' | 'light';

/** The kinds of the package, which the compiler compares with this table. */
const CONTENTS: Record<FurtherKind, Content> = {
  'ao': 'shares',
  'base-color': 'light',
  'roughness': 'shares',
  'metalness': 'shares',
  'emission': 'light',
  'opacity': 'shares',
  'vertex-color': 'shares',
  'curvature': 'signed',
  'thickness': 'lengths',
  'height': 'lengths',
  'position': 'lengths',
  'bent-normal': 'signed',
  'object-bent-normal': 'signed',
  'object-normal': 'signed',
  'id': 'shares',
  'uv-islands': 'shares',
  'wireframe': 'shares',
  'world-direction': 'signed',
};

/** All kinds beside the normal map. */
export const FURTHER_KINDS = Object.keys(CONTENTS) as FurtherKind[];

/** The values that black and white stand for. */
export type ValueRange = readonly [number, number];

/** A map as an image: 4 bytes per texel, the top row first. */
export interface FurtherMap {
  kind: FurtherKind;
  texels: Uint8ClampedArray<ArrayBuffer>;
  /** One for each channel. */
  ranges: ValueRange[];
}

/** Whether a map holds light, whose texels are sRGB. */
export function isLight(kind: FurtherKind): boolean {
  return CONTENTS[kind] === 'light';
}

/** A map of a bake as an image. */
export function furtherMap(kind: FurtherKind, baked: BakedMaps): FurtherMap {
  const member = kind.replaceAll(/-(.)/g, (_, letter: string) => letter.toUpperCase()) as keyof BakedImages;
  const numbers = baked[member]!;
  const ranges = rangesOf(kind, numbers, numbers.length / baked.states.length, baked.distance);
  return { kind, texels: texelsOf(numbers, ranges, isLight(kind)), ranges };
}

/** The texels of a normal map. */
export function normalTexels(normals: Float32Array): Uint8ClampedArray<ArrayBuffer> {
  return texelsOf(normals, [[-1, 1], [-1, 1], [-1, 1]], false);
}

/** Opaque texels; maps with one number per texel are grey. `ranges`: one for each number of a texel. */
function texelsOf(numbers: Float32Array, ranges: ValueRange[], isLight: boolean): Uint8ClampedArray<ArrayBuffer> {
  const channels = ranges.length;
  const count = numbers.length / channels;
  const out = new Uint8ClampedArray(4 * count).fill(255);
  for (let i = 0; i < 3; i++) {
    const channel = channels === 1 ? 0 : i;
    const [black, white] = ranges[channel];
    for (let texel = 0; texel < count; texel++) {
      const share = white > black ? (numbers[channels * texel + channel] - black) / (white - black) : 0.5;
      out[4 * texel + i] = 255 * (isLight ? toSrgb(share) : share);
    }
  }
  return out;
}

function toSrgb(linear: number): number {
  return linear <= 0.04045 / 12.92 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055;
}

/** The range of each channel. `distance`: how far outside rays began and how far inside they ended. */
function rangesOf(kind: FurtherKind, numbers: Float32Array, channels: number, distance: BakedMaps['distance']): ValueRange[] {
  const all = (range: ValueRange) => Array<ValueRange>(channels).fill(range);
  const content = CONTENTS[kind];
  if (content === 'signed') return all([-1, 1]);
  if (content === 'shares') return all([0, 1]);
  const extremes = extremesOf(numbers, channels);
  if (kind === 'position') return extremes;
  const largest = Math.max(...extremes.flat().map(Math.abs));
  if (content === 'light') return all([0, Math.max(1, largest)]);
  const reach = Math.max(...distance, largest);
  return all(kind === 'height' ? [-reach, reach] : [0, largest]);
}

/** The least and the largest number of each channel. */
function extremesOf(numbers: Float32Array, channels: number): ValueRange[] {
  return Array.from({ length: channels }, (_, channel): ValueRange => {
    let [least, largest] = [Infinity, -Infinity];
    for (let at = channel; at < numbers.length; at += channels) {
      least = Math.min(least, numbers[at]);
      largest = Math.max(largest, numbers[at]);
    }
    return [least, largest];
  });
}
