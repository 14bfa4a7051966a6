// Mirrored edges: edges between two triangles whose tangents have different signs, where a texture meets its mirror image.

import type { Surface } from './surface';

/** The corners at which mirrored edges start. `tangents` has 4 floats per corner. */
export function mirroredEdges(tangents: Float32Array, pairs: Uint32Array): number[] {
  const out: number[] = [];
  for (let at = 0; at < pairs.length; at += 2) {
    if (tangents[pairs[at] * 4 + 3] * tangents[pairs[at + 1] * 4 + 3] < 0) out.push(pairs[at]);
  }
  return out;
}

/** The end points of the edges that start at some corners, 6 floats per edge. */
export function endsAt({ indices, positions }: Surface, corners: number[]): Float32Array<ArrayBuffer> {
  const out = new Float32Array(corners.length * 6);
  const position = (corner: number) => positions.subarray(indices[corner] * 3, indices[corner] * 3 + 3);
  corners.forEach((corner, at) => {
    out.set(position(corner), at * 6);
    out.set(position(nextCorner(corner)), at * 6 + 3);
  });
  return out;
}

const cache = new WeakMap<Surface, Uint32Array>();

/** The cached {@link edgePairs} of a surface. */
export function edgePairsOf(surface: Surface): Uint32Array {
  const pairs = cache.get(surface) ?? edgePairs(surface);
  cache.set(surface, pairs);
  return pairs;
}

/**
 * The edges between two triangles, as pairs of corners at which the edge starts in each triangle. Vertices with equal positions are one
 * vertex. Where an edge has more than two triangles, each is paired with the first.
 */
function edgePairs({ indices, positions }: Surface): Uint32Array<ArrayBuffer> {
  const welded = weldPositions(positions);
  const table = new Int32Array(tableSize(indices.length)).fill(-1);
  const out: number[] = [];
  for (let corner = 0; corner < indices.length; corner++) {
    const [a, b] = endsOf(welded, indices, corner);
    if (a === b) continue;
    let slot = hash(a, b, 0) & (table.length - 1);
    for (; table[slot] >= 0; slot = (slot + 1) & (table.length - 1)) {
      const [c, d] = endsOf(welded, indices, table[slot]);
      if (a === c && b === d) break;
    }
    if (table[slot] < 0) table[slot] = corner;
    else out.push(table[slot], corner);
  }
  return Uint32Array.from(out);
}

/** The welded vertices of the edge that starts at a corner, the lower number first. */
function endsOf(welded: Uint32Array, indices: Uint32Array, corner: number): [number, number] {
  const [a, b] = [welded[indices[corner]], welded[indices[nextCorner(corner)]]];
  return a < b ? [a, b] : [b, a];
}

/** The next corner of the same triangle. */
function nextCorner(corner: number): number {
  return corner % 3 === 2 ? corner - 2 : corner + 1;
}

/** For each vertex, the first vertex with the same position. */
function weldPositions(positions: Float32Array): Uint32Array<ArrayBuffer> {
  const count = positions.length / 3;
  const table = new Int32Array(tableSize(count)).fill(-1);
  // 0 and -0 are equal.
  const bits = new Uint32Array(positions.map((x) => x + 0).buffer);
  const welded = new Uint32Array(count);
  for (let vertex = 0; vertex < count; vertex++) {
    const [x, y, z] = [bits[vertex * 3], bits[vertex * 3 + 1], bits[vertex * 3 + 2]];
    let slot = hash(x, y, z) & (table.length - 1);
    for (let at = table[slot]; at >= 0; at = table[slot]) {
      if (bits[at * 3] === x && bits[at * 3 + 1] === y && bits[at * 3 + 2] === z) break;
      slot = (slot + 1) & (table.length - 1);
    }
    if (table[slot] < 0) table[slot] = vertex;
    welded[vertex] = table[slot];
  }
  return welded;
}

/** The size of a hash table for some entries: a power of two, at most half full. */
function tableSize(count: number): number {
  return 2 ** Math.ceil(Math.log2(Math.max(2 * count, 2)));
}

function hash(x: number, y: number, z: number): number {
  const mixed = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca6b) ^ Math.imul(z, 0xc2b2ae35);
  return Math.imul(mixed ^ (mixed >>> 15), 0x2c1b3c6d) ^ (mixed >>> 12);
}
