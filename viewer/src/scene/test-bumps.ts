// Test bumps: a normal map of bumps for materials that have none, on request. Bumps make wrong tangents visible under any light.

import { DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, type MeshStandardMaterial } from 'three';

const SIZE = 128;
/** The number of bumps along a side. */
const BUMPS = 4;
/** The radius of a bump, relative to its cell. */
const RADIUS = 0.36;

let texture: DataTexture | undefined;

/** Sets the bumps as the normal map of a material: eight of them across the UV square. */
export function withBumps(material: MeshStandardMaterial): void {
  texture ??= pattern();
  material.normalMap = texture;
  material.normalScale.set(1, 1);
}

/** Makes the texture. Its first row is the top, and green points up, as where v points down the image. */
function pattern(): DataTexture {
  const data = new Uint8Array(SIZE * SIZE * 4);
  for (let row = 0; row < SIZE; row++) {
    for (let column = 0; column < SIZE; column++) {
      const [x, y] = [within(column), within(row)];
      const isBump = Math.hypot(x, y) < RADIUS;
      const [nx, ny] = isBump ? [x / RADIUS, -y / RADIUS].map((slope) => 0.9 * slope) : [0, 0];
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

/** The coordinate of a texel in its bump's cell, from -0.5 to 0.5. */
function within(texel: number): number {
  return ((texel + 0.5) * BUMPS) / SIZE % 1 - 0.5;
}
