// The worker thread: keeps the surfaces of the open model and computes what the page draws.

import { ready } from 'darboux';

import type { FileBundle } from '../files/file-bundle';
import { check, makeNormals, repair, type Checked, type Outcome, type Summary } from '../files/gltf-wasm';
import { compareSources, type Comparison } from '../surface/comparison';
import type { OtherModel, Source } from '../surface/sources';
import { placesOf, type Place } from '../surface/places';
import { skinned } from '../surface/skinning';
import { morphed, type GivenSurface, type Surface } from '../surface/surface';
import { answer } from './calls';

/** The open model, the same after its repair, and the high model of a bake. */
export type ModelName = 'given' | OtherModel;

/** The parts of the models, after morph targets. */
const surfaces: Record<ModelName, Surface[]> = { given: [], repaired: [], high: [] };

/** The functions that the page can call. */
const functions = {
  /** Embeds the files that a glTF refers to, and checks it. */
  check(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: FileBundle): Promise<Outcome<Checked>> {
    return check(name, bytes, bundle);
  },

  /** Writes new tangents into a model and returns it as GLB. */
  repair(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: FileBundle): Promise<Outcome<Summary>> {
    return repair(name, bytes, bundle);
  },

  /** Makes the normals that a glTF lacks, and returns it as GLB. */
  makeNormals(name: string, bytes: Uint8Array<ArrayBuffer>): Promise<Outcome<unknown>> {
    return makeNormals(name, bytes);
  },

  /** Replaces the surfaces of a model. */
  open(model: ModelName, given: GivenSurface[]): void {
    surfaces[model] = given.map(morphed);
  },

  /** Prepares a part for drawing with two sources of tangents. */
  compare(model: ModelName, part: number, sources: readonly [Source, Source]): Comparison {
    return compareSources(surfaces[model][part], sources);
  },

  /** The triangles or vertices of the open model's part with these numbers, in its pose. */
  places(part: number, kind: 'triangles' | 'vertices', numbers: number[]): Place[] {
    return placesOf(skinned(surfaces.given[part]), kind, numbers);
  },
};

export type WorkerFunctions = typeof functions;

// Buffers of the stored surfaces stay here.
answer(functions, ready, () => surfaces);
