// Reads and writes glTF with the same code as the command, compiled to WebAssembly (viewer/wasm). Runs in the worker threads.

import address from './darboux_viewer.wasm?url';
import type { FileBundle } from './file-bundle';

interface Exports extends WebAssembly.Exports {
  memory: WebAssembly.Memory;
  /** Takes 64 random bits for hash keys, before any other call. */
  seed_random(low: number, high: number): void;
  needs_larger_module(): number;
  name(length: number): number;
  file(length: number): number;
  made(): number;
  made_len(): number;
  text(): number;
  text_len(): number;
}

/** Functions that take the given name and file. A build without the module that reads all formats has no decoder of textures. */
type Task = 'check' | 'repair' | 'make_normals' | 'decode_texture';

/** A file that was made, and the JSON that describes it. */
export interface Outcome<T> {
  bytes: Uint8Array<ArrayBuffer>;
  description: T;
}

/** What is known of a file that was opened. */
export interface Checked {
  primitives: Primitive[];
  /** What a model of another format than glTF lost, one sentence each. */
  warnings: string[];
  source: Source | null;
}

/** The words of a model of another format than glTF. */
export interface Source {
  /** What importers of the format make of mistakes: a sentence, or null. */
  importer_note: string | null;
  /** Where primitives are in the file, such as `Armature/Body in your FBX`. */
  places: { mesh: number; primitive: number; place: string }[];
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

/** The module that also reads other formats than glTF, and textures in KTX 2, at most one. A quick build has none: its one module reads them, or a sentence says what to do. */
const larger = Object.values(import.meta.glob<string>('./darboux_viewer_larger.wasm', { eager: true, query: '?url', import: 'default' }));

/** The modules that were loaded, by address. */
const modules = new Map<string, Promise<WebAssembly.Module>>();

/** The start of a file that is enough to recognise a glTF. */
const HEAD = 4096;

/** An instance with at least this memory that traps is taken for one that lacks memory; a trap of a smaller one is a fault of the module. */
const LARGE_MEMORY = 2 ** 29;

/**
 * Reads a glTF, or an OBJ, FBX, PLY or STL, which becomes one. Embeds the files of `bundle` that it refers to, decodes compressed data, and checks the data that tangents depend on. Errors: one sentence that
 * names the place and the fault.
 */
export function check(name: string, bytes: Uint8Array, bundle: FileBundle): Promise<Outcome<Checked>> {
  return run('check', name, bytes, bundle);
}

/** Writes MikkTSpace tangents to every eligible primitive and changes nothing else. Errors: those of {@link check}. */
export function repair(name: string, bytes: Uint8Array, bundle: FileBundle): Promise<Outcome<Summary>> {
  return run('repair', name, bytes, bundle);
}

/** Makes smooth normals where a primitive has none. Errors: those of {@link check}. */
export function makeNormals(name: string, bytes: Uint8Array): Promise<Outcome<unknown>> {
  return run('make_normals', name, bytes);
}

/** Decodes a texture in KTX 2 to its RGBA texels, row by row, and its width and height. Errors: one sentence. */
export function decodeTexture(bytes: Uint8Array): Promise<Outcome<[number, number]>> {
  return run('decode_texture', 'the texture', bytes);
}

/** Runs a function in a new instance, because the memory of an instance never shrinks. */
async function run<T>(task: Task, name: string, bytes: Uint8Array, bundle: FileBundle = new Map()): Promise<Outcome<T>> {
  const read = (address: number, length: number) => new Uint8Array(exports.memory.buffer, address >>> 0, length >>> 0).slice();
  const write = (from: Uint8Array, address: number) => new Uint8Array(exports.memory.buffer, address >>> 0, from.length).set(from);
  const decoded = (address: number, length: number) => new TextDecoder().decode(read(address, length));
  const page = {
    file_size: (name: number, length: number) => bundle.get(decoded(name, length))?.size ?? -1,
    read_file: (name: number, length: number, address: number) => {
      try {
        write(new Uint8Array(new FileReaderSync().readAsArrayBuffer(bundle.get(decoded(name, length))!)), address);
        return 1;
      } catch {
        return 0;
      }
    },
  };
  const instance = async (address: string) => {
    const { exports } = await WebAssembly.instantiate(await compiled(address), { page });
    const [low, high] = crypto.getRandomValues(new Uint32Array(2));
    (exports as Exports).seed_random(low, high);
    return exports as Exports;
  };
  // The larger module, where there is one, decodes textures.
  let exports = await instance(task === 'decode_texture' && larger.length ? larger[0] : address);
  const head = bytes.subarray(0, HEAD);
  write(head, exports.file(head.length));
  if (larger.length && exports.needs_larger_module()) exports = await instance(larger[0]);
  try {
    const encodedName = new TextEncoder().encode(name);
    write(encodedName, exports.name(encodedName.length));
    write(bytes, exports.file(bytes.length));
    const work = exports[task] as (() => number) | undefined;
    if (!work) throw new Error('this page was built without a decoder of KTX 2; build it with clang.');
    const isDone = work();
    const text = decoded(exports.text(), exports.text_len());
    if (!isDone) throw new Error(`${text}.`);
    return { bytes: read(exports.made(), exports.made_len()), description: JSON.parse(text) };
  } catch (error) {
    if (!(error instanceof WebAssembly.RuntimeError)) throw error;
    const sentence =
      exports.memory.buffer.byteLength >= LARGE_MEMORY
        ? 'needs more memory than a page can use; use the command darboux.'
        : `cannot be read (${error.message}): this is a fault of darboux; please report it with the file.`;
    throw new Error(`${name} ${sentence}`, { cause: error });
  }
}

/** Fetches and compiles a module once; again after a failure. */
function compiled(address: string): Promise<WebAssembly.Module> {
  const module = modules.get(address) ?? fetchModule(address);
  modules.set(address, module);
  module.catch(() => modules.delete(address));
  return module;
}

async function fetchModule(address: string): Promise<WebAssembly.Module> {
  const response = await fetch(address).catch(() => null);
  if (!response?.ok) throw new Error('The reader of this format cannot be loaded; check the connection and open the file again.');
  return WebAssembly.compile(await response.arrayBuffer());
}
