// Attributes of three.js geometries as plain arrays of floats.

import type { BufferAttribute, InterleavedBufferAttribute } from 'three';

export type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** The elements of an attribute, dequantised and without interleaving. Errors: three.js could not read the attribute. */
export function floatsOf(attribute: Attribute, width: number): Float32Array<ArrayBuffer> {
  if (!Number.isInteger(attribute.count)) {
    throw new Error('The model cannot be shown: three.js does not read sparse accessors over interleaved data; use the command darboux.');
  }
  const out = new Float32Array(attribute.count * width);
  for (let at = 0; at < attribute.count; at++) {
    for (let i = 0; i < width; i++) out[at * width + i] = attribute.getComponent(at, i);
  }
  return out;
}
