// Textures in KTX 2 (KHR_texture_basisu), which the worker decodes with the command's code.

import { DataTexture, Loader } from 'three';
import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';

import { call } from '../worker/surfaces';

const KTX2 = 'KHR_texture_basisu';

/** Loads a texture that has an image in KTX 2 and no other one. If that fails, the texture is left out, and `onLost` gets the reason. */
export function withKtx2(parser: GLTFParser, onLost: (reason: string) => void): GLTFLoaderPlugin {
  const loadTexture = (index: number) => {
    const { source, extensions } = parser.json.textures[index];
    const image: number | undefined = extensions?.[KTX2]?.source;
    return image === undefined || source !== undefined ? null : parser.loadTextureImage(index, image, new Ktx2Loader(onLost));
  };
  return { name: KTX2, loadTexture };
}

class Ktx2Loader extends Loader<DataTexture> {
  constructor(private readonly onLost: (reason: string) => void) {
    super();
  }

  override load(url: string, onLoad: (texture: DataTexture) => void, _?: unknown, onError?: (error: unknown) => void): void {
    decoded(url).then(onLoad, (error: unknown) => {
      this.onLost(error instanceof Error ? error.message : String(error));
      onError?.(error);
    });
  }
}

async function decoded(url: string): Promise<DataTexture> {
  // Nothing is fetched: missing files stay missing.
  if (!/^(data|blob):/.test(url)) throw new Error('its file is missing; give the whole folder');
  const file = new Uint8Array(await (await fetch(url)).arrayBuffer());
  const { bytes, description: [width, height] } = await call('decodeTexture', file);
  const texture = new DataTexture(bytes, width, height);
  texture.needsUpdate = true;
  return texture;
}
