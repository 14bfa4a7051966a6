// The WebAssembly side: loaded once, called with numbers and places in its memory.

/** What every module has: memory, and places for a call's arrays in it. */
export interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  positions(vertices: number): number;
  normals(vertices: number): number;
  uvs(vertices: number): number;
  indices(corners: number): number;
  face_sizes(faces: number): number;
  clear(): void;
}

/** A module that loads. */
export interface Engine<E extends Exports> {
  /** Resolves when calls may begin. */
  ready: Promise<void>;
  /** Makes a call and frees what it used. Errors: not ready yet, not enough memory. */
  call<R>(work: (exports: E) => R): R;
}

/** Begins to load a module; the form without SIMD is asked for only where there is no SIMD. */
export function load<E extends Exports>(
  simd: Uint8Array<ArrayBuffer>,
  scalar: () => Promise<{ default: Uint8Array<ArrayBuffer> }>,
): Engine<E> {
  let module: WebAssembly.Module;
  let exports: E | undefined;

  async function start(): Promise<void> {
    module = await WebAssembly.compile(simd).catch(async () => WebAssembly.compile((await scalar()).default));
    exports = (await WebAssembly.instantiate(module)).exports as E;
  }

  function call<R>(work: (exports: E) => R): R {
    if (!exports) throw new Error('darboux has not loaded yet; await ready before the first call');
    try {
      return work(exports);
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) throw error;
      // Nothing is known of the memory of a call that ended within.
      exports = new WebAssembly.Instance(module).exports as E;
      throw new RangeError('the mesh needs more memory than WebAssembly can have; split it', { cause: error });
    } finally {
      exports.clear();
    }
  }

  const ready = start();
  // Who never calls need not hear that nothing loads; who awaits does.
  ready.catch(() => {});
  return { ready, call };
}
