// Gives geometry of separate triangles an index, so that what is saved of it shares vertices.

import { BufferAttribute, type BufferGeometry } from 'three';

/** Merges vertices whose attributes are equal, and sets the index. Groups of corners stay as they are. */
export function index(geometry: BufferGeometry): void {
  if (geometry.index) return;
  const attributes = Object.entries(geometry.attributes as Record<string, BufferAttribute>);
  // 0 and -0 are equal.
  const words = attributes.map(([, { array, itemSize }]) => ({ bits: new Uint32Array((array as Float32Array).map((x) => x + 0).buffer), itemSize }));
  const { vertexOfCorner, firstCorners } = merge(words, geometry.getAttribute('position').count);
  for (const [name, attribute] of attributes) {
    const { itemSize } = attribute;
    const kept = new Float32Array(firstCorners.length * itemSize);
    firstCorners.forEach((corner, vertex) => kept.set(attribute.array.subarray(corner * itemSize, (corner + 1) * itemSize), vertex * itemSize));
    geometry.setAttribute(name, new BufferAttribute(kept, itemSize));
  }
  geometry.setIndex(new BufferAttribute(vertexOfCorner, 1));
}

interface Words {
  bits: Uint32Array;
  itemSize: number;
}

/** The vertex of each corner, numbered in the order of their first corners, and these corners. */
function merge(words: Words[], count: number): { vertexOfCorner: Uint32Array<ArrayBuffer>; firstCorners: number[] } {
  const table = new Int32Array(2 ** Math.ceil(Math.log2(2 * count + 2))).fill(-1);
  const vertexOfCorner = new Uint32Array(count);
  const firstCorners: number[] = [];
  for (let corner = 0; corner < count; corner++) {
    let slot = hash(words, corner) & (table.length - 1);
    while (table[slot] >= 0 && !isSame(words, firstCorners[table[slot]], corner)) slot = (slot + 1) & (table.length - 1);
    if (table[slot] < 0) table[slot] = firstCorners.push(corner) - 1;
    vertexOfCorner[corner] = table[slot];
  }
  return { vertexOfCorner, firstCorners };
}

function hash(words: Words[], corner: number): number {
  let sum = 0;
  for (const { bits, itemSize } of words) {
    for (let i = 0; i < itemSize; i++) sum = Math.imul(sum ^ bits[corner * itemSize + i], 0x9e3779b1) ^ (sum >>> 15);
  }
  return sum ^ (sum >>> 13);
}

function isSame(words: Words[], a: number, b: number): boolean {
  return words.every(({ bits, itemSize }) => {
    for (let i = 0; i < itemSize; i++) if (bits[a * itemSize + i] !== bits[b * itemSize + i]) return false;
    return true;
  });
}
