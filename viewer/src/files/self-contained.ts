// Makes a glTF self-contained: embeds the files that it refers to and checks it, which decodes it. Runs in the worker.

import { resolvePath, type FileBundle } from './file-bundle';
import { check, type Outcome, type Primitive } from './gltf-wasm';

/** "glTF". */
const MAGIC = 0x46546c67;
const JSON_CHUNK = 0x4e4f534a;
/** The bytes of the header of a GLB and of the header of its first chunk. */
const HEADER_BYTES = 20;

/** The JSON text of a glTF, and the chunks that follow it in a GLB. */
interface Container {
  text: string;
  chunks: Uint8Array<ArrayBuffer> | null;
}

/** Embeds and checks. Errors: one sentence that names the place and the fault. */
export async function makeSelfContained(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: FileBundle): Promise<Outcome<Primitive[]>> {
  const container = parseContainer(bytes);
  // The check has a better sentence for a file that is not glTF.
  const json = container && parseJson(container.text);
  if (!json) return check(name, bytes);
  const text = await embedFiles(name, container.text, json, bundle);
  return check(name, text === container.text ? bytes : writeContainer({ ...container, text }));
}

function parseContainer(bytes: Uint8Array<ArrayBuffer>): Container | null {
  const view = new DataView(bytes.buffer);
  if (bytes.length < HEADER_BYTES || view.getUint32(0, true) !== MAGIC) return { text: new TextDecoder().decode(bytes), chunks: null };
  const [length, type] = [view.getUint32(12, true), view.getUint32(16, true)];
  if (type !== JSON_CHUNK || length > bytes.length - HEADER_BYTES) return null;
  return { text: new TextDecoder().decode(bytes.subarray(HEADER_BYTES, HEADER_BYTES + length)), chunks: bytes.subarray(HEADER_BYTES + length) };
}

function writeContainer({ text, chunks }: Container): Uint8Array<ArrayBuffer> {
  const json = new TextEncoder().encode(text);
  if (!chunks) return json;
  const padded = Math.ceil(json.length / 4) * 4;
  const out = new Uint8Array(HEADER_BYTES + padded + chunks.length).fill(0x20);
  const view = new DataView(out.buffer);
  [MAGIC, 2, out.length, padded, JSON_CHUNK].forEach((value, at) => view.setUint32(at * 4, value, true));
  out.set(json, HEADER_BYTES);
  out.set(chunks, HEADER_BYTES + padded);
  return out;
}

interface References {
  buffers?: { uri?: unknown }[];
  images?: { uri?: unknown }[];
}

function parseJson(text: string): References | null {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

/** Replaces references by the contents of the files and leaves the rest of the text as it is. Errors: a buffer is missing. */
async function embedFiles(name: string, text: string, json: References, bundle: FileBundle): Promise<string> {
  const data = new Map<string, string>();
  for (const uri of urisOf(json.buffers)) {
    const file = fileOf(uri, name, bundle);
    if (file) data.set(uri, await dataUri(file));
    else if (resolvePath(uri, name) === null) throw new Error(`${name} refers to ${uri}, and nothing is fetched; put that file into the model's folder.`);
    else throw new Error(`${name} refers to ${resolvePath(uri, name)}, which is not among the files; drop the whole folder.`);
  }
  for (const uri of urisOf(json.images)) {
    const file = fileOf(uri, name, bundle);
    if (file) data.set(uri, await dataUri(file));
  }
  if (!data.size) return text;
  return text.replaceAll(/"uri"(\s*:\s*)("(?:[^"\\]|\\.)*")/g, (all, between, literal) => {
    const found = data.get(JSON.parse(literal));
    return found ? `"uri"${between}"${found}"` : all;
  });
}

/** The URIs of a list, without data URIs. */
function urisOf(list: References['images']): string[] {
  const all = Array.isArray(list) ? list.map((entry) => entry?.uri) : [];
  return all.filter((uri): uri is string => typeof uri === 'string' && !uri.startsWith('data:'));
}

function fileOf(uri: string, name: string, bundle: FileBundle): Blob | undefined {
  return bundle.get(resolvePath(uri, name) ?? '');
}

/** A file as a data URI. Images keep their media type. */
function dataUri(file: Blob): Promise<string> {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve((reader.result as string).replace(/^data:(?!image\/)[^;,]*/, 'data:application/octet-stream'));
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(file);
  });
}
