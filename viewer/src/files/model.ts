// Opens the model in a set of files: glTF, GLB, VRM, OBJ, PLY, STL or FBX.

import type { AnimationClip, Camera, Object3D } from 'three';

import { MODEL_NAMES, type FileBundle } from './file-bundle';
import { openGltf } from './gltf';
import type { Ktx2Textures } from './ktx2';
import { call } from '../worker/surfaces';
import type { Outcome, Source, Summary } from './gltf-wasm';

/** An opened model. */
export interface Model {
  /** The path of the model's file. */
  name: string;
  /** The model's file and those beside it. */
  files: FileBundle;
  scene: Object3D;
  animations: AnimationClip[];
  cameras: Camera[];
  /** The model as a self-contained GLB. */
  bytes: Uint8Array<ArrayBuffer>;
  /** Faults that are not errors, one sentence each. */
  warnings: string[];
  /** The words of the file; null for glTF. */
  source: Source | null;
  /** The decoded textures in KTX 2 of this model and of what is made of it. */
  textures: Ktx2Textures;
}

/** Receives the current task and its progress from 0 to 1, or null where that is unknown. */
export type Progress = (task: string, fraction: number | null) => void;

/** The largest file that is read. The page holds several copies. */
const MAX_BYTES = 1.5e9;

/** Opens the model of the preferred format, of several the one with the fewest folders in its path, and of these the first by name. Errors: one sentence to show. */
export async function openModel(bundle: FileBundle, textures: Ktx2Textures, progress: Progress): Promise<Model> {
  const depth = (path: string) => path.split('/').length;
  const first = (names: RegExp) =>
    [...bundle.keys()].filter((path) => names.test(path)).sort((a, b) => depth(a) - depth(b) || a.localeCompare(b))[0];
  const name = MODEL_NAMES.map(first).find((name) => name !== undefined);
  if (!name) {
    const given = [...bundle.keys()].slice(0, 3).join(', ') || 'none';
    throw new Error(`There is no model in these files (${given}); open a .glb, .obj, .fbx, .ply or .stl, or a folder with a .gltf.`);
  }
  const bytes = await read(name, bundle.get(name)!, progress);
  progress(`Opening ${name}`, null);
  return { name, files: bundle, textures, ...(await openGltf(name, bytes, bundle, textures)) };
}

/** Writes MikkTSpace's tangents into the model and changes nothing else. A model of another format is read again, because its GLB has no quads. */
export async function withTangents({ name, source, bytes, files }: Model): Promise<Outcome<Summary>> {
  if (!source) return call('repair', name, bytes, new Map());
  return call('repair', name, new Uint8Array(await files.get(name)!.arrayBuffer()), files);
}

async function read(name: string, file: Blob, progress: Progress): Promise<Uint8Array<ArrayBuffer>> {
  if (!file.size) throw new Error(`${name} is empty; export it again.`);
  if (file.size > MAX_BYTES) {
    const size = (file.size / 1e9).toFixed(1);
    throw new Error(`${name} has ${size} GB, more than a page can hold; use the command (darboux tangents, darboux inspect).`);
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
