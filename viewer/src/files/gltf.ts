// glTF and GLB.

import { LoadingManager, type Object3D } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

import { call } from '../surface/thread';
import type { Bundle } from './bundle';

/** What a .gltf or .glb shows, and all of it as one GLB. */
export interface Gltf {
  scene: Object3D;
  bytes: Uint8Array<ArrayBuffer>;
  /** What is odd but not an error, as sentences. */
  warnings: string[];
}

/** Opens a .gltf or .glb. Errors: a sentence for people. */
export async function openGltf(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Gltf> {
  const whole = (await call('whole', name, bytes, bundle)).bytes;
  const manager = new LoadingManager();
  let lost = 0;
  manager.onError = () => lost++;
  try {
    const { scene } = await new GLTFLoader(manager).parseAsync(whole.buffer, '');
    const warnings = lost ? [`${lost} ${lost === 1 ? 'texture' : 'textures'} cannot be decoded`] : [];
    return { scene, bytes: whole, warnings };
  } catch (error) {
    throw new Error(`${name} cannot be shown: ${error instanceof Error ? error.message : error}.`, { cause: error });
  }
}
