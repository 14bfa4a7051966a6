// `darboux/three`: tangents of three.js geometries. Vertices are split where needed, and the index, groups and morph targets stay valid.

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

/** True once `ready` has resolved. `computeMikkTSpaceTangents` of three.js takes a module with `ready`, `isReady`, `generateTangents` and
 * `dispose`. */
export let isReady = false;

// A caller that awaits `ready` gets its error; nobody else needs it.
ready.then(() => (isReady = true), () => {});

/** Does nothing, because nothing has to be released. Callers of three.js's module call it. */
export function dispose(): void {}

/** What decides the sign of tangents: a texture of three.js, or any object with its `flipY`. */
export interface NormalMap {
  /** Whether v points up the image. `TextureLoader` sets true; glTF, and with it `GLTFLoader`, has false. */
  readonly flipY: boolean;
}

/** Options of {@link computeTangents}: those of `darboux`, and one more. */
export interface ComputeTangentsOptions extends Omit<TangentOptions, 'faces'> {
  /** The name of the attribute with the UVs of the normal map. Default: 'uv'. */
  uv?: string | null;
}

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/**
 * Adds tangents to a geometry of triangles, in place. The geometry stays indexed. A vertex is copied, with all its attributes and morph
 * attributes, only where its corners need different tangents, as at mirrored seams. Groups and the draw range stay valid. Attributes may be
 * interleaved or normalized. Where normals are normalized integers, the tangents are normalized integers too.
 *
 * Await `ready` first. A material that GLTFLoader made for a geometry without tangents has a negated `normalScale.y`: negate it again.
 *
 * @param normalMap The texture that will be drawn with these tangents, or `{ flipY }`. Green points up the image; with `flipY = false` v points
 * down, so the signs are negated, as in three.js's `computeMikkTSpaceTangents`.
 * @returns The geometry.
 * @throws TypeError without `normalMap.flipY`; Error without position, normal or UVs; RangeError where lengths do not fit together or an index
 * is out of range.
 */
export function computeTangents<G extends BufferGeometry>(geometry: G, normalMap: NormalMap, options?: ComputeTangentsOptions | null): G {
  const { uv, ...rest } = options ?? {};
  if (typeof normalMap?.flipY !== 'boolean') {
    throw new TypeError('computeTangents needs the normal map, whose flipY decides the sign: pass material.normalMap, { flipY: true } for images of TextureLoader, or { flipY: false } for glTF');
  }
  const normal = attribute(geometry, 'normal');
  const arrays = [floats(attribute(geometry, 'position'), 3), floats(normal, 3), floats(attribute(geometry, uv ?? 'uv'), 2)] as const;
  const index = geometry.index && integers(geometry.index.array);
  const tangents = generateTangents(...arrays, index, rest);
  if (!normalMap.flipY) for (let at = 3; at < tangents.length; at += 4) tangents[at]! *= -1;
  const { array } = normal;
  const codes = normal.normalized && (array instanceof Int8Array || array instanceof Int16Array) ? array : null;
  // Tangents are rounded before vertices are split, so that tangents that become equal share a vertex.
  if (codes) tangents.forEach((x, at) => (tangents[at] = MathUtils.denormalize(MathUtils.normalize(x, codes), codes)));
  const ofVertex = index ? split(geometry, index, tangents) : tangents;
  geometry.setAttribute('tangent', codes ? normalized(ofVertex, codes) : new BufferAttribute(ofVertex, 4));
  return geometry;
}

/** An attribute. Errors: it is missing, or on the GPU only. */
function attribute(geometry: BufferGeometry, name: string): Attribute {
  const found = geometry.getAttribute(name) as Attribute | GLBufferAttribute | undefined;
  if (!found) throw new Error(`the geometry has no attribute '${name}'; tangents need positions, normals and UVs`);
  if (!('array' in found)) throw new Error(`the attribute '${name}' is on the GPU; tangents need its array`);
  return found;
}

/** The values of an attribute as floats: dequantised, and not interleaved. */
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

/** An index as an array type that `darboux` takes. */
function integers(array: TypedArray): Indices {
  const isIndices = array instanceof Uint8Array || array instanceof Uint16Array || array instanceof Uint32Array;
  return isIndices ? array : Uint32Array.from(array);
}

/** Tangents as normalized integers of the normals' type. */
function normalized(tangents: Float32Array, codes: Int8Array | Int16Array): BufferAttribute {
  const array = new (codes.constructor as Int8ArrayConstructor)(tangents.length);
  tangents.forEach((x, at) => (array[at] = MathUtils.normalize(x, codes)));
  return new BufferAttribute(array, 4, true);
}

/** Splits the vertices that need several tangents, and returns the tangent of every vertex. */
function split(geometry: BufferGeometry, index: Indices, tangents: Float32Array): Float32Array {
  const { count } = geometry.getAttribute('position');
  const { tangentOfVertex, indices, sourceOfVertex } = splitVertices(index, tangents, count);
  if (sourceOfVertex.length > count) {
    // Frees the old buffers on the GPU; three.js uploads the new ones when it draws.
    geometry.dispose();
    gatherAll(geometry, sourceOfVertex);
    setIndex(geometry, indices, sourceOfVertex.length);
  }
  return tangentOfVertex;
}

/** Sets the index, in the old integer type if it fits. The largest integer of a type is the primitive restart value. */
function setIndex(geometry: BufferGeometry, indices: Uint32Array<ArrayBuffer>, vertices: number): void {
  const { array } = geometry.index!;
  const Kind = array.constructor as Uint32ArrayConstructor;
  const fits = vertices < 2 ** (8 * array.BYTES_PER_ELEMENT);
  geometry.setIndex(new BufferAttribute(fits ? Kind.from(indices) : indices, 1));
}

/** Copies the values of source vertices to new vertices, in all attributes except those of instances. */
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
