// Exports the model with new tangents as a GLB.

import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';

import { call } from '../worker/client';
import type { Outcome, Summary } from './gltf-wasm';
import type { Model } from './model';

/**
 * Writes tangents into the opened file and changes nothing else. An OBJ is converted to GLB first. The exporter flips its images vertically
 * because v points down in glTF, and negates their green channel.
 */
export async function repairedGlb({ name, scene, bytes }: Model): Promise<Outcome<Summary>> {
  return call('repair', name, bytes ?? new Uint8Array((await new GLTFExporter().parseAsync(scene, { binary: true })) as ArrayBuffer));
}
