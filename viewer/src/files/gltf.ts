// glTF and GLB: one file that refers to no other, for three.js and for the export alike.

import type { Object3D } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';

import { located, type Bundle } from './bundle';

const MAGIC = 0x46546c67; // "glTF"
const JSON_CHUNK = 0x4e4f534a;

/** A container's text, and what follows its chunk in a GLB. */
interface Container {
  text: string;
  rest: Uint8Array<ArrayBuffer> | null;
}

/** Opens a .gltf or .glb. Errors: a sentence for people. */
export async function openGltf(
  name: string,
  bytes: Uint8Array<ArrayBuffer>,
  bundle: Bundle,
): Promise<{ scene: Object3D; bytes: Uint8Array<ArrayBuffer> }> {
  const whole = await selfContained(name, bytes, bundle);
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder);
  try {
    const { scene } = await loader.parseAsync(whole.buffer, '');
    return { scene, bytes: whole };
  } catch (error) {
    throw new Error(`${name} cannot be shown: ${error instanceof Error ? error.message : error}.`);
  }
}

/** The file with the files that it refers to embedded as data: URIs; all other text stays as it is spelled. */
async function selfContained(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Uint8Array<ArrayBuffer>> {
  const { text, rest } = container(name, bytes);
  const embedded = new Map<string, string>();
  for (const uri of urisOf(name, text)) {
    if (uri.startsWith('data:')) continue;
    const path = located(uri, name);
    if (path === null) throw new Error(`${name} refers to ${uri}, which is elsewhere; nothing is fetched, so put it into the file's folder.`);
    const file = bundle.get(path);
    if (!file) throw new Error(`${name} refers to ${path}, which was not given; drop the whole folder.`);
    embedded.set(uri, await dataUri(file));
  }
  if (!embedded.size) return bytes;
  const changed = text.replaceAll(/"uri"(\s*:\s*)("(?:[^"\\]|\\.)*")/g, (all, between, literal) => {
    const data = embedded.get(JSON.parse(literal));
    return data ? `"uri"${between}"${data}"` : all;
  });
  return joined({ text: changed, rest });
}

function container(name: string, bytes: Uint8Array<ArrayBuffer>): Container {
  const view = new DataView(bytes.buffer);
  const decode = (part: Uint8Array<ArrayBuffer>): string => {
    try {
      return new TextDecoder('utf-8', { fatal: true }).decode(part);
    } catch {
      throw new Error(`${name} is not a glTF file: neither GLB nor JSON; export it again.`);
    }
  };
  if (bytes.length < 4 || view.getUint32(0, true) !== MAGIC) return { text: decode(bytes), rest: null };
  if (bytes.length < 20) throw new Error(`${name} ends within its header; export it again.`);
  const [length, kind] = [view.getUint32(12, true), view.getUint32(16, true)];
  if (kind !== JSON_CHUNK || length > bytes.length - 20) throw new Error(`${name} is cut short, or its first chunk is not JSON; export it again.`);
  return { text: decode(bytes.subarray(20, 20 + length)), rest: bytes.subarray(20 + length) };
}

function joined({ text, rest }: Container): Uint8Array<ArrayBuffer> {
  const json = new TextEncoder().encode(text);
  if (!rest) return json;
  const padded = Math.ceil(json.length / 4) * 4;
  const out = new Uint8Array(20 + padded + rest.length).fill(0x20);
  const view = new DataView(out.buffer);
  [MAGIC, 2, out.length, padded, JSON_CHUNK].forEach((value, at) => view.setUint32(at * 4, value, true));
  out.set(json, 20);
  out.set(rest, 20 + padded);
  return out;
}

/** The URIs of buffers and images. */
function urisOf(name: string, text: string): string[] {
  let json: { buffers?: { uri?: unknown }[]; images?: { uri?: unknown }[] };
  try {
    json = JSON.parse(text);
  } catch (error) {
    throw new Error(`${name} is not JSON: ${(error as Error).message}; export it again.`);
  }
  const all = [json.buffers, json.images].flatMap((list) => (Array.isArray(list) ? list : []));
  return all.map((entry) => entry?.uri).filter((uri): uri is string => typeof uri === 'string');
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
