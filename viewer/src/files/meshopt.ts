// Decompresses meshopt buffers of glTF with three.js's decoder, because our WebAssembly has none. Runs in the worker.

import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

const NAMES = ['EXT_meshopt_compression', 'KHR_meshopt_compression'];

interface Compressed {
  buffer: number;
  byteOffset?: number;
  byteLength: number;
  byteStride: number;
  count: number;
  mode: string;
  filter?: string;
}

interface Extended {
  extensions?: Record<string, unknown>;
}

interface Json {
  buffers: (Extended & { byteLength: number; uri?: string })[];
  bufferViews: (Extended & { buffer: number; byteOffset?: number; byteLength: number })[];
  extensionsUsed?: string[];
  extensionsRequired?: string[];
}

/** Whether a glTF text names the extension. */
export function isMeshopt(text: string): boolean {
  return NAMES.some((name) => text.includes(`"${name}"`));
}

/**
 * Decodes the compressed buffer views into their fallback buffers and returns the new glTF text. `chunk` is the binary chunk of a GLB.
 * Errors: broken compressed data.
 */
export async function withoutMeshopt(name: string, json: Json, chunk: Uint8Array | null): Promise<string> {
  await MeshoptDecoder.ready;
  const sources = json.buffers.map((buffer, at) => (at === 0 && !buffer.uri ? chunk : bytesOf(buffer.uri)));
  const decoded = new Map<number, Uint8Array>();
  for (const [at, view] of json.bufferViews.entries()) {
    const compressed = removeExtension(view) as Compressed | undefined;
    if (!compressed || sources[view.buffer]) continue;
    try {
      const { buffer, byteOffset = 0, byteLength, count, byteStride, mode, filter = 'NONE' } = compressed;
      const source = sources[buffer]!.subarray(byteOffset, byteOffset + byteLength);
      const out = new Uint8Array(count * byteStride);
      MeshoptDecoder.decodeGltfBuffer(out, count, byteStride, source, mode, filter);
      if (!decoded.has(view.buffer)) decoded.set(view.buffer, new Uint8Array(json.buffers[view.buffer].byteLength));
      decoded.get(view.buffer)!.set(out, view.byteOffset ?? 0);
    } catch (error) {
      throw new Error(`${name}: bufferViews[${at}]: the compressed data is broken; compress the file again.`, { cause: error });
    }
  }
  for (const [at, buffer] of json.buffers.entries()) {
    removeExtension(buffer);
    const bytes = decoded.get(at);
    if (bytes) buffer.uri = `data:application/octet-stream;base64,${base64(bytes)}`;
  }
  for (const list of ['extensionsUsed', 'extensionsRequired'] as const) {
    const rest = json[list]?.filter((extension) => !NAMES.includes(extension));
    if (rest?.length) json[list] = rest;
    else delete json[list];
  }
  return JSON.stringify(json);
}

/** Removes the extension from an object and returns it. */
function removeExtension(object: Extended): unknown {
  const { extensions } = object;
  const name = extensions && NAMES.find((name) => name in extensions);
  if (!name) return undefined;
  const found = extensions[name];
  delete extensions[name];
  if (!Object.keys(extensions).length) delete object.extensions;
  return found;
}

function bytesOf(uri: string | undefined): Uint8Array | null {
  const data = uri?.split(';base64,')[1];
  return data === undefined ? null : Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
}

function base64(bytes: Uint8Array): string {
  let text = '';
  // Calls have a limited number of arguments.
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
}
