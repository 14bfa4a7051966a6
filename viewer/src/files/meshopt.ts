// Files that are compressed with meshoptimizer, whose decoder the page has and our WebAssembly has not.

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

/** Whether a text names the compression. */
export function isMeshopt(text: string): boolean {
  return NAMES.some((name) => text.includes(`"${name}"`));
}

/**
 * The text of a file whose compressed views are decoded into the buffers that they would lie in. `chunk` is the GLB's own buffer.
 * Errors: a stream that is broken.
 */
export async function withoutMeshopt(name: string, json: Json, chunk: Uint8Array | null): Promise<string> {
  await MeshoptDecoder.ready;
  const read = json.buffers.map((buffer, at) => (at === 0 && !buffer.uri ? chunk : bytesOf(buffer.uri)));
  const decoded = new Map<number, Uint8Array>();
  for (const [at, view] of json.bufferViews.entries()) {
    const compressed = taken(view) as Compressed | undefined;
    if (!compressed || read[view.buffer]) continue;
    try {
      const { buffer, byteOffset = 0, byteLength, count, byteStride, mode, filter = 'NONE' } = compressed;
      const source = read[buffer]!.subarray(byteOffset, byteOffset + byteLength);
      const out = new Uint8Array(count * byteStride);
      MeshoptDecoder.decodeGltfBuffer(out, count, byteStride, source, mode, filter);
      if (!decoded.has(view.buffer)) decoded.set(view.buffer, new Uint8Array(json.buffers[view.buffer].byteLength));
      decoded.get(view.buffer)!.set(out, view.byteOffset ?? 0);
    } catch (error) {
      throw new Error(`${name}: bufferViews[${at}]: the compressed data is broken; compress the file again.`, { cause: error });
    }
  }
  for (const [at, buffer] of json.buffers.entries()) {
    taken(buffer);
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

/** Takes the extension out of an object. */
function taken(object: Extended): unknown {
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
  // The most arguments that a call can safely have.
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
}
