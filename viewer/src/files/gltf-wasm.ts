// The command's own reading and writing of glTF, in WebAssembly. In the thread that computes.

import address from './darboux_viewer.wasm?url';

interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  name(length: number): number;
  file(length: number): number;
  made(): number;
  made_len(): number;
  text(): number;
  text_len(): number;
  check(): number;
  repair(): number;
}

/** A file that came out, and what there is to say about it. */
export interface Outcome<T> {
  bytes: Uint8Array<ArrayBuffer>;
  told: T;
}

/** What inspecting tells of a primitive, as far as the page shows it. */
export interface Primitive {
  mesh: number;
  primitive: number;
  ineligible: string | null;
}

/** What was done to the primitives of a file. */
export interface Summary {
  warnings: string[];
  totals: { written: number; kept: number; skipped: number };
}

let module: Promise<WebAssembly.Module> | undefined;

/** Reads all that tangents need, and decompresses it. Errors: a sentence that says where the file is wrong. */
export function check(name: string, bytes: Uint8Array): Promise<Outcome<Primitive[]>> {
  return run('check', name, bytes);
}

/** Writes MikkTSpace tangents for all primitives that can have them; all else stays as it is. Errors: as {@link check}. */
export function repair(name: string, bytes: Uint8Array): Promise<Outcome<Summary>> {
  return run('repair', name, bytes);
}

/** An instance is used once: its memory, which never shrinks, goes with it. */
async function run<T>(what: 'check' | 'repair', name: string, bytes: Uint8Array): Promise<Outcome<T>> {
  module ??= fetch(address).then(async (answer) => WebAssembly.compile(await answer.arrayBuffer()));
  const exports = (await WebAssembly.instantiate(await module)).exports as Exports;
  const put = (from: Uint8Array, place: number) => new Uint8Array(exports.memory.buffer, place >>> 0, from.length).set(from);
  const get = (place: number, length: number) => new Uint8Array(exports.memory.buffer, place >>> 0, length >>> 0).slice();
  try {
    const label = new TextEncoder().encode(name);
    put(label, exports.name(label.length));
    put(bytes, exports.file(bytes.length));
    const isDone = exports[what]();
    const text = new TextDecoder().decode(get(exports.text(), exports.text_len()));
    if (!isDone) throw new Error(`${text}.`);
    return { bytes: get(exports.made(), exports.made_len()), told: JSON.parse(text) };
  } catch (error) {
    if (!(error instanceof WebAssembly.RuntimeError)) throw error;
    throw new Error(`${name} needs more memory than a page can have; use the command darboux.`, { cause: error });
  }
}
