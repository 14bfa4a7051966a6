// The worker thread: keeps the surfaces of the open model and computes what the page draws and reports.

import { ready } from 'darboux';

import type { FileBundle } from '../files/file-bundle';
import { repair, type Outcome, type Primitive, type Summary } from '../files/gltf-wasm';
import { makeSelfContained } from '../files/self-contained';
import { compareSources, type Comparison } from '../surface/comparison';
import type { Source } from '../surface/sources';
import { findings, type Finding } from '../surface/findings';
import { placesOf, type Place } from '../surface/places';
import { skinned } from '../surface/skinning';
import { completed, morphed, type GivenSurface, type Surface } from '../surface/surface';
import { answer } from './calls';

/** The surface of a part in the file, and after morph targets. */
interface StoredSurface {
  stored: Surface;
  morphed: Surface;
}

/** The open model, and the same after its repair. */
export type ModelName = 'given' | 'repaired';

/** The parts of the models. */
const surfaces: Record<ModelName, StoredSurface[]> = { given: [], repaired: [] };

/** The functions that the page can call. */
const functions = {
  /** Embeds the files that a glTF refers to, and checks it. */
  makeSelfContained(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: FileBundle): Promise<Outcome<Primitive[]>> {
    return makeSelfContained(name, bytes, bundle);
  },

  /** Writes new tangents into a glTF and returns it as GLB. */
  repair(name: string, bytes: Uint8Array<ArrayBuffer>): Promise<Outcome<Summary>> {
    return repair(name, bytes);
  },

  /** Replaces the surfaces of a model. */
  open(model: ModelName, given: GivenSurface[]): void {
    surfaces[model] = given.map((surface) => {
      const stored = completed(surface);
      return { stored, morphed: surface.shape ? morphed(surface) : stored };
    });
  },

  /** Prepares a part for drawing with two sources of tangents. */
  compare(model: ModelName, part: number, sources: readonly [Source, Source]): Comparison {
    return compareSources(surfaces[model][part].morphed, sources);
  },

  /** Finds the faults of a part of the open model. */
  report(part: number): Finding[] {
    const { stored, morphed } = surfaces.given[part];
    return findings(stored, skinned(morphed));
  },

  /** The triangles or vertices of the open model's part with these numbers, in its pose. */
  places(part: number, kind: 'triangles' | 'vertices', numbers: number[]): Place[] {
    return placesOf(skinned(surfaces.given[part].morphed), kind, numbers);
  },
};

export type WorkerFunctions = typeof functions;

// Buffers of the stored surfaces stay here.
answer(functions, ready, () => surfaces);
