// `darboux/three`: tangents of BufferGeometry.

import {
  BufferAttribute,
  InterleavedBuffer,
  InterleavedBufferAttribute,
  MathUtils,
  type BufferGeometry,
  type GLBufferAttribute,
  type TypedArray,
} from 'three';
import { generateTangents, ready, splitVertices } from './darboux.js';
import type { Indices, TangentOptions } from './types.js';

export { generateTangents, ready } from './darboux.js';

/** Whether `ready` has resolved: with `ready`, `generateTangents` and `dispose` what `computeMikkTSpaceTangents` of three.js expects. */
export let isReady = false;

// Who awaits `ready` hears of what goes wrong.
ready.then(() => (isReady = true), () => {});

/** Does nothing, as there is nothing to release: for callers of three.js's module. */
export function dispose(): void {}

/** What {@link computeTangents} does beyond `darboux`'s own options. */
export interface ComputeTangentsOptions extends Omit<TangentOptions, 'faces'> {
  /**
   * Default: true, as in three.js's `computeMikkTSpaceTangents`: right for UVs whose v points down the image, as glTF's do (textures with
   * `flipY = false`). Give false where v points up it (`flipY = true`, what three.js's own loaders of images set).
   */
  negateSign?: boolean;
  /** The attribute of the UVs that the normal map has. Default: 'uv'. */
  uv?: string;
}

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/**
 * Gives a geometry of triangles tangents. The index stays; vertices are copied only where their corners need different tangents, as at
 * mirrored seams, and then every attribute and morph attribute follows, groups and the draw range stay right. Attributes may be interleaved or
 * normalized; where normals are normalized integers, tangents become such.
 *
 * `await ready` first. A material that GLTFLoader made for a geometry without tangents has a negated `normalScale.y`: negate it back.
 *
 * @returns The geometry.
 * @throws Error without position, normal or UVs; RangeError where lengths do not fit together or an index is out of range.
 */
export function computeTangents<G extends BufferGeometry>(geometry: G, options: ComputeTangentsOptions = {}): G {
  const { negateSign = true, uv = 'uv', ...rest } = options;
  const normal = attribute(geometry, 'normal');
  const arrays = [floats(attribute(geometry, 'position'), 3), floats(normal, 3), floats(attribute(geometry, uv), 2)] as const;
  const index = geometry.index && integers(geometry.index.array);
  const tangents = generateTangents(...arrays, index, rest);
  if (negateSign) for (let at = 3; at < tangents.length; at += 4) tangents[at]! *= -1;
  const { array } = normal;
  const codes = normal.normalized && (array instanceof Int8Array || array instanceof Int16Array) ? array : null;
  // Rounded before vertices are split, so that what becomes equal shares a vertex.
  if (codes) tangents.forEach((x, at) => (tangents[at] = MathUtils.denormalize(MathUtils.normalize(x, codes), codes)));
  const ofVertex = index ? split(geometry, index, tangents) : tangents;
  geometry.setAttribute('tangent', codes ? normalized(ofVertex, codes) : new BufferAttribute(ofVertex, 4));
  return geometry;
}

/** An attribute that must be there. */
function attribute(geometry: BufferGeometry, name: string): Attribute {
  const found = geometry.getAttribute(name) as Attribute | GLBufferAttribute | undefined;
  if (!found) throw new Error(`the geometry has no attribute '${name}'; tangents need positions, normals and UVs`);
  if (!('array' in found)) throw new Error(`the attribute '${name}' lies on the GPU; tangents need its array`);
  return found;
}

/** The values of an attribute that is in any form. */
function floats(attribute: Attribute, width: number): Float32Array {
  const { array, normalized, itemSize, count } = attribute;
  const isPlain = array instanceof Float32Array && !normalized && itemSize === width;
  if (isPlain && !('data' in attribute)) return array.subarray(0, width * count);
  const values = new Float32Array(width * count);
  for (let vertex = 0; vertex < count; vertex++) {
    for (let component = 0; component < width; component++) {
      values[width * vertex + component] = attribute.getComponent(vertex, component);
    }
  }
  return values;
}

function integers(array: TypedArray): Indices {
  const isOne = array instanceof Uint8Array || array instanceof Uint16Array || array instanceof Uint32Array;
  return isOne ? array : Uint32Array.from(array);
}

/** Tangents in the integers of normals. */
function normalized(tangents: Float32Array, codes: Int8Array | Int16Array): BufferAttribute {
  const array = new (codes.constructor as Int8ArrayConstructor)(tangents.length);
  tangents.forEach((x, at) => (array[at] = MathUtils.normalize(x, codes)));
  return new BufferAttribute(array, 4, true);
}

/** Copies the vertices that need several tangents: the tangent of every vertex. */
function split(geometry: BufferGeometry, index: Indices, tangents: Float32Array): Float32Array {
  const { count } = geometry.getAttribute('position');
  const { tangentOfVertex, indices, sourceOfVertex } = splitVertices(index, tangents, count);
  if (sourceOfVertex.length > count) {
    // What is on the GPU goes; three.js uploads the rest anew when it draws.
    geometry.dispose();
    gatherAll(geometry, sourceOfVertex);
    setIndex(geometry, indices, sourceOfVertex.length);
  }
  return tangentOfVertex;
}

/** The index list again, in its own numbers if the vertices do not outgrow them. The largest number means "restart" to a GPU. */
function setIndex(geometry: BufferGeometry, indices: Uint32Array<ArrayBuffer>, vertices: number): void {
  const { array } = geometry.index!;
  const Kind = array.constructor as Uint32ArrayConstructor;
  const fits = vertices < 2 ** (8 * array.BYTES_PER_ELEMENT);
  geometry.setIndex(new BufferAttribute(fits ? Kind.from(indices) : indices, 1));
}

/** Gives every vertex the values of its source, in all attributes but those of instances. */
function gatherAll(geometry: BufferGeometry, sources: Uint32Array): void {
  const buffers = new Map<InterleavedBuffer, InterleavedBuffer>();
  const { attributes, morphAttributes } = geometry;
  geometry.deleteAttribute('tangent');
  for (const [name, attribute] of Object.entries(attributes)) {
    geometry.setAttribute(name, gathered(attribute as Attribute, sources, buffers));
  }
  for (const targets of Object.values(morphAttributes)) {
    targets.forEach((attribute, at) => (targets[at] = gathered(attribute as Attribute, sources, buffers) as typeof attribute));
  }
}

function gathered(attribute: Attribute, sources: Uint32Array, buffers: Map<InterleavedBuffer, InterleavedBuffer>): Attribute {
  if ('isInstancedBufferAttribute' in attribute) return attribute;
  if ('data' in attribute) {
    const { data, itemSize, offset, normalized } = attribute;
    if ('isInstancedInterleavedBuffer' in data) return attribute;
    if (!buffers.has(data)) buffers.set(data, gatheredBuffer(data, sources));
    const result = new InterleavedBufferAttribute(buffers.get(data)!, itemSize, offset, normalized);
    result.name = attribute.name;
    return result;
  }
  const Kind = attribute.constructor as typeof BufferAttribute;
  const { array, itemSize, normalized, usage, gpuType, name } = attribute;
  return Object.assign(new Kind(gatheredRows(array, itemSize, sources), itemSize, normalized), { usage, gpuType, name });
}

function gatheredBuffer({ array, stride, usage }: InterleavedBuffer, sources: Uint32Array): InterleavedBuffer {
  return new InterleavedBuffer(gatheredRows(array, stride, sources), stride).setUsage(usage);
}

function gatheredRows(array: TypedArray, width: number, sources: Uint32Array): TypedArray {
  const result = new (array.constructor as Float32ArrayConstructor)(width * sources.length);
  sources.forEach((source, vertex) => {
    for (let at = 0; at < width; at++) result[width * vertex + at] = array[width * source + at]!;
  });
  return result;
}
