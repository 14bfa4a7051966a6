// Guesses whether an image is a normal map or a height map.

/** The width and height that the image is reduced to. */
const SIDE = 32;

/** The least mean difference between the largest and the smallest channel of a coloured image, of 255. Normal maps have more than 60. */
const MIN_DIFFERENCE = 24;

/** Whether an image is coloured, as normal maps are and height maps are not. */
export function isColored(image: CanvasImageSource): boolean {
  const context = new OffscreenCanvas(SIDE, SIDE).getContext('2d')!;
  context.drawImage(image, 0, 0, SIDE, SIDE);
  const { data } = context.getImageData(0, 0, SIDE, SIDE);
  let sum = 0;
  for (let at = 0; at < data.length; at += 4) {
    const texel = [data[at], data[at + 1], data[at + 2]];
    sum += Math.max(...texel) - Math.min(...texel);
  }
  return sum / (SIDE * SIDE) > MIN_DIFFERENCE;
}
