// Where the tangents of two sides differ most, and the outline of all such places.

import { FLIPPED, NO_ANGLE } from './angles';
import type { Comparison } from './comparison';

/** Angles in degrees from which a triangle belongs to a fault. Smaller ones are hardly seen. */
const SEEN = 4;

/** What opposite signs count as, in degrees. */
const FLIP_COUNTS = 180;

/** The cells along a side of the surface's box, in which differences are added up. */
const CELLS = 10;

/** Where two sides of a surface differ. */
export interface Fault {
  /** The middle of the place with the largest sum of angle times area, and the mean normal there. */
  position: [number, number, number];
  normal: [number, number, number];
  /** The distance of the place's triangles from its middle. */
  radius: number;
  /** The sum of angle times area, for comparison with other surfaces. */
  weight: number;
  /** The edges between triangles of the fault and others, 6 floats each. */
  outline: Float32Array<ArrayBuffer>;
  /** The triangles of the fault. */
  triangles: number;
}

/** How much two sides differ, over all vertices of surfaces. */
export interface Difference {
  /** In degrees; null where no angle is known. */
  median: number | null;
  worst: number | null;
  /** The vertices with opposite signs. */
  flipped: number;
}

/** The fault of a surface; null where both sides are alike or one has no tangents. */
export function faultOf({ positions, normals, indices, angles }: Comparison): Fault | null {
  if (!angles) return null;
  const severity = severities(indices, angles);
  const cell = cellsOf(positions);
  const sums = new Map<number, { weight: number; triangles: number[] }>();
  let total = 0;
  for (let triangle = 0; triangle < severity.length; triangle++) {
    if (severity[triangle] < SEEN) continue;
    const weight = severity[triangle] * areaOf(positions, indices, triangle);
    if (!(weight > 0)) continue;
    total += weight;
    const key = cell(positions, indices, triangle);
    const sum = sums.get(key) ?? { weight: 0, triangles: [] };
    sum.weight += weight;
    sum.triangles.push(triangle);
    sums.set(key, sum);
  }
  const worst = [...sums.values()].sort((a, b) => b.weight - a.weight)[0];
  if (!worst) return null;
  const at = worst.triangles.map((triangle) => centre(positions, indices, triangle));
  const mean = (points: number[][]) => [0, 1, 2].map((i) => points.reduce((sum, point) => sum + point[i], 0) / points.length) as Fault['position'];
  const position = mean(at);
  const normal = mean(worst.triangles.map((triangle) => centre(normals, indices, triangle)));
  const radius = Math.max(...at.map((point) => Math.hypot(...point.map((x, i) => x - position[i]))));
  const triangles = severity.reduce((count, degrees) => count + Number(degrees >= SEEN), 0);
  return { position, normal, radius, weight: total, outline: outlineOf(positions, indices, severity), triangles };
}

/** How much the sides of surfaces differ. */
export function differenceOf(comparisons: Comparison[]): Difference {
  const known: number[] = [];
  let flipped = 0;
  for (const { angles } of comparisons) {
    for (const angle of angles ?? []) {
      if (angle === FLIPPED) flipped++;
      else if (angle !== NO_ANGLE) known.push(angle);
    }
  }
  known.sort((a, b) => a - b);
  return { median: known[known.length >> 1] ?? null, worst: known.at(-1) ?? null, flipped };
}

/** The largest difference of each triangle in degrees. */
function severities(indices: Uint32Array, angles: Float32Array): Float32Array {
  return Float32Array.from({ length: indices.length / 3 }, (_, triangle) => {
    const worst = Math.max(...[0, 1, 2].map((i) => angles[indices[3 * triangle + i]]));
    return worst === FLIPPED ? FLIP_COUNTS : worst;
  });
}

/** A function that numbers the cell of a triangle's middle. */
function cellsOf(positions: Float32Array): (positions: Float32Array, indices: Uint32Array, triangle: number) => number {
  const [least, most] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let at = 0; at < positions.length; at++) {
    const [x, axis] = [positions[at], at % 3];
    if (!Number.isFinite(x)) continue;
    least[axis] = Math.min(least[axis], x);
    most[axis] = Math.max(most[axis], x);
  }
  const size = Math.max(...[0, 1, 2].map((axis) => most[axis] - least[axis])) || 1;
  return (positions, indices, triangle) => {
    const [x, y, z] = centre(positions, indices, triangle).map((x, axis) => Math.min(CELLS - 1, Math.floor(((x - least[axis]) / size) * CELLS)));
    return x + CELLS * (y + CELLS * z);
  };
}

/** The edges between triangles of the fault and others. Vertices with equal positions are one. */
function outlineOf(positions: Float32Array, indices: Uint32Array, severity: Float32Array): Float32Array<ArrayBuffer> {
  const bits = new Uint32Array(positions.buffer, positions.byteOffset, positions.length);
  const numbers = new Map<string, number>();
  const vertexOf = (vertex: number) => {
    const key = `${bits[3 * vertex]} ${bits[3 * vertex + 1]} ${bits[3 * vertex + 2]}`;
    const found = numbers.get(key);
    if (found !== undefined) return found;
    numbers.set(key, vertex);
    return vertex;
  };
  const edges = new Map<string, [number, number]>();
  for (let triangle = 0; triangle < severity.length; triangle++) {
    if (severity[triangle] < SEEN) continue;
    const corners = [0, 1, 2].map((i) => vertexOf(indices[3 * triangle + i]));
    for (const i of [0, 1, 2]) {
      const [a, b] = [corners[i], corners[(i + 1) % 3]];
      const key = a < b ? `${a} ${b}` : `${b} ${a}`;
      // An edge between two triangles of the fault is inside.
      if (!edges.delete(key)) edges.set(key, [a, b]);
    }
  }
  const ends = [...edges.values()].flat().flatMap((vertex) => [...positions.subarray(3 * vertex, 3 * vertex + 3)]);
  return Float32Array.from(ends);
}

function centre(array: Float32Array, indices: Uint32Array, triangle: number): number[] {
  return [0, 1, 2].map((axis) => [0, 1, 2].reduce((sum, i) => sum + array[3 * indices[3 * triangle + i] + axis] / 3, 0));
}

function areaOf(positions: Float32Array, indices: Uint32Array, triangle: number): number {
  const [a, b, c] = [0, 1, 2].map((i) => positions.subarray(3 * indices[3 * triangle + i], 3 * indices[3 * triangle + i] + 3));
  const [ux, uy, uz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
  const [vx, vy, vz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
  return Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx) / 2;
}
