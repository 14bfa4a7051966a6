// One side of the slider: every part with the tangents of one source.

import { BufferAttribute, BufferGeometry, Group, Mesh, type MeshStandardMaterial } from 'three';

import type { Arrangement } from '../surface/arrangement';
import { floatsOf, type Part } from './parts';
import { withPattern } from './pattern';

/** Mistakes that circulate, to be looked at. */
export interface Mistakes {
  green: boolean;
  w: boolean;
  v: boolean;
}

/** Attributes that both sides share. */
export type Shared = Map<string, BufferAttribute>;

/** The vertices of a part once split, but for tangents. */
export function shared(part: Part, arrangement: Arrangement): Shared {
  const { sourceOfVertex, positions, normals, uvs, angles } = arrangement;
  const out: Shared = new Map();
  const put = (name: string, array: Float32Array, width: number) => out.set(name, new BufferAttribute(array, width));
  put('position', positions, 3);
  put('normal', normals, 3);
  put('layout', uvs, 2);
  put('angle', angles ?? new Float32Array(positions.length / 3), 1);
  for (const name of ['uv', 'uv1', 'uv2', 'uv3', 'color']) {
    const attribute = part.geometry.getAttribute(name);
    if (!attribute) continue;
    const all = floatsOf(attribute, attribute.itemSize);
    const of = new Float32Array(sourceOfVertex.length * attribute.itemSize);
    sourceOfVertex.forEach((source, vertex) => of.set(all.subarray(source * attribute.itemSize, (source + 1) * attribute.itemSize), vertex * attribute.itemSize));
    put(name, of, attribute.itemSize);
  }
  if (!out.has('uv')) put('uv', uvs, 2);
  return out;
}

/** The geometry of one side of a part. `hasTangents`: false for sources that are no vertex data. */
export function geometryOf(
  shared: Shared,
  indices: BufferAttribute,
  tangents: Float32Array | null,
  hasTangents: boolean,
  mistakes: Mistakes,
): BufferGeometry {
  const geometry = new BufferGeometry().setIndex(indices);
  for (const [name, attribute] of shared) {
    const isTurned = mistakes.v && name.startsWith('uv');
    geometry.setAttribute(name, isTurned ? mapped(attribute, 1, (v) => 1 - v) : attribute);
  }
  if (!tangents) return geometry;
  const frame = new BufferAttribute(tangents, 4);
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

/** The material of one side of a part. */
export function materialOf(part: Part, hasTangents: boolean, hasPattern: boolean, mistakes: Mistakes): MeshStandardMaterial {
  const material = part.material.clone();
  const isPattern = !material.normalMap && hasPattern;
  const { vDown } = part.surface;
  if (isPattern) withPattern(material, vDown);
  // Without tangents, three.js takes green along the derivative by v; glTF's v runs down, so green has to be turned.
  const isTurned = vDown && !hasTangents;
  const wasTurned = part.isGreenTurned && !isPattern;
  if (isTurned !== wasTurned) material.normalScale.y *= -1;
  if (mistakes.green) material.normalScale.y *= -1;
  return material;
}

/** A group with one mesh for each part. */
export function groupOf(meshes: Mesh[], layer: number): Group {
  const group = new Group().add(...meshes);
  group.traverse((object) => object.layers.set(layer));
  return group;
}
