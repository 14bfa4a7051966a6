// Images with half the texels along each side.

/** RGBA texels of 8 bits per channel, row by row. */
export interface Texels {
  texels: Uint8Array<ArrayBuffer>;
  width: number;
  height: number;
}

/** The image with half the width and half the height, rounded down, and at least 1. Each texel is the mean of four, as in a mip level. */
export function halvedTexels({ texels, width, height }: Texels): Texels {
  const [halfWidth, halfHeight] = [width, height].map((side) => Math.max(1, side >> 1));
  // A side of one texel stays: both of its neighbours are the texel itself.
  const [right, below] = [width > 1 ? 4 : 0, height > 1 ? 4 * width : 0];
  const out = new Uint8Array(4 * halfWidth * halfHeight);
  for (let y = 0; y < halfHeight; y++) {
    for (let x = 0; x < halfWidth; x++) {
      const from = 4 * (2 * y * width + 2 * x);
      const to = 4 * (y * halfWidth + x);
      for (let i = from; i < from + 4; i++) out[to + i - from] = (texels[i] + texels[i + right] + texels[i + below] + texels[i + right + below] + 2) >> 2;
    }
  }
  return { texels: out, width: halfWidth, height: halfHeight };
}
