// Finds the images of a GLB that are normal maps.

import { contentOf, type GltfJson } from '../files/glb';

/** An image that materials use as their normal map. */
export interface StoredMap {
  /** Its index among the images. */
  image: number;
  name: string;
  /** The materials, by name or number. */
  materials: string[];
  /** The file; null where the model lacks it. */
  bytes: Uint8Array<ArrayBuffer> | null;
}

/** Extensions whose images take the place of a texture's own. */
const REPLACING = ['EXT_texture_webp', 'EXT_texture_avif', 'KHR_texture_basisu', 'MSFT_texture_dds'];

/** The normal maps, in the order of the materials that use them. `file`: a valid GLB. */
export async function normalMapsOf(file: Uint8Array<ArrayBuffer>): Promise<StoredMap[]> {
  const { json, binary } = contentOf(file);
  const found = new Map<number, StoredMap>();
  for (const [at, { name, normalTexture }] of (json.materials ?? []).entries()) {
    const image = normalTexture && imageOf(json, normalTexture.index);
    if (image === undefined || !json.images?.[image]) continue;
    const map = found.get(image) ?? { image, name: json.images[image].name ?? `image ${image}`, materials: [], bytes: await bytesOf(json, image, binary) };
    map.materials.push(name ?? `material ${at}`);
    found.set(image, map);
  }
  return [...found.values()];
}

function imageOf({ textures }: GltfJson, index: number): number | undefined {
  const texture = textures?.[index];
  const replaced = REPLACING.map((name) => texture?.extensions?.[name]?.source).find((source) => source !== undefined);
  return texture?.source ?? replaced;
}

async function bytesOf(json: GltfJson, image: number, binary: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer> | null> {
  const { uri, bufferView } = json.images![image];
  if (uri !== undefined) return uri.startsWith('data:') ? fetched(uri) : null;
  const view = json.bufferViews?.[bufferView ?? -1];
  if (!view) return null;
  const { uri: buffer } = json.buffers?.[view.buffer] ?? {};
  const bytes = buffer === undefined ? binary : await fetched(buffer);
  return bytes?.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength) ?? null;
}

/** The bytes of a data URI; null where it is damaged. */
async function fetched(uri: string): Promise<Uint8Array<ArrayBuffer> | null> {
  try {
    return new Uint8Array(await (await fetch(uri)).arrayBuffer());
  } catch {
    return null;
  }
}
