// Opens the model in a bundle of files.

import type { Object3D } from 'three';

import type { Bundle } from './file-bundle';
import { openGltf } from './gltf';
import { openObj } from './obj';

/** A model as three.js has it. */
export interface Model {
  /** The path of its file. */
  name: string;
  scene: Object3D;
  kind: 'gltf' | 'obj';
  /** The file with all that it refers to, as a GLB: what an export begins with. Null for other formats. */
  bytes: Uint8Array<ArrayBuffer> | null;
  /** What is odd but not an error, as sentences. */
  warnings: string[];
}

/** How far it is: what is being done, and how much of that is, from 0 to 1, or null. */
export type Progress = (what: string, done: number | null) => void;

/** The largest file that is read: the page holds it several times over. */
const MOST_BYTES = 1.5e9;

const MODEL = /\.(glb|gltf|vrm|obj)$/i;

/** Opens the first model of a bundle, those nearest to its top first. Errors: a sentence for people. */
export async function openModel(bundle: Bundle, progress: Progress): Promise<Model> {
  const depth = (path: string) => path.split('/').length;
  const [name] = [...bundle.keys()].filter((path) => MODEL.test(path)).sort((a, b) => depth(a) - depth(b) || a.localeCompare(b));
  if (!name) {
    const given = [...bundle.keys()].slice(0, 3).join(', ') || 'nothing';
    throw new Error(`There is no model in what was given (${given}); give a .glb, an .obj, or a folder with a .gltf.`);
  }
  const bytes = await read(name, bundle.get(name)!, progress);
  progress(`Opening ${name}`, null);
  const isObj = /\.obj$/i.test(name);
  return isObj
    ? { name, kind: 'obj', bytes: null, ...(await openObj(name, bytes, bundle)) }
    : { name, kind: 'gltf', ...(await openGltf(name, bytes, bundle)) };
}

async function read(name: string, file: Blob, progress: Progress): Promise<Uint8Array<ArrayBuffer>> {
  if (!file.size) throw new Error(`${name} is empty; export it again.`);
  if (file.size > MOST_BYTES) {
    const size = (file.size / 1e9).toFixed(1);
    throw new Error(`${name} has ${size} GB, more than a page can hold; use the command: darboux tangents, darboux inspect.`);
  }
  const bytes = new Uint8Array(file.size);
  let at = 0;
  const reader = file.stream().getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    bytes.set(part.value, at);
    at += part.value.length;
    progress(`Reading ${name}`, at / file.size);
  }
  return bytes;
}
