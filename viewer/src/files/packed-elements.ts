// Elements that lie apart in their buffer view, next to each other where three.js cannot read them apart.

import type { GLTFLoaderPlugin, GLTFParser } from 'three/addons/loaders/GLTFLoader.js';

/** The members of an accessor that are read here. */
interface JsonAccessor {
  bufferView?: number;
  byteOffset?: number;
  componentType: number;
  count: number;
  type: string;
  sparse?: object;
}

/** The members of a buffer view that are read or written here. */
interface JsonView {
  buffer: number;
  byteLength: number;
  byteStride?: number;
}

/** The elements of one accessor in a buffer view. */
interface Elements {
  view: number;
  offset: number;
  stride: number;
  size: number;
  count: number;
}

const COMPONENT_BYTES: Record<number, number> = { 5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4 };
const WIDTHS: Record<string, number> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

/**
 * three.js places sparse elements wrongly among elements that lie apart, and refuses a view that ends with its last element instead of after a
 * whole stride. Such accessors get a view of their own, which holds their elements next to each other.
 */
export function withPackedElements(parser: GLTFParser): GLTFLoaderPlugin {
  const packed = new Map<number, Elements>();
  return {
    name: 'packed elements',
    beforeRoot: async () => {
      const { accessors = [], bufferViews = [] }: { accessors?: JsonAccessor[]; bufferViews?: JsonView[] } = parser.json;
      for (const accessor of accessors) {
        const elements = elementsApart(accessor, bufferViews);
        if (!elements) continue;
        accessor.bufferView = bufferViews.length;
        accessor.byteOffset = 0;
        packed.set(bufferViews.length, elements);
        bufferViews.push({ buffer: 0, byteLength: elements.count * elements.size });
      }
    },
    loadBufferView: (index: number) => {
      const elements = packed.get(index);
      return elements ? parser.getDependency('bufferView', elements.view).then((view: ArrayBuffer) => pack(view, elements)) : null;
    },
  };
}

/** The elements of an accessor that three.js cannot read apart; null of all others. */
function elementsApart(accessor: JsonAccessor, views: JsonView[]): Elements | null {
  const { bufferView: view, byteOffset: offset = 0, count } = accessor;
  const size = WIDTHS[accessor.type]! * COMPONENT_BYTES[accessor.componentType]!;
  if (view === undefined || !Number.isFinite(size)) return null;
  const { byteLength, byteStride: stride = size } = views[view]!;
  const isCut = Math.floor(offset / stride + count) * stride > byteLength;
  return stride !== size && (accessor.sparse || isCut) ? { view, offset, stride, size, count } : null;
}

function pack(view: ArrayBuffer, { offset, stride, size, count }: Elements): ArrayBuffer {
  const [from, to] = [new Uint8Array(view), new Uint8Array(count * size)];
  for (let at = 0; at < count; at++) to.set(from.subarray(offset + at * stride, offset + at * stride + size), at * size);
  return to.buffer;
}
