// Attributes of three.js geometries as plain arrays of floats.

import type { BufferAttribute, InterleavedBufferAttribute } from 'three';

export type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** The elements of an attribute, dequantised and without interleaving. */
export function floatsOf(attribute: Attribute, width: number): Float32Array<ArrayBuffer> {
  const out = new Float32Array(attribute.count * width);
  for (let at = 0; at < attribute.count; at++) {
    for (let i = 0; i < width; i++) out[at * width + i] = attribute.getComponent(at, i);
  }
  return out;
}
