// A thread of its own for baking, which the page can end at any time.

import { PreparedModels, ready, TEXEL_STATES, type BakeModelsOptions, type BakeReport } from 'darboux/bake';

import { answer, tellProgress } from '../worker/calls';

/** A baked map as the page shows it: 4 bytes per texel, the top row first. */
export interface ShownBake {
  width: number;
  height: number;
  /** The normal map with 8 bits per channel. */
  normals: Uint8ClampedArray<ArrayBuffer>;
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

/** The models of the last bake, with the material that it was prepared for: all other options may change without reading them again. */
let prepared: { models: PreparedModels; material: number | null } | null = null;

/** The functions that the page can call. */
const functions = {
  /** Replaces the models, which are self-contained GLBs. */
  open(low: Uint8Array, high: Uint8Array[]): void {
    [files, prepared] = [{ low, high }, null];
  },

  /** Bakes the normal map of the low model. */
  bake({ material = null, ...options }: Omit<BakeModelsOptions, 'maps' | 'onProgress'>): ShownBake {
    const start = performance.now();
    const kept = prepared?.material === material ? prepared.models : null;
    // Other models are freed before new ones are made. Models on which a bake failed for want of memory are lost.
    prepared = null;
    const models = kept ?? new PreparedModels(files.low, files.high, { material });
    const baked = models.bake({ ...options, onProgress: tellProgress });
    prepared = { models, material };
    const seconds = (performance.now() - start) / 1000;
    const [width, height] = baked.size;
    const { report, warnings } = baked;
    return { width, height, normals: texels(baked.normal!), misses: missesOf(baked.states), material, report, warnings, seconds };
  },
};

export type BakerFunctions = typeof functions;

/** Vectors with 8 bits per component. */
function texels(normals: Float32Array): Uint8ClampedArray<ArrayBuffer> {
  const out = new Uint8ClampedArray((normals.length / 3) * 4).fill(255);
  for (let texel = 0; texel < normals.length / 3; texel++) {
    for (let i = 0; i < 3; i++) out[texel * 4 + i] = 127.5 + 127.5 * normals[texel * 3 + i];
  }
  return out;
}

function missesOf(states: Uint8Array): Uint8ClampedArray<ArrayBuffer> {
  const out = new Uint8ClampedArray(states.length * 4);
  states.forEach((state, texel) => {
    const color = MISS_COLORS[TEXEL_STATES[state]];
    if (color) out.set([...color, 255], texel * 4);
  });
  return out;
}

answer(functions, ready);
