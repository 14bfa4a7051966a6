// One file that refers to no other, checked: for three.js and for the export alike. In the thread that computes.

import { located, type Bundle } from './file-bundle';
import { check, type Outcome, type Primitive } from './gltf-wasm';
import { isMeshopt, withoutMeshopt } from './meshopt';

const MAGIC = 0x46546c67; // "glTF"
const JSON_CHUNK = 0x4e4f534a;
/** The header of a GLB and that of its first chunk. */
const HEAD = 20;

/** The text of a glTF file, and what follows its chunk where that is a GLB. */
interface Container {
  text: string;
  rest: Uint8Array<ArrayBuffer> | null;
}

/** The file with all that it refers to embedded, decompressed and checked. Errors: a sentence that says what is wrong with it. */
export async function wholeGltf(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Outcome<Primitive[]>> {
  const container = contained(bytes);
  // What is no glTF at all the check says better.
  const json = container && parsed(container.text);
  if (!json) return check(name, bytes);
  let text = await embedded(name, container.text, json, bundle);
  if (isMeshopt(text)) text = await withoutMeshopt(name, JSON.parse(text), container.rest?.subarray(8) ?? null);
  return check(name, text === container.text ? bytes : joined({ ...container, text }));
}

function contained(bytes: Uint8Array<ArrayBuffer>): Container | null {
  const view = new DataView(bytes.buffer);
  if (bytes.length < HEAD || view.getUint32(0, true) !== MAGIC) return { text: new TextDecoder().decode(bytes), rest: null };
  const [length, kind] = [view.getUint32(12, true), view.getUint32(16, true)];
  if (kind !== JSON_CHUNK || length > bytes.length - HEAD) return null;
  return { text: new TextDecoder().decode(bytes.subarray(HEAD, HEAD + length)), rest: bytes.subarray(HEAD + length) };
}

function joined({ text, rest }: Container): Uint8Array<ArrayBuffer> {
  const json = new TextEncoder().encode(text);
  if (!rest) return json;
  const padded = Math.ceil(json.length / 4) * 4;
  const out = new Uint8Array(HEAD + padded + rest.length).fill(0x20);
  const view = new DataView(out.buffer);
  [MAGIC, 2, out.length, padded, JSON_CHUNK].forEach((value, at) => view.setUint32(at * 4, value, true));
  out.set(json, HEAD);
  out.set(rest, HEAD + padded);
  return out;
}

interface References {
  buffers?: { uri?: unknown }[];
  images?: { uri?: unknown }[];
}

function parsed(text: string): References | null {
  try {
    return JSON.parse(text);
  } catch {
    return null;
  }
}

/** The text with files of the bundle in place of references to them; all else stays as it is spelled. Errors: a buffer is missing. */
async function embedded(name: string, text: string, json: References, bundle: Bundle): Promise<string> {
  const data = new Map<string, string>();
  for (const uri of urisOf(json.buffers)) {
    const file = fileOf(uri, name, bundle);
    if (file) data.set(uri, await dataUri(file));
    else if (located(uri, name) === null) throw new Error(`${name} refers to ${uri}, which is elsewhere; nothing is fetched, so put it into the file's folder.`);
    else throw new Error(`${name} refers to ${located(uri, name)}, which was not given; drop the whole folder.`);
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

/** References to what is outside the file. */
function urisOf(list: References['images']): string[] {
  const all = Array.isArray(list) ? list.map((entry) => entry?.uri) : [];
  return all.filter((uri): uri is string => typeof uri === 'string' && !uri.startsWith('data:'));
}

function fileOf(uri: string, name: string, bundle: Bundle): Blob | undefined {
  return bundle.get(located(uri, name) ?? '');
}

/** Images keep their media type. */
function dataUri(file: Blob): Promise<string> {
  return new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve((reader.result as string).replace(/^data:(?!image\/)[^;,]*/, 'data:application/octet-stream'));
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(file);
  });
}
