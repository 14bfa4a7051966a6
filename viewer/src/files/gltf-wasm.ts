// Reads and writes glTF with the same code as the command, compiled to WebAssembly (viewer/wasm). Runs in the worker.

import address from './darboux_viewer.wasm?url';

interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  /** Takes 64 random bits for hash keys, before any other call. */
  seed_random(low: number, high: number): void;
  name(length: number): number;
  file(length: number): number;
  made(): number;
  made_len(): number;
  text(): number;
  text_len(): number;
  check(): number;
  repair(): number;
  make_normals(): number;
}

/** A file that was made, and the JSON that describes it. */
export interface Outcome<T> {
  bytes: Uint8Array<ArrayBuffer>;
  description: T;
}

/** The part of a primitive's inspection that the page shows. */
export interface Primitive {
  mesh: number;
  primitive: number;
  ineligible: string | null;
}

/** The number of primitives with new tangents, with kept ones, and without; and warnings. */
export interface Summary {
  warnings: string[];
  totals: { written: number; kept: number; skipped: number };
}

let module: Promise<WebAssembly.Module> | undefined;

/** Decodes compressed data, and checks the data that tangents depend on. Errors: one sentence that names the place and the fault. */
export function check(name: string, bytes: Uint8Array): Promise<Outcome<Primitive[]>> {
  return run('check', name, bytes);
}

/** Writes MikkTSpace tangents to every eligible primitive and changes nothing else. Errors: those of {@link check}. */
export function repair(name: string, bytes: Uint8Array): Promise<Outcome<Summary>> {
  return run('repair', name, bytes);
}

/** Makes smooth normals where a primitive has none. Errors: those of {@link check}. */
export function makeNormals(name: string, bytes: Uint8Array): Promise<Outcome<unknown>> {
  return run('make_normals', name, bytes);
}

/** Runs a function in a new instance, because the memory of an instance never shrinks. */
async function run<T>(task: 'check' | 'repair' | 'make_normals', name: string, bytes: Uint8Array): Promise<Outcome<T>> {
  module ??= fetch(address).then(async (response) => WebAssembly.compile(await response.arrayBuffer()));
  const exports = (await WebAssembly.instantiate(await module)).exports as Exports;
  const [low, high] = crypto.getRandomValues(new Uint32Array(2));
  exports.seed_random(low, high);
  const write = (from: Uint8Array, address: number) => new Uint8Array(exports.memory.buffer, address >>> 0, from.length).set(from);
  const read = (address: number, length: number) => new Uint8Array(exports.memory.buffer, address >>> 0, length >>> 0).slice();
  try {
    const encodedName = new TextEncoder().encode(name);
    write(encodedName, exports.name(encodedName.length));
    write(bytes, exports.file(bytes.length));
    const isDone = exports[task]();
    const text = new TextDecoder().decode(read(exports.text(), exports.text_len()));
    if (!isDone) throw new Error(`${text}.`);
    return { bytes: read(exports.made(), exports.made_len()), description: JSON.parse(text) };
  } catch (error) {
    if (!(error instanceof WebAssembly.RuntimeError)) throw error;
    throw new Error(`${name} needs more memory than a page can use; use the command darboux.`, { cause: error });
  }
}
