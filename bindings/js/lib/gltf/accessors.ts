// Conversions between accessors of glTF-Transform and typed arrays.

import type { Accessor, TypedArray } from '@gltf-transform/core';

/** The values of an accessor, dequantised. Errors: the number of elements is not the number of vertices. */
export function floats(accessor: Accessor, semantic: string, width: number, vertices: number): Float32Array {
  const count = accessor.getCount();
  if (count !== vertices) throw new RangeError(`${semantic} has ${count} elements for ${vertices} vertices; export the file again`);
  const array = accessor.getArray();
  if (array instanceof Float32Array) return array;
  const values = new Float32Array(width * count);
  const element: number[] = [];
  for (let at = 0; at < count; at++) values.set(accessor.getElement(at, element), width * at);
  return values;
}

/** A copy of an accessor whose element i is the old element `sources[i]`. */
export function gathered(accessor: Accessor, sources: Uint32Array): Accessor {
  const [array, width] = [accessor.getArray()!, accessor.getElementSize()];
  const result = new (array.constructor as Float32ArrayConstructor)(width * sources.length);
  sources.forEach((source, at) => {
    for (let component = 0; component < width; component++) result[width * at + component] = array[width * source + component]!;
  });
  return accessor.clone().setArray(result);
}

/** Indices in the integer type of the old indices, or in the next larger type that fits. The largest integer of a type is reserved. */
export function indexArray(indices: Uint32Array<ArrayBuffer>, vertices: number, old: TypedArray | null | undefined): TypedArray {
  const kinds = [Uint8Array, Uint16Array, Uint32Array].filter((Kind) => Kind.BYTES_PER_ELEMENT >= (old?.BYTES_PER_ELEMENT ?? 2));
  const Kind = kinds.find((Kind) => vertices < 2 ** (8 * Kind.BYTES_PER_ELEMENT)) ?? Uint32Array;
  return Kind.from(indices);
}

/** Disposes of accessors that nothing uses any more. */
export function disposeUnused(accessors: Iterable<Accessor | null>): void {
  for (const accessor of accessors) {
    // The document's root is always a parent.
    if (accessor && !accessor.isDisposed() && accessor.listParents().length === 1) accessor.dispose();
  }
}
