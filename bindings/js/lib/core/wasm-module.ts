// The WebAssembly side: loaded once, called with numbers and places in its memory.

/** What every module has: memory, and places for a call's arrays in it. */
export interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  begin(): void;
  positions(vertices: number): number;
  normals(vertices: number): number;
  uvs(vertices: number): number;
  indices(corners: number): number;
  face_sizes(faces: number): number;
}

/** Memory that stays with a module between calls, in bytes, so that the next need not ask for it again. */
const KEPT = 2 ** 28;

/** Makes a call. Errors: not ready yet, not enough memory. */
export type Call<E extends Exports> = <R>(work: (exports: E) => R) => R;

/** A module that loads. */
export interface Engine<E extends Exports> {
  /** Resolves when calls may begin. */
  ready: Promise<void>;
  call: Call<E>;
  /** An instance for what lasts from call to call. Errors: not ready yet. */
  own(): Own<E>;
}

/** An instance that lasts. */
export interface Own<E extends Exports> {
  call: Call<E>;
  /** Whether its memory is so large, or has been so short, that another one is to be begun. */
  isSpent(): boolean;
}

/** Compiles what build.mjs deflated. The stream is read piece by piece: `Response` would load an HTTP client in Node.js. */
async function compile(deflated: Uint8Array<ArrayBuffer>): Promise<WebAssembly.Module> {
  const reader = new Blob([deflated]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  for (let part = await reader.read(); !part.done; part = await reader.read()) parts.push(part.value);
  return WebAssembly.compile(await new Blob(parts).arrayBuffer());
}

/** Begins to load a module; the form without SIMD is asked for only where there is no SIMD. */
export function load<E extends Exports>(
  simd: Uint8Array<ArrayBuffer>,
  scalar: () => Promise<{ default: Uint8Array<ArrayBuffer> }>,
): Engine<E> {
  let module: WebAssembly.Module;
  let exports: E | undefined;

  async function start(): Promise<void> {
    module = await compile(simd).catch(async () => compile((await scalar()).default));
    exports = (await WebAssembly.instantiate(module)).exports as E;
  }

  const instance = () => new WebAssembly.Instance(module).exports as E;

  function shared(): E {
    if (!exports) throw new Error('darboux has not loaded yet; await ready before the first call');
    return exports;
  }

  function call<R>(work: (exports: E) => R): R {
    const exported = shared();
    let keeps = false;
    try {
      const result = work(exported);
      keeps = true;
      return result;
    } catch (error) {
      keeps = !isTrap(error);
      throw keeps ? error : outOfMemory(error);
    } finally {
      // Memory of WebAssembly never shrinks, and nothing is known of it after a call that ended within.
      if (!keeps || exported.memory.buffer.byteLength > KEPT) exports = instance();
    }
  }

  function own(): Own<E> {
    shared();
    const mine = instance();
    let lost: RangeError | undefined;
    const call: Call<E> = (work) => {
      if (lost) throw lost;
      try {
        return work(mine);
      } catch (error) {
        if (isTrap(error)) lost = outOfMemory(error);
        throw lost ?? error;
      }
    };
    return { call, isSpent: () => lost !== undefined || mine.memory.buffer.byteLength > KEPT };
  }

  const ready = start();
  // Who never calls need not hear that nothing loads; who awaits does.
  ready.catch(() => {});
  return { ready, call, own };
}

const isTrap = (error: unknown) => error instanceof WebAssembly.RuntimeError;

const outOfMemory = (cause: unknown) => new RangeError('the mesh needs more memory than WebAssembly can have; split it', { cause });
