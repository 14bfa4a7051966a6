// The geometry and material of a part on one side of the slider, with the tangents of one source.

import { BufferAttribute, BufferGeometry, Color, MeshPhysicalMaterial, MeshStandardMaterial } from 'three';

import type { Mistakes, Paint } from '../settings';
import { NO_ANGLE } from '../surface/angles';
import type { Comparison } from '../surface/comparison';
import { floatsOf } from './attribute-floats';
import type { BakedMap } from './baked-map';
import type { Part } from './model-parts';
import { withBumps } from './test-bumps';

/** The attributes that both sides share, by name. */
export type SharedAttributes = Map<string, BufferAttribute>;

/** The attributes of a part's split vertices, without tangents. */
export function sharedAttributes(part: Part, comparison: Comparison): SharedAttributes {
  const { sourceOfVertex, positions, normals, uvs, angles } = comparison;
  const shared: SharedAttributes = new Map();
  const add = (name: string, array: Float32Array, width: number) => shared.set(name, new BufferAttribute(array, width));
  add('position', positions, 3);
  add('normal', normals, 3);
  add('chart', layoutPositions(uvs), 2);
  add('angle', angles ?? new Float32Array(sourceOfVertex.length).fill(NO_ANGLE), 1);
  for (const name of ['uv', 'uv1', 'uv2', 'uv3', 'color']) {
    const attribute = part.geometry.getAttribute(name);
    if (!attribute) continue;
    const width = attribute.itemSize;
    const all = floatsOf(attribute, width);
    const copied = new Float32Array(sourceOfVertex.length * width);
    sourceOfVertex.forEach((source, vertex) => copied.set(all.subarray(source * width, (source + 1) * width), vertex * width));
    add(name, copied, width);
  }
  if (!shared.has('uv')) add('uv', uvs, 2);
  return shared;
}

/** UVs as positions on the upright image: v points up. */
function layoutPositions(uvs: Float32Array): Float32Array {
  return uvs.map((x, at) => (at % 2 ? 1 - x : x));
}

/** Makes the geometry. `frames` has 4 floats per vertex, and `hasTangents` says whether the renderer gets them as tangents. */
export function sideGeometry(
  shared: SharedAttributes,
  indices: BufferAttribute,
  frames: Float32Array,
  hasTangents: boolean,
  mistakes: Mistakes,
): BufferGeometry {
  const geometry = new BufferGeometry().setIndex(indices);
  for (const [name, attribute] of shared) {
    const isFlipped = mistakes.v && name.startsWith('uv');
    geometry.setAttribute(name, isFlipped ? withComponent(attribute, 1, (v) => 1 - v) : attribute);
  }
  const frame = new BufferAttribute(frames, 4);
  const shown = mistakes.w ? withComponent(frame, 3, (w) => -w) : frame;
  geometry.setAttribute('frame', shown);
  if (hasTangents) geometry.setAttribute('tangent', shown);
  return geometry;
}

/** A copy of an attribute with one component of each element changed. */
function withComponent(attribute: BufferAttribute, component: number, change: (x: number) => number): BufferAttribute {
  const copy = attribute.clone();
  for (let at = 0; at < copy.count; at++) copy.setComponent(at, component, change(copy.getComponent(at, component)));
  return copy;
}

/** Whether test bumps may stand for a part's missing normal map. They would hide the highlights of anisotropic materials, which show the tangents better. */
export function takesBumps({ material }: Part): boolean {
  return !material.normalMap && !(material instanceof MeshPhysicalMaterial && material.anisotropy > 0);
}

/** The linear reflectance and the roughness of plain surfaces. */
const PLAIN = { reflectance: 0.4, roughness: 0.55 } as const;

/** A grey surface with the normal map of a material, and nothing else of it but where it is cut out. */
function plainOf({ normalMap, normalMapType, normalScale, side, flatShading, map, alphaTest }: MeshStandardMaterial): MeshStandardMaterial {
  const cutOut = alphaTest > 0 ? { map, alphaTest } : {};
  const color = new Color().setScalar(PLAIN.reflectance);
  const out = new MeshStandardMaterial({ color, roughness: PLAIN.roughness, metalness: 0, normalMap, normalMapType, side, flatShading, ...cutOut });
  out.normalScale.copy(normalScale);
  return out;
}

/** Makes the material of a lit surface. `baked`: the maps in place of the file's own, or null. */
export function sideMaterial(part: Part, hasTangents: boolean, paint: Paint, mistakes: Mistakes, baked: BakedMap | null): MeshStandardMaterial {
  const material = paint === 'plain' ? plainOf(part.material) : part.material.clone();
  const isBumpy = paint === 'bumps' && takesBumps(part) && !baked;
  if (isBumpy) withBumps(material);
  baked?.applyTo(material, part);
  if (paint !== 'plain') baked?.applyFurtherTo(material, part);
  // Without tangents, three.js takes green along the derivative by v. v points down the image, so green has to be negated.
  const isNegated = !hasTangents;
  const wasNegated = part.isGreenNegated && !isBumpy && !baked;
  if (isNegated !== wasNegated) material.normalScale.y *= -1;
  if (mistakes.green) material.normalScale.y *= -1;
  material.polygonOffset = true;
  material.polygonOffsetFactor = material.polygonOffsetUnits = 1;
  return material;
}
