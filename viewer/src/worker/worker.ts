// The thread that computes. It keeps the surfaces of the model that is open; the page asks for what it draws.

import { ready } from 'darboux';

import type { Bundle } from '../files/file-bundle';
import { repair, type Outcome, type Primitive, type Summary } from '../files/gltf-wasm';
import { wholeGltf } from '../files/self-contained';
import { arranged, type Arrangement } from '../surface/comparison';
import type { Source } from '../surface/sources';
import { findings, type Finding } from '../surface/findings';
import { posed } from '../surface/skinning';
import { completed, shaped, type GivenSurface, type Surface } from '../surface/surface';

/** As their files have them, and as the pose of the scene shapes them. */
let surfaces: { stored: Surface; shape: Surface }[] = [];

/** What the page can ask for. */
const work = {
  /** A glTF file with all that it refers to, checked. */
  whole(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Outcome<Primitive[]>> {
    return wholeGltf(name, bytes, bundle);
  },

  /** A GLB with new tangents. */
  repair(name: string, bytes: Uint8Array<ArrayBuffer>): Promise<Outcome<Summary>> {
    return repair(name, bytes);
  },

  /** Takes the surfaces of a model in place of those before. */
  open(given: GivenSurface[]): void {
    surfaces = given.map((one) => {
      const stored = completed(one);
      return { stored, shape: one.shape ? shaped(one) : stored };
    });
  },

  /** A part, ready to be drawn. */
  arrange(part: number, sources: readonly [Source, Source]): Arrangement {
    return arranged(surfaces[part].shape, sources);
  },

  /** What is odd about a part. */
  report(part: number): Finding[] {
    const { stored, shape } = surfaces[part];
    return findings(stored, posed(shape));
  },
};

export type Work = typeof work;

/** A call, and its number. */
export interface Call<K extends keyof Work = keyof Work> {
  id: number;
  name: K;
  args: Parameters<Work[K]>;
}

/** What comes back: a result, or a sentence that says why there is none. */
export type Reply = { id: number; result: unknown } | { id: number; error: string };

addEventListener('message', async ({ data }: MessageEvent<Call>) => {
  const { id, name, args } = data;
  try {
    await ready;
    const result = await (work[name] as (...args: unknown[]) => unknown)(...args);
    postMessage({ id, result } satisfies Reply, { transfer: buffers(result) });
  } catch (error) {
    postMessage({ id, error: error instanceof Error ? error.message : String(error) } satisfies Reply);
  }
});

/** The memory of all arrays in a result, which moves to the page instead of being copied. */
function buffers(result: unknown): ArrayBuffer[] {
  const found = new Set<ArrayBuffer>();
  const look = (value: unknown): void => {
    if (ArrayBuffer.isView(value)) found.add(value.buffer as ArrayBuffer);
    else if (value && typeof value === 'object') Object.values(value).forEach(look);
  };
  look(result);
  // What the surfaces themselves hold stays here.
  for (const surface of surfaces.flatMap(({ stored, shape }) => [stored, shape])) {
    for (const value of Object.values(surface)) if (ArrayBuffer.isView(value)) found.delete(value.buffer as ArrayBuffer);
  }
  return [...found];
}
