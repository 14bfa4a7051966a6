// The thread that decodes textures in KTX 2, so that nothing else waits for it.

import { answer } from '../worker/calls';
import { decodeTexture } from './gltf-wasm';
import { halvedTexels, type Texels } from './halved-texels';

const functions = {
  /** Decodes a texture to RGBA texels. Its sides are halved until they have at most `largest` texels. Errors: one sentence. */
  async decode(file: Uint8Array<ArrayBuffer>, largest: number): Promise<Texels & { isSmaller: boolean }> {
    const { bytes, description: [width, height] } = await decodeTexture(file);
    let image: Texels = { texels: bytes, width, height };
    while (Math.max(image.width, image.height) > largest) image = halvedTexels(image);
    return { ...image, isSmaller: image.width < width || image.height < height };
  },
};

export type TextureFunctions = typeof functions;

answer(functions, Promise.resolve());
