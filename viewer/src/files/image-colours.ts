// What an image holds, as far as it has to be guessed.

/** Texels along a side that are looked at. */
const SIDE = 32;

/** How far the channels of a coloured image's texels are apart on average, of 255: normal maps are bluish, by more than 60. */
const APART = 24;

/** Whether an image has colours, as normal maps have and height maps do not. */
export function isColored(image: CanvasImageSource): boolean {
  const context = new OffscreenCanvas(SIDE, SIDE).getContext('2d')!;
  context.drawImage(image, 0, 0, SIDE, SIDE);
  const { data } = context.getImageData(0, 0, SIDE, SIDE);
  let sum = 0;
  for (let at = 0; at < data.length; at += 4) {
    const texel = [data[at], data[at + 1], data[at + 2]];
    sum += Math.max(...texel) - Math.min(...texel);
  }
  return sum / (SIDE * SIDE) > APART;
}
