// Compiled, never run: what users may write, and what they may not.

import { encodeTangents, generateTangents as generateAny, measureTangents, splitVertices } from 'darboux';
import { check, judgeNormalMap, type Finding } from 'darboux/check';
import { tangents as transform } from 'darboux/gltf-transform';
import * as mikktspace from 'darboux/mikktspace';
import { generateTangents, ready, type MikkTSpaceOptions } from 'darboux/tangents';
import { computeTangents } from 'darboux/three';
import { generateTangents as onGpu, openDevice, shaders, type GpuTangents } from 'darboux/webgpu';
import type { Document } from '@gltf-transform/core';
import { Texture, type SphereGeometry } from 'three';
import { computeMikkTSpaceTangents } from 'three/addons/utils/BufferGeometryUtils.js';

const loaded: Promise<void> = ready;
const floats = new Float32Array();
const options: MikkTSpaceOptions = { mode: 'corrected', threshold: 60, faces: Uint32Array.of(3, 4) };
const tangents: Float32Array<ArrayBuffer> = generateTangents(floats, floats, floats, new Uint16Array(), options);
generateTangents(floats, floats, floats, null, { faces: 4 });
// @ts-expect-error: arrays of numbers are not taken
generateTangents([0, 0, 0], floats, floats);
// @ts-expect-error: an unknown mode
generateTangents(floats, floats, floats, null, { mode: 'best' });
// @ts-expect-error: an unknown option
generateTangents(floats, floats, floats, null, { method: 'lengyel' });
generateAny(floats, floats, floats, null, { method: 'lengyel' });
const octahedral: Int16Array = encodeTangents(floats, 'octahedral');
// @ts-expect-error: this form has two bytes
const diamond: Int16Array = encodeTangents(floats, 'diamond', floats);
const largest: number = measureTangents(tangents, tangents).max;
const sources: Uint32Array = splitVertices(new Uint32Array(), tangents, 4).sourceOfVertex;


export async function adapters(document: Document, sphere: SphereGeometry): Promise<SphereGeometry> {
  await document.transform(transform(), transform({ overwrite: true, generateTangents: mikktspace.generateTangents }));
  // @ts-expect-error: this mode leaves zero tangents
  transform({ mode: 'reference' });
  await mikktspace.ready;
  computeMikkTSpaceTangents(sphere, mikktspace);
  // @ts-expect-error: the sign is not guessed
  computeTangents(sphere);
  return computeTangents(sphere, new Texture(), { uv: 'uv1', method: 'angle-area' });
}

export async function tangentsOnGpu(buffer: GPUBuffer): Promise<number> {
  const device = await openDevice();
  const { cpuCorners }: GpuTangents = await onGpu(device, floats, floats, floats, null, { returnReport: true });
  const tangents: Float32Array<ArrayBuffer> = await onGpu(device, floats, floats, floats, null, { mode: 'corrected', threshold: 60, buffer });
  // @ts-expect-error: shaders have one method
  await onGpu(device, floats, floats, floats, null, { method: 'lengyel' });
  const texts: readonly string[] = shaders.scan;
  return cpuCorners + tangents.length + texts.length;
}

const findings: Finding[] = check(new Uint8Array(), { green: 'down' });
// @ts-expect-error: another direction
check(new Uint8Array(), { green: 'left' });
const verdict: 'opengl' | 'directx' | 'no_gradient' | 'flat' | 'cannot_tell' = judgeNormalMap(new Uint8ClampedArray(16), 2, 2).verdict;

export { diamond, findings, largest, loaded, octahedral, sources, tangents, verdict };
