// The model with new tangents, as a GLB.

import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';

import { call } from '../worker/client';
import type { Outcome, Summary } from './gltf-wasm';
import type { Model } from './model';

/**
 * Tangents are written into the file that was opened, of which all else stays. An OBJ becomes a GLB first: the exporter turns its images
 * over, as v runs down there, and green with them.
 */
export async function repairedGlb({ name, scene, bytes }: Model): Promise<Outcome<Summary>> {
  return call('repair', name, bytes ?? new Uint8Array((await new GLTFExporter().parseAsync(scene, { binary: true })) as ArrayBuffer));
}
