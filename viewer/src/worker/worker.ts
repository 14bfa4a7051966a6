// The worker thread: keeps the surfaces of the open model and computes what the page draws and reports.

import { ready } from 'darboux';

import type { FileBundle } from '../files/file-bundle';
import { repair, type Outcome, type Primitive, type Summary } from '../files/gltf-wasm';
import { makeSelfContained } from '../files/self-contained';
import { compareSources, type Comparison } from '../surface/comparison';
import type { Source } from '../surface/sources';
import { findings, type Finding } from '../surface/findings';
import { skinned } from '../surface/skinning';
import { completed, morphed, type GivenSurface, type Surface } from '../surface/surface';

/** For each part of the model, its surface in the file, and the surface after morph targets. */
let surfaces: { stored: Surface; morphed: Surface }[] = [];

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

  /** Replaces the surfaces by those of another model. */
  open(given: GivenSurface[]): void {
    surfaces = given.map((surface) => {
      const stored = completed(surface);
      return { stored, morphed: surface.shape ? morphed(surface) : stored };
    });
  },

  /** Prepares a part for drawing with two sources of tangents. */
  compare(part: number, sources: readonly [Source, Source]): Comparison {
    return compareSources(surfaces[part].morphed, sources);
  },

  /** Finds the faults of a part. */
  report(part: number): Finding[] {
    const { stored, morphed } = surfaces[part];
    return findings(stored, skinned(morphed));
  },
};

export type WorkerFunctions = typeof functions;

/** A call of a function, with a number that the reply repeats. */
export interface Call<K extends keyof WorkerFunctions = keyof WorkerFunctions> {
  id: number;
  name: K;
  args: Parameters<WorkerFunctions[K]>;
}

/** The reply to a call: a result, or the message of an error. */
export type Reply = { id: number; result: unknown } | { id: number; error: string };

addEventListener('message', async ({ data }: MessageEvent<Call>) => {
  const { id, name, args } = data;
  try {
    await ready;
    const result = await (functions[name] as (...args: unknown[]) => unknown)(...args);
    postMessage({ id, result } satisfies Reply, { transfer: transferableBuffers(result) });
  } catch (error) {
    postMessage({ id, error: error instanceof Error ? error.message : String(error) } satisfies Reply);
  }
});

/** The buffers of all arrays in a result. They are transferred to the page instead of copied. */
function transferableBuffers(result: unknown): ArrayBuffer[] {
  const found = new Set<ArrayBuffer>();
  const collect = (value: unknown): void => {
    if (ArrayBuffer.isView(value)) found.add(value.buffer as ArrayBuffer);
    else if (value && typeof value === 'object') Object.values(value).forEach(collect);
  };
  collect(result);
  // Buffers of the stored surfaces stay here.
  for (const surface of surfaces.flatMap(({ stored, morphed }) => [stored, morphed])) {
    for (const value of Object.values(surface)) if (ArrayBuffer.isView(value)) found.delete(value.buffer as ArrayBuffer);
  }
  return [...found];
}
