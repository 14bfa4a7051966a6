// Finds the images of a GLB that are normal maps.

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

interface Json {
  materials?: { name?: string; normalTexture?: { index: number } }[];
  textures?: { source?: number; extensions?: Record<string, { source?: number }> }[];
  images?: { name?: string; uri?: string; bufferView?: number }[];
  bufferViews?: { buffer: number; byteOffset?: number; byteLength: number }[];
  buffers?: { uri?: string }[];
}

/** The bytes of the header of a GLB and of the header of a chunk. */
const [HEADER, CHUNK_HEADER] = [12, 8];

/** Extensions whose images take the place of a texture's own. */
const REPLACING = ['EXT_texture_webp', 'EXT_texture_avif', 'KHR_texture_basisu'];

/** The normal maps, in the order of the materials that use them. `file`: a valid GLB. */
export async function normalMapsOf(file: Uint8Array<ArrayBuffer>): Promise<StoredMap[]> {
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const start = HEADER + CHUNK_HEADER;
  const end = start + view.getUint32(HEADER, true);
  const json: Json = JSON.parse(new TextDecoder().decode(file.subarray(start, end)));
  const chunk = file.subarray(Math.min(file.length, end + CHUNK_HEADER));
  const found = new Map<number, StoredMap>();
  for (const [at, { name, normalTexture }] of (json.materials ?? []).entries()) {
    const image = normalTexture && imageOf(json, normalTexture.index);
    if (image === undefined || !json.images?.[image]) continue;
    const map = found.get(image) ?? { image, name: json.images[image].name ?? `image ${image}`, materials: [], bytes: await bytesOf(json, image, chunk) };
    map.materials.push(name ?? `material ${at}`);
    found.set(image, map);
  }
  return [...found.values()];
}

function imageOf({ textures }: Json, index: number): number | undefined {
  const texture = textures?.[index];
  const replaced = REPLACING.map((name) => texture?.extensions?.[name]?.source).find((source) => source !== undefined);
  return texture?.source ?? replaced;
}

async function bytesOf(json: Json, image: number, chunk: Uint8Array<ArrayBuffer>): Promise<Uint8Array<ArrayBuffer> | null> {
  const { uri, bufferView } = json.images![image];
  if (uri !== undefined) return uri.startsWith('data:') ? fetched(uri) : null;
  const view = json.bufferViews?.[bufferView ?? -1];
  if (!view) return null;
  const { uri: buffer } = json.buffers?.[view.buffer] ?? {};
  const bytes = buffer === undefined ? chunk : await fetched(buffer);
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
