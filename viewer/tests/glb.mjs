// Reads and changes GLB files and PNG images of the sample model.

import { readFileSync } from 'node:fs';
import { deflateSync, inflateSync, crc32 } from 'node:zlib';

/** The sample model of the page. */
export const shield = () => readFileSync(new URL('../../assets/made/shield.glb', import.meta.url));

/** The JSON of a GLB and its binary chunk. */
export function parts(glb) {
  const end = 20 + glb.readUInt32LE(12);
  return { json: JSON.parse(glb.subarray(20, end).toString()), binary: glb.subarray(end + 8) };
}

/** The GLB of a document and its binary chunk. */
export function glb(json, binary) {
  const chunks = [[0x4e4f534a, padded(Buffer.from(JSON.stringify(json)), 0x20)], [0x004e4942, padded(binary, 0)]];
  const bodies = chunks.flatMap(([kind, content]) => [words(content.length, kind), content]);
  return Buffer.concat([words(0x46546c67, 2, 12 + bodies.reduce((sum, body) => sum + body.length, 0)), ...bodies]);
}

/** The sample model with another file in place of its normal map. */
export function withImage(bytes) {
  const { json, binary } = parts(shield());
  const view = json.bufferViews[json.images[0].bufferView];
  Object.assign(view, { byteOffset: binary.length, byteLength: bytes.length });
  json.buffers[0].byteLength = binary.length + bytes.length;
  return glb(json, Buffer.concat([binary, bytes]));
}

/** The normal map of the sample model with every texel changed. It has 3 channels of 8 bits, and no row is filtered. */
export function changedMap(change) {
  const { json, binary } = parts(shield());
  const { byteOffset, byteLength } = json.bufferViews[json.images[0].bufferView];
  const png = binary.subarray(byteOffset, byteOffset + byteLength);
  const chunks = [];
  for (let at = 8; at < png.length; at += 12 + png.readUInt32BE(at)) {
    chunks.push([png.toString('latin1', at + 4, at + 8), png.subarray(at + 8, at + 8 + png.readUInt32BE(at))]);
  }
  const width = chunks[0][1].readUInt32BE(0);
  const raw = inflateSync(Buffer.concat(chunks.filter(([kind]) => kind === 'IDAT').map(([, content]) => content)));
  for (let row = 0; row * (1 + 3 * width) < raw.length; row++) {
    for (let at = row * (1 + 3 * width) + 1; at < (row + 1) * (1 + 3 * width); at += 3) raw.set(change([...raw.subarray(at, at + 3)]), at);
  }
  const made = [['IHDR', chunks[0][1]], ['IDAT', deflateSync(raw)], ['IEND', Buffer.alloc(0)]];
  return Buffer.concat([png.subarray(0, 8), ...made.map(([kind, content]) => pngChunk(kind, content))]);
}

/** A chunk of a PNG. */
export function pngChunk(kind, content) {
  const body = Buffer.concat([Buffer.from(kind, 'latin1'), content]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(content.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, sum]);
}

/** Bytes up to a multiple of four. */
export function padded(part, by) {
  return Buffer.concat([part, Buffer.alloc(-part.length & 3, by)]);
}

function words(...values) {
  const out = Buffer.alloc(4 * values.length);
  values.forEach((value, at) => out.writeUInt32LE(value, 4 * at));
  return out;
}
