// glTF and GLB.

import { Loader, LoadingManager, type Object3D } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import type { KTX2Loader } from 'three/addons/loaders/KTX2Loader.js';

import { counted } from '../page/words';
import { call } from '../surface/thread';
import type { Bundle } from './bundle';

/** What a .gltf or .glb shows, and all of it as one GLB. */
export interface Gltf {
  scene: Object3D;
  bytes: Uint8Array<ArrayBuffer>;
  /** What is odd but not an error, as sentences. */
  warnings: string[];
}

/** In place of a decoder of KTX 2, which would be larger than all else of the page: the model is shown without those textures. */
class NoKtx2 extends Loader {
  override load(url: string, _: unknown, __: unknown, failed: (error: unknown) => void): void {
    this.manager.itemError(url);
    failed(new Error('KTX 2 is not read'));
  }
}

/** Opens a .gltf or .glb. Errors: a sentence for people. */
export async function openGltf(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Gltf> {
  const whole = (await call('whole', name, bytes, bundle)).bytes;
  // What the file refers to and was not given is not looked for elsewhere.
  const manager = new LoadingManager().setURLModifier((url) => (/^(data|blob):/.test(url) ? url : 'data:,'));
  let lost = 0;
  manager.onError = () => lost++;
  const loader = new GLTFLoader(manager).setKTX2Loader(new NoKtx2(manager) as unknown as KTX2Loader);
  try {
    const { scene } = await loader.parseAsync(whole.buffer, '');
    const warnings = lost ? [`${counted(lost, 'texture', 'textures')} missing or not decodable`] : [];
    return { scene, bytes: whole, warnings };
  } catch (error) {
    throw new Error(`${name} cannot be shown: ${error instanceof Error ? error.message : error}.`, { cause: error });
  }
}
