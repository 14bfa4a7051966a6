// The JSON of a GLB and its binary chunk: the only reader of files outside the WebAssembly modules. It reads a few names and counts of files that a module has
// checked and written. A module would copy the whole file into an instance of its own for them and parse it again, and the first picture would wait for that.

/** The members of a glTF that the page reads itself. */
export interface GltfJson {
  accessors?: { count: number }[];
  meshes?: { primitives?: { attributes?: { POSITION?: number } }[] }[];
  materials?: { name?: string; normalTexture?: { index: number } }[];
  textures?: { source?: number; extensions?: Record<string, { source?: number }> }[];
  images?: { name?: string; uri?: string; bufferView?: number }[];
  bufferViews?: { buffer: number; byteOffset?: number; byteLength: number }[];
  buffers?: { uri?: string }[];
}

/** The bytes of the header of a GLB and of the header of a chunk. */
const [HEADER, CHUNK_HEADER] = [12, 8];

/** The JSON of a valid GLB and its binary chunk, which is empty where the file has none. */
export function contentOf(glb: Uint8Array<ArrayBuffer>): { json: GltfJson; binary: Uint8Array<ArrayBuffer> } {
  const start = HEADER + CHUNK_HEADER;
  const end = start + new DataView(glb.buffer, glb.byteOffset).getUint32(HEADER, true);
  return { json: JSON.parse(new TextDecoder().decode(glb.subarray(start, end))), binary: glb.subarray(end + CHUNK_HEADER) };
}
