// One side of the slider: a part with the tangents of one source.

import { BufferAttribute, BufferGeometry, type MeshStandardMaterial } from 'three';

import type { Mistakes } from '../settings';
import { NO_ANGLE } from '../surface/angles';
import type { Arrangement } from '../surface/comparison';
import { floatsOf } from './attribute-floats';
import type { Part } from './model-parts';
import { withPattern } from './dome-pattern';

/** Attributes that both sides have. */
export type Shared = Map<string, BufferAttribute>;

/** The vertices of a part once split, but for tangents. */
export function sharedOf(part: Part, arrangement: Arrangement): Shared {
  const { sourceOfVertex, positions, normals, uvs, angles } = arrangement;
  const shared: Shared = new Map();
  const put = (name: string, array: Float32Array, width: number) => shared.set(name, new BufferAttribute(array, width));
  put('position', positions, 3);
  put('normal', normals, 3);
  put('chart', charted(uvs, part.surface.vDown), 2);
  put('angle', angles ?? new Float32Array(sourceOfVertex.length).fill(NO_ANGLE), 1);
  for (const name of ['uv', 'uv1', 'uv2', 'uv3', 'color']) {
    const attribute = part.geometry.getAttribute(name);
    if (!attribute) continue;
    const width = attribute.itemSize;
    const all = floatsOf(attribute, width);
    const taken = new Float32Array(sourceOfVertex.length * width);
    sourceOfVertex.forEach((source, vertex) => taken.set(all.subarray(source * width, (source + 1) * width), vertex * width));
    put(name, taken, width);
  }
  if (!shared.has('uv')) put('uv', uvs, 2);
  return shared;
}

/** UVs as they lie on an image that is seen upright. */
function charted(uvs: Float32Array, vDown: boolean): Float32Array {
  return vDown ? uvs.map((x, at) => (at % 2 ? 1 - x : x)) : uvs;
}

/** The geometry of one side. `frames`: 4 floats per vertex; `hasTangents`: whether the renderer gets them. */
export function geometryOf(
  shared: Shared,
  indices: BufferAttribute,
  frames: Float32Array,
  hasTangents: boolean,
  mistakes: Mistakes,
): BufferGeometry {
  const geometry = new BufferGeometry().setIndex(indices);
  for (const [name, attribute] of shared) {
    const isTurned = mistakes.v && name.startsWith('uv');
    geometry.setAttribute(name, isTurned ? mapped(attribute, 1, (v) => 1 - v) : attribute);
  }
  const frame = new BufferAttribute(frames, 4);
  const shown = mistakes.w ? mapped(frame, 3, (w) => -w) : frame;
  geometry.setAttribute('frame', shown);
  if (hasTangents) geometry.setAttribute('tangent', shown);
  return geometry;
}

/** A copy with one component of each element changed. */
function mapped(attribute: BufferAttribute, component: number, change: (x: number) => number): BufferAttribute {
  const copy = attribute.clone();
  for (let at = 0; at < copy.count; at++) copy.setComponent(at, component, change(copy.getComponent(at, component)));
  return copy;
}

/** The material of one side. */
export function materialOf(part: Part, hasTangents: boolean, hasPattern: boolean, mistakes: Mistakes): MeshStandardMaterial {
  const material = part.material.clone();
  const { vDown } = part.surface;
  const isPattern = !material.normalMap && hasPattern;
  if (isPattern) withPattern(material, vDown);
  // Without tangents, three.js takes green along the derivative by v; glTF's v runs down, so green has to be turned.
  const isTurned = vDown && !hasTangents;
  const wasTurned = part.isGreenTurned && !isPattern;
  if (isTurned !== wasTurned) material.normalScale.y *= -1;
  if (mistakes.green) material.normalScale.y *= -1;
  material.polygonOffset = true;
  material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
  return material;
}
