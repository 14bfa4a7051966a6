// Textures in KTX 2 (KHR_texture_basisu), which a thread of its own decodes with the command's code.

import { DataTexture, Loader } from 'three';
import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';

import { callerOf, endWorker, type Caller } from '../worker/client';
import type { TextureFunctions } from './texture-thread';

const KTX2 = 'KHR_texture_basisu';

/** A decoded texture, and whether it has fewer texels than its file. */
interface Decoded {
  texture: DataTexture;
  isSmaller: boolean;
}

/** The textures of a model and of what is made of it. Each file is decoded once, and other models do not wait for it. */
export class Ktx2Textures {
  private readonly decoded: { file: Uint8Array; texture: Promise<Decoded> }[] = [];
  private worker: Worker | null = null;
  private call: Caller<TextureFunctions> | null = null;

  /** `largest`: the most texels along a side that the graphics card takes. */
  constructor(readonly largest: number) {}

  /** The texture in a file. Errors: one sentence. */
  decode(file: Uint8Array<ArrayBuffer>): Promise<Decoded> {
    const known = this.decoded.find((other) => hasEqualBytes(other.file, file));
    if (known) return known.texture;
    const made = { file, texture: this.decodeNew(file) };
    this.decoded.push(made);
    made.texture.catch(() => this.decoded.splice(this.decoded.indexOf(made), 1));
    return made.texture;
  }

  /** Decodes a file in the thread, which starts with the first one. */
  private async decodeNew(file: Uint8Array<ArrayBuffer>): Promise<Decoded> {
    this.worker ??= new Worker(new URL('./texture-thread.ts', import.meta.url), { type: 'module' });
    this.call ??= callerOf<TextureFunctions>(this.worker);
    const { texels, width, height, isSmaller } = await this.call('decode', file, this.largest);
    return { texture: new DataTexture(texels, width, height), isSmaller };
  }

  /** Ends the decoding, which fails where it runs. */
  stop(): void {
    if (this.worker) endWorker(this.worker, 'another file is being opened');
    [this.worker, this.call] = [null, null];
  }
}

/** What became of the textures of a file. */
export interface Ktx2Report {
  /** Why textures are left out, one sentence each. */
  lost: string[];
  /** The number of textures that are shown with fewer texels. */
  smaller: number;
}

/** Loads a texture that has an image in KTX 2 and no other one. If that fails, the texture is left out. */
export function withKtx2(parser: GLTFParser, textures: Ktx2Textures, report: Ktx2Report): GLTFLoaderPlugin {
  const loadTexture = (index: number) => {
    const { source, extensions } = parser.json.textures[index];
    const image: number | undefined = extensions?.[KTX2]?.source;
    return image === undefined || source !== undefined ? null : parser.loadTextureImage(index, image, new Ktx2Loader(textures, report));
  };
  return { name: KTX2, loadTexture };
}

class Ktx2Loader extends Loader<DataTexture> {
  constructor(private readonly textures: Ktx2Textures, private readonly report: Ktx2Report) {
    super();
  }

  override load(url: string, onLoad: (texture: DataTexture) => void, _?: unknown, onError?: (error: unknown) => void): void {
    this.read(url).then(onLoad, (error: unknown) => {
      this.report.lost.push(error instanceof Error ? error.message : String(error));
      onError?.(error);
    });
  }

  private async read(url: string): Promise<DataTexture> {
    // Nothing is fetched: missing files stay missing.
    if (!/^(data|blob):/.test(url)) throw new Error('its file is missing; give the whole folder');
    const { texture, isSmaller } = await this.textures.decode(new Uint8Array(await (await fetch(url)).arrayBuffer()));
    this.report.smaller += Number(isSmaller);
    // Shares the texels, on the graphics card, too.
    const own = texture.clone();
    own.needsUpdate = true;
    return own;
  }
}

function hasEqualBytes(a: Uint8Array, b: Uint8Array): boolean {
  return a.length === b.length && a.every((byte, at) => byte === b[at]);
}
