// How much two pictures of a model differ to the eye, and where, and where the model is in them.

/** The difference of a channel, of 255, that is seen. */
const SEEN = 14;

/** The difference of a channel, of 255, from which a pixel is not the background. */
const COVERED = 4;

/** The least part of the model's pixels on each side of the divide. */
const BESIDE_DIVIDE = 0.2;

/** The blocks along a side of the picture, of which one differs most. */
const BLOCKS = 12;

/** What differs between two pictures. */
export interface SeenDifference {
  /** The share of the pixels that differ visibly. */
  share: number;
  /** The median column of these pixels, from 0 to 1 from the left; the middle where there are none. */
  column: number;
  /** The pixel that differs most in the block that differs most, from 0 to 1 from the left and from the top. */
  strongest: [number, number];
  /** The columns, from 0 to 1 from the left, between which a divide has a fifth or more of the model's pixels on each side; all columns where no model is seen. */
  divides: [number, number];
}

/** Compares two pictures of equal size. `background`: red, green and blue behind the model, of 255. */
export function seenDifference(left: ImageData, right: ImageData, background: readonly number[]): SeenDifference {
  const { width, height } = left;
  const [columns, covered] = [new Uint32Array(width), new Uint32Array(width)];
  const blocks = Array.from({ length: BLOCKS * BLOCKS }, () => ({ sum: 0, most: 0, pixel: 0 }));
  let count = 0;
  for (let at = 0; at < width * height; at++) {
    if ([left, right].some(({ data }) => background.some((channel, i) => Math.abs(data[4 * at + i] - channel) > COVERED))) covered[at % width]++;
    const difference = Math.max(...[0, 1, 2].map((i) => Math.abs(left.data[4 * at + i] - right.data[4 * at + i])));
    if (difference === 0) continue;
    const [x, y] = [at % width, Math.floor(at / width)];
    const block = blocks[Math.floor((y * BLOCKS) / height) * BLOCKS + Math.floor((x * BLOCKS) / width)];
    block.sum += difference;
    if (difference > block.most) [block.most, block.pixel] = [difference, at];
    if (difference <= SEEN) continue;
    count++;
    columns[x]++;
  }
  const { pixel } = blocks.reduce((most, block) => (block.sum > most.sum ? block : most));
  const strongest: [number, number] = [((pixel % width) + 0.5) / width, (Math.floor(pixel / width) + 0.5) / height];
  return { share: count / (width * height), column: quantile(columns, 0.5) ?? 0.5, strongest, divides: [quantile(covered, BESIDE_DIVIDE) ?? 0, quantile(covered, 1 - BESIDE_DIVIDE) ?? 1] };
}

/** The place, from 0 to 1, up to which a part of the counted things lies; null where there are none. */
function quantile(counts: Uint32Array, part: number): number | null {
  const count = counts.reduce((sum, here) => sum + here, 0);
  let below = 0;
  const at = counts.findIndex((here) => (below += here) >= part * count);
  return count ? (at + 0.5) / counts.length : null;
}
