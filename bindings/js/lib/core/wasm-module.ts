// Loads a WebAssembly module once and calls its functions: compilation, random hash keys, memory limits, lost instances.

/** The functions that every module exports. Those that return an address take the number of elements to make room for. */
export interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  /** Takes 64 random bits for hash keys, before any other call. */
  seed_random(low: number, high: number): void;
  /** Whether an allocation has failed. */
  lacks_memory(): number;
  begin(): void;
  positions(vertices: number): number;
  normals(vertices: number): number;
  uvs(vertices: number): number;
  indices(corners: number): number;
  face_sizes(faces: number): number;
}

/** An instance whose memory exceeds this many bytes after a call is replaced: memory of WebAssembly never shrinks. */
const MAX_KEPT_MEMORY = 2 ** 28;

/** A single array of 2 GiB ends in a trap without an allocation. A trap of an instance with a quarter of that is taken for such an array. */
const LARGE_MEMORY = 2 ** 29;

/** Runs a function with the exports of an instance. @throws RangeError where WebAssembly has not enough memory; Error where darboux has a fault, and in a callback of a call of the same instance. */
export type Call<E extends Exports> = <R>(work: (exports: E) => R) => R;

/** A module that is loading, or has loaded. */
export interface WasmModule<E extends Exports> {
  /** Resolves when calls are possible. */
  ready: Promise<void>;
  /** Calls the shared instance. @throws Error before {@link ready} has resolved. */
  call: Call<E>;
  /** Makes an instance for state that outlives a call. @throws Error before {@link ready} has resolved. */
  newInstance(): OwnInstance<E>;
}

/** An instance whose state outlives calls. */
export interface OwnInstance<E extends Exports> {
  call: Call<E>;
  /** True when new state belongs into another instance: memory is large, or a call ran out of memory. */
  isFull(): boolean;
}

/** Inflates and compiles a module. The stream is read chunk by chunk, because `Response` would load an HTTP client in Node.js. */
async function compile(deflated: Uint8Array<ArrayBuffer>): Promise<WebAssembly.Module> {
  const reader = new Blob([deflated]).stream().pipeThrough(new DecompressionStream('deflate-raw')).getReader();
  const chunks: Uint8Array<ArrayBuffer>[] = [];
  for (let chunk = await reader.read(); !chunk.done; chunk = await reader.read()) chunks.push(chunk.value);
  return WebAssembly.compile(await new Blob(chunks).arrayBuffer());
}

/** Seeds the hash keys of a new instance, so that nobody can make a mesh whose keys collide. */
function seeded<E extends Exports>(instance: WebAssembly.Instance): E {
  const exports = instance.exports as E;
  const [low, high] = crypto.getRandomValues(new Uint32Array(2));
  exports.seed_random(low!, high!);
  return exports;
}

/** Starts to load a module. The form without SIMD is imported only where the one with SIMD does not compile. `callbacks`: the functions that the module imports; `tooLarge`: the sentence where memory does not suffice. */
export function load<E extends Exports>(
  simd: Uint8Array<ArrayBuffer>,
  scalar: () => Promise<{ default: Uint8Array<ArrayBuffer> }>,
  callbacks: Record<string, (...numbers: number[]) => void> = {},
  tooLarge = 'the mesh needs more memory than WebAssembly can have; split it',
): WasmModule<E> {
  let module: WebAssembly.Module;
  let exports: E | undefined;
  /** Of the innermost call: whether a callback is running, or has ended the call with an error. */
  let isInCallback = false;
  /** The instances whose calls have not ended. */
  const running = new Set<E>();

  const watched = Object.entries(callbacks).map(([name, callback]) => {
    const call = (...numbers: number[]) => {
      isInCallback = true;
      callback(...numbers);
      isInCallback = false;
    };
    return [name, call];
  });
  const imports = { darboux: Object.fromEntries(watched) };

  async function start(): Promise<void> {
    module = await compile(simd).catch(async () => compile((await scalar()).default));
    exports = seeded(await WebAssembly.instantiate(module, imports));
  }

  /** The error to throw for one that a call threw. */
  const worded = (error: unknown, { lacks_memory, memory }: E) => {
    if (!isTrap(error)) return error;
    if (lacks_memory() || memory.buffer.byteLength > LARGE_MEMORY) return new RangeError(tooLarge, { cause: error });
    return new Error(`darboux failed (${error.message}): this is a fault of darboux; please report it with the input`, { cause: error });
  };
  const instantiate = () => seeded<E>(new WebAssembly.Instance(module, imports));

  function shared(): E {
    if (!exports) throw new Error('darboux has not loaded yet; await ready before the first call');
    return exports;
  }

  /** Calls an instance. `lose` is told of errors that leave it in an unspecified state: traps, and errors of callbacks. */
  function callInstance<R>(exported: E, work: (exports: E) => R, lose: (error: unknown, isOfCallback: boolean) => void): R {
    if (running.has(exported)) throw new Error('a call is still running; make the next one after its end, not in its callback');
    const outer = isInCallback;
    isInCallback = false;
    running.add(exported);
    try {
      return work(exported);
    } catch (error) {
      const told = isInCallback ? error : worded(error, exported);
      if (isInCallback || isTrap(error)) lose(told, isInCallback);
      throw told;
    } finally {
      running.delete(exported);
      isInCallback = outer;
    }
  }

  function call<R>(work: (exports: E) => R): R {
    const exported = shared();
    let isLost = false;
    try {
      return callInstance(exported, work, () => {
        isLost = true;
      });
    } finally {
      if (isLost || exported.memory.buffer.byteLength > MAX_KEPT_MEMORY) exports = instantiate();
    }
  }

  function newInstance(): OwnInstance<E> {
    shared();
    const own = instantiate();
    let failure: unknown;
    const lose = (error: unknown, isOfCallback: boolean) => {
      failure = isOfCallback ? new Error('an error of a callback ended a call before; what it was called on can no longer be used', { cause: error }) : error;
    };
    const call: Call<E> = (work) => {
      if (failure) throw failure;
      return callInstance(own, work, lose);
    };
    return { call, isFull: () => failure !== undefined || own.memory.buffer.byteLength > MAX_KEPT_MEMORY };
  }

  const ready = start();
  // A program that never awaits `ready` gets no unhandled rejection; one that does gets the error.
  ready.catch(() => {});
  return { ready, call, newInstance };
}

const isTrap = (error: unknown): error is WebAssembly.RuntimeError => error instanceof WebAssembly.RuntimeError;
