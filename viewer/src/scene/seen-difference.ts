// How much two pictures of a model differ to the eye, and where.

/** The difference of a channel, of 255, that is seen. */
const SEEN = 14;

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
}

/** Compares two pictures of equal size. */
export function seenDifference(left: ImageData, right: ImageData): SeenDifference {
  const { width, height } = left;
  const columns = new Uint32Array(width);
  const blocks = Array.from({ length: BLOCKS * BLOCKS }, () => ({ sum: 0, most: 0, pixel: 0 }));
  let count = 0;
  for (let at = 0; at < width * height; at++) {
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
  return { share: count / (width * height), column: median(columns, count), strongest };
}

/** The place of the median of counted things, from 0 to 1; the middle where there are none. */
function median(counts: Uint32Array, count: number): number {
  let below = 0;
  const at = counts.findIndex((here) => 2 * (below += here) >= count);
  return count ? at / counts.length : 0.5;
}
