// Edges across which the sign of the tangents changes: where a texture meets its mirror image.

import type { Surface } from './surface';

/** The corners that mirrored seams begin at. `tangents`: 4 floats per corner. */
export function seamCorners(tangents: Float32Array, pairs: Uint32Array): number[] {
  const out: number[] = [];
  for (let at = 0; at < pairs.length; at += 2) {
    if (tangents[pairs[at] * 4 + 3] * tangents[pairs[at + 1] * 4 + 3] < 0) out.push(pairs[at]);
  }
  return out;
}

/** The ends of the edges that begin at some corners, 6 floats each. */
export function endsAt({ indices, positions }: Surface, corners: number[]): Float32Array<ArrayBuffer> {
  const out = new Float32Array(corners.length * 6);
  const position = (corner: number) => positions.subarray(indices[corner] * 3, indices[corner] * 3 + 3);
  corners.forEach((corner, at) => {
    out.set(position(corner), at * 6);
    out.set(position(following(corner)), at * 6 + 3);
  });
  return out;
}

const known = new WeakMap<Surface, Uint32Array>();

/** As {@link edgePairs}, which is found once. */
export function edgePairsOf(surface: Surface): Uint32Array {
  const pairs = known.get(surface) ?? edgePairs(surface);
  known.set(surface, pairs);
  return pairs;
}

/**
 * The edges of two triangles, as pairs of the corners that they begin at. Edges are between positions, whatever the vertices; of more
 * than two triangles at one edge each is paired with the first.
 */
function edgePairs({ indices, positions }: Surface): Uint32Array<ArrayBuffer> {
  const places = placesOf(positions);
  const table = new Int32Array(tableSize(indices.length)).fill(-1);
  const out: number[] = [];
  for (let corner = 0; corner < indices.length; corner++) {
    const [a, b] = endsOf(places, indices, corner);
    if (a === b) continue;
    let slot = hash(a, b, 0) & (table.length - 1);
    for (; table[slot] >= 0; slot = (slot + 1) & (table.length - 1)) {
      const [c, d] = endsOf(places, indices, table[slot]);
      if (a === c && b === d) break;
    }
    if (table[slot] < 0) table[slot] = corner;
    else out.push(table[slot], corner);
  }
  return Uint32Array.from(out);
}

/** The positions between which the edge from a corner on lies, the lower first. */
function endsOf(places: Uint32Array, indices: Uint32Array, corner: number): [number, number] {
  const [a, b] = [places[indices[corner]], places[indices[following(corner)]]];
  return a < b ? [a, b] : [b, a];
}

/** The next corner of the same triangle. */
function following(corner: number): number {
  return corner % 3 === 2 ? corner - 2 : corner + 1;
}

/** For each vertex the first that lies at its position. */
function placesOf(positions: Float32Array): Uint32Array<ArrayBuffer> {
  const count = positions.length / 3;
  const table = new Int32Array(tableSize(count)).fill(-1);
  // Zeros of both signs are one position.
  const bits = new Uint32Array(positions.map((x) => x + 0).buffer);
  const places = new Uint32Array(count);
  for (let vertex = 0; vertex < count; vertex++) {
    const [x, y, z] = [bits[vertex * 3], bits[vertex * 3 + 1], bits[vertex * 3 + 2]];
    let slot = hash(x, y, z) & (table.length - 1);
    for (let at = table[slot]; at >= 0; at = table[slot]) {
      if (bits[at * 3] === x && bits[at * 3 + 1] === y && bits[at * 3 + 2] === z) break;
      slot = (slot + 1) & (table.length - 1);
    }
    if (table[slot] < 0) table[slot] = vertex;
    places[vertex] = table[slot];
  }
  return places;
}

/** A power of two that leaves half of a table free. */
function tableSize(count: number): number {
  return 2 ** Math.ceil(Math.log2(Math.max(2 * count, 2)));
}

function hash(x: number, y: number, z: number): number {
  const mixed = Math.imul(x, 0x9e3779b1) ^ Math.imul(y, 0x85ebca6b) ^ Math.imul(z, 0xc2b2ae35);
  return Math.imul(mixed ^ (mixed >>> 15), 0x2c1b3c6d) ^ (mixed >>> 12);
}
