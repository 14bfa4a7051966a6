// Decodes and judges the normal maps of a GLB. Runs in the thread of the check.

import { judgeNormalMap, type MapJudgement } from 'darboux/check';

import { normalMapsOf, type StoredMap } from './stored-maps';

/** The largest side of a picture on the page; larger maps are shown smaller. */
const MAX_SIDE = 1024;

/** A normal map and its verdict. */
export interface JudgedMap extends Omit<StoredMap, 'bytes'> {
  /** The size in texels; 0 where the image cannot be decoded. */
  width: number;
  height: number;
  picture: ImageBitmap | null;
  /** Null where the image cannot be decoded. */
  judgement: MapJudgement | null;
}

/** Decodes and judges all normal maps, one after the other. */
export async function judgeMaps(file: Uint8Array<ArrayBuffer>): Promise<JudgedMap[]> {
  const judged: JudgedMap[] = [];
  for (const map of await normalMapsOf(file)) judged.push(await judge(map));
  return judged;
}

async function judge({ bytes, ...map }: StoredMap): Promise<JudgedMap> {
  // Texels are normals: they keep their values, whatever colour profile or alpha the image has.
  const options = { colorSpaceConversion: 'none', premultiplyAlpha: 'none' } as const;
  const image = bytes && (await createImageBitmap(new Blob([bytes]), options).catch(() => null));
  if (!image) return { ...map, width: 0, height: 0, picture: null, judgement: null };
  const { width, height } = image;
  const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true })!;
  context.drawImage(image, 0, 0);
  image.close();
  const texels = context.getImageData(0, 0, width, height);
  const scale = Math.min(1, MAX_SIDE / Math.max(width, height));
  const size = { resizeWidth: Math.max(1, Math.round(width * scale)), resizeHeight: Math.max(1, Math.round(height * scale)) };
  const picture = await createImageBitmap(texels, size);
  return { ...map, width, height, picture, judgement: judgeNormalMap(texels.data, width, height) };
}
