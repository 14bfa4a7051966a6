// The shadow on the ground where a model is close to it, as `darboux render` computes it: crates/darboux-render/src/ground.rs explains the formula.

import type { Matrix4 } from 'three';

import description from '../../../crates/darboux-render/src/studio.json';

const LOOK = description.ground;

/** The triangles of a part of a model, at all its places. */
export interface PlacedTriangles {
  positions: Float32Array;
  indices: ArrayLike<number>;
  places: Matrix4[];
}

/** The darkness of a square on the ground. */
export interface GroundShadow {
  /** The middle of the square: x, height, z. */
  middle: [number, number, number];
  halfSide: number;
  /** The side of the square in texels. */
  side: number;
  /** The part of the light that is missing at each texel, of 255; rows along x. */
  texels: Uint8Array<ArrayBuffer>;
}

/** Why there is no shadow: the parts have no extent, or they need too many samples. */
export type NoShadow = 'no extent' | 'too many samples';

/** A point in the square: x in texels, the height as a fraction of half the diagonal of the model's box, and z in texels. */
type Point = readonly [number, number, number];

/** The shadow below the parts, or why there is none. */
export function groundShadow(parts: PlacedTriangles[]): GroundShadow | NoShadow {
  const triangles = parts.reduce((sum, { indices, places }) => sum + (indices.length / 3) * places.length, 0);
  if (triangles > LOOK.most_steps) return 'too many samples';
  const [min, max] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  visitTriangles(parts, (triangle) => {
    for (let at = 0; at < 9; at++) {
      min[at % 3] = Math.min(min[at % 3], triangle[at]);
      max[at % 3] = Math.max(max[at % 3], triangle[at]);
    }
  });
  const half = min.map((least, i) => 0.5 * (max[i] - least));
  const radius = Math.sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  if (!(radius > 0) || !Number.isFinite(radius)) return 'no extent';
  const [x, height, z] = [0.5 * (min[0] + max[0]), min[1], 0.5 * (min[2] + max[2])];
  const halfSide = Math.max(half[0], half[2]) + LOOK.margin * radius;
  const texelsPerUnit = LOOK.texels / (2 * halfSide);
  const heights = new Heights();
  visitTriangles(parts, (triangle) => {
    for (let at = 0; at < 9; at += 3) {
      triangle[at] = (triangle[at] - x + halfSide) * texelsPerUnit;
      triangle[at + 1] = (triangle[at + 1] - height) / radius;
      triangle[at + 2] = (triangle[at + 2] - z + halfSide) * texelsPerUnit;
    }
    heights.add(triangle);
  });
  const texels = heights.darkness(radius * texelsPerUnit);
  return texels ? { middle: [x, height, z], halfSide, side: LOOK.texels, texels } : 'too many samples';
}

/** Visits the triangles of all places in the scene, except those that are not finite there. The array is valid during the call. */
function visitTriangles(parts: PlacedTriangles[], visit: (triangle: Float64Array) => void): void {
  const triangle = new Float64Array(9);
  for (const { positions, indices, places } of parts) {
    for (const { elements: m } of places) {
      for (let first = 0; first + 2 < indices.length; first += 3) {
        let sum = 0;
        for (let corner = 0; corner < 3; corner++) {
          const at = 3 * indices[first + corner];
          const [x, y, z] = [positions[at], positions[at + 1], positions[at + 2]];
          for (let i = 0; i < 3; i++) sum += triangle[3 * corner + i] = m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i];
        }
        if (Number.isFinite(sum)) visit(triangle);
      }
    }
  }
}

/** The height of the lowest surface above each texel. */
class Heights {
  private readonly lowest = new Float64Array(LOOK.texels * LOOK.texels).fill(Infinity);
  /** The number of samples that may still be taken; negative after more were needed. */
  private steps = LOOK.most_steps;

  /** Adds samples of a triangle, at most a texel apart. Vertical triangles get samples, too. `corners`: three points. */
  add(corners: Float64Array): void {
    const side = (from: number, to: number) => Math.max(Math.abs(corners[to] - corners[from]), Math.abs(corners[to + 2] - corners[from + 2]));
    const [ab, bc, ca] = [side(0, 3), side(3, 6), side(6, 0)];
    if (ab < 1 && bc < 1 && ca < 1) {
      for (let at = 0; at < 9; at += 3) this.addSample(corners[at], corners[at + 1], corners[at + 2]);
      return;
    }
    const [a, b, c] = [0, 3, 6].map((at): Point => [corners[at], corners[at + 1], corners[at + 2]]);
    if (ab >= bc && ab >= ca) this.addStrips(a, b, c, ca, bc);
    else if (bc >= ca) this.addStrips(b, c, a, ab, ca);
    else this.addStrips(c, a, b, bc, ab);
  }

  /** Adds samples along lines from the longest side `ab` to the same fraction of the way from `a` over `c` to `b`. `ac`, `cb`: the lengths of these sides. */
  private addStrips(a: Point, b: Point, c: Point, ac: number, cb: number): void {
    const lines = Math.max(1, Math.ceil(ac + cb));
    for (let line = 0; line <= lines && this.steps >= 0; line++) {
      const way = ((ac + cb) * line) / lines;
      const from = mix(a, b, line / lines);
      const to = way < ac ? mix(a, c, way / ac) : mix(c, b, (way - ac) / Math.max(cb, 1e-9));
      const samples = Math.max(1, Math.ceil(distance(from, to)));
      for (let sample = 0; sample <= samples; sample++) {
        const t = sample / samples;
        this.addSample(from[0] + (to[0] - from[0]) * t, from[1] + (to[1] - from[1]) * t, from[2] + (to[2] - from[2]) * t);
      }
    }
  }

  private addSample(x: number, height: number, z: number): void {
    this.steps--;
    const column = Math.min(Math.max(0, Math.floor(x)), LOOK.texels - 1);
    const at = Math.min(Math.max(0, Math.floor(z)), LOOK.texels - 1) * LOOK.texels + column;
    if (height < this.lowest[at]) this.lowest[at] = height;
  }

  /** The part of the light that is missing, of 255; null if there were too many samples. `radius`: half the diagonal of the box in texels. */
  darkness(radius: number): Uint8Array<ArrayBuffer> | null {
    if (this.steps < 0) return null;
    const light = new Float64Array(this.lowest.length).fill(1);
    for (const { reach, blur, darkness } of LOOK.shadows) {
      const linear = this.lowest.map((height) => Math.max(0, 1 - height / reach));
      let shadow = linear.map((part) => part * part);
      for (let pass = 0; pass < 6; pass++) shadow = blurredAndTurned(shadow, Math.floor(blur * radius + 0.5));
      shadow.forEach((part, at) => (light[at] *= 1 - darkness * part));
    }
    const texels = new Uint8Array(light.length);
    light.forEach((part, at) => (texels[at] = Math.floor(255 * (1 - part) + 0.5)));
    return texels;
  }
}

/** The means of `2 radius + 1` texels along each row, with rows and columns exchanged. Beyond the edge, there is 0. */
function blurredAndTurned(texels: Float64Array<ArrayBuffer>, radius: number): Float64Array<ArrayBuffer> {
  const side = LOOK.texels;
  const out = new Float64Array(texels.length);
  for (let row = 0; row < side; row++) {
    const first = row * side;
    let sum = 0;
    for (let x = 0; x < Math.min(radius, side); x++) sum += texels[first + x];
    for (let x = 0; x < side; x++) {
      if (x + radius < side) sum += texels[first + x + radius];
      out[x * side + row] = sum / (2 * radius + 1);
      if (x >= radius) sum -= texels[first + x - radius];
    }
  }
  return out;
}

/** The larger of the distances along x and z. */
function distance(a: Point, b: Point): number {
  return Math.max(Math.abs(b[0] - a[0]), Math.abs(b[2] - a[2]));
}

function mix(a: Point, b: Point, t: number): Point {
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}
