// The open model as a GLB document, and exports of it.

import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';

import { call } from '../worker/surfaces';
import type { Outcome, Summary } from './gltf-wasm';
import type { Model } from './model';

const exported = new WeakMap<Model, Promise<Uint8Array<ArrayBuffer>>>();

/**
 * The model as a self-contained GLB. An OBJ is converted once: the exporter flips its images vertically because v points down in glTF, and
 * negates their green channel.
 */
export async function documentOf(model: Model): Promise<Uint8Array<ArrayBuffer>> {
  if (model.bytes) return model.bytes;
  const converted = exported.get(model) ?? convert(model);
  exported.set(model, converted);
  return converted;
}

async function convert({ scene }: Model): Promise<Uint8Array<ArrayBuffer>> {
  return new Uint8Array((await new GLTFExporter().parseAsync(scene, { binary: true })) as ArrayBuffer);
}

/** Writes MikkTSpace's tangents into the model and changes nothing else. A model of another format is read again, because its glTF has no quads. */
export async function withTangents(model: Model): Promise<Outcome<Summary>> {
  const { name, source, files } = model;
  if (!source) return call('repair', name, await documentOf(model), new Map());
  return call('repair', name, new Uint8Array(await files.get(name)!.arrayBuffer()), files);
}
