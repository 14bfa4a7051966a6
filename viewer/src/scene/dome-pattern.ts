// A normal map for models that have none: domes, lit from wherever the light is, so that wrong tangents show.

import { DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, type MeshStandardMaterial } from 'three';

const SIZE = 128;
/** Domes along a side. */
const DOMES = 4;
/** Of a dome's cell. */
const RADIUS = 0.36;

let texture: DataTexture | undefined;

/** Gives a material the pattern, eight domes across the UV square. */
export function withPattern(material: MeshStandardMaterial, vDown: boolean): void {
  texture ??= pattern();
  material.normalMap = texture;
  material.normalScale.set(1, vDown ? 1 : -1);
}

/** Green points up the image, whose first row is its top: as it is where v runs down. */
function pattern(): DataTexture {
  const data = new Uint8Array(SIZE * SIZE * 4);
  for (let row = 0; row < SIZE; row++) {
    for (let column = 0; column < SIZE; column++) {
      const [x, y] = [within(column), within(row)];
      const isDome = Math.hypot(x, y) < RADIUS;
      const [nx, ny] = isDome ? [x / RADIUS, -y / RADIUS].map((slope) => 0.9 * slope) : [0, 0];
      const nz = Math.sqrt(1 - nx * nx - ny * ny);
      data.set([nx, ny, nz].map((n) => Math.round(127.5 * n + 127.5)), (row * SIZE + column) * 4);
      data[(row * SIZE + column) * 4 + 3] = 255;
    }
  }
  const out = new DataTexture(data, SIZE, SIZE);
  out.wrapS = out.wrapT = RepeatWrapping;
  out.repeat.set(2, 2);
  out.magFilter = LinearFilter;
  out.minFilter = LinearMipmapLinearFilter;
  out.generateMipmaps = true;
  out.anisotropy = 8;
  out.needsUpdate = true;
  return out;
}

/** The place of a texel in its dome's cell, from -0.5 to 0.5. */
function within(texel: number): number {
  return ((texel + 0.5) * DOMES) / SIZE % 1 - 0.5;
}
