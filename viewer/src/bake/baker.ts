// A thread of its own for baking, which the page can end at any time.

import { PreparedModels, ready, TEXEL_STATES, type BakeModelsOptions, type BakeReport } from 'darboux/bake';

import { answer, tellProgress } from '../worker/calls';
import { furtherMap, normalTexels, type FurtherKind, type FurtherMap } from './map-texels';

/** The options of a bake. `maps`: those beside the normal map, which is always baked. */
export type BakerOptions = Omit<BakeModelsOptions, 'maps' | 'onProgress'> & { maps: FurtherKind[] };

/** Baked maps as the page shows them: 4 bytes per texel, the top row first. */
export interface ShownBake {
  width: number;
  height: number;
  /** The normal map with 8 bits per channel. */
  normals: Uint8ClampedArray<ArrayBuffer>;
  /** The other maps that were chosen. */
  further: FurtherMap[];
  /** Red where no ray hit, orange where rays met triangles from behind, transparent elsewhere. */
  misses: Uint8ClampedArray<ArrayBuffer>;
  /** The index of the only material that was baked; null: all were. */
  material: number | null;
  report: BakeReport;
  warnings: string[];
  /** The time of the bake in seconds. */
  seconds: number;
}

/** The colours of misses: those of the command's picture. */
const MISS_COLORS: Partial<Record<(typeof TEXEL_STATES)[number], readonly [number, number, number]>> = {
  missed: [255, 0, 0],
  missedBehind: [255, 160, 0],
};

let files: { low: Uint8Array; high: Uint8Array[] } = { low: new Uint8Array(), high: [] };

/** The models of the last bake, with the material and the maps that they were prepared for: all other options may change without reading them again. */
let prepared: { models: PreparedModels; shared: string } | null = null;

/** The functions that the page can call. */
const functions = {
  /** Replaces the models, which are self-contained GLBs. */
  open(low: Uint8Array, high: Uint8Array[]): void {
    [files, prepared] = [{ low, high }, null];
  },

  /** Bakes the normal map of the low model and the chosen maps, from the same rays. */
  bake({ material = null, maps, ...options }: BakerOptions): ShownBake {
    const start = performance.now();
    const shared = JSON.stringify({ material, maps });
    const kept = prepared?.shared === shared ? prepared.models : null;
    // Other models are freed before new ones are made. Models on which a bake failed for want of memory are lost.
    prepared = null;
    const models = kept ?? new PreparedModels(files.low, files.high, { material, maps: ['normal', ...maps] });
    const baked = models.bake({ ...options, onProgress: tellProgress });
    prepared = { models, shared };
    const seconds = (performance.now() - start) / 1000;
    const [width, height] = baked.size;
    const { report, warnings } = baked;
    const further = maps.map((kind) => furtherMap(kind, baked));
    return { width, height, normals: normalTexels(baked.normal!), further, misses: missesOf(baked.states), material, report, warnings, seconds };
  },
};

export type BakerFunctions = typeof functions;

function missesOf(states: Uint8Array): Uint8ClampedArray<ArrayBuffer> {
  const out = new Uint8ClampedArray(states.length * 4);
  states.forEach((state, texel) => {
    const color = MISS_COLORS[TEXEL_STATES[state]];
    if (color) out.set([...color, 255], texel * 4);
  });
  return out;
}

answer(functions, ready);
