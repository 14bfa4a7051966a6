// Accessors as arrays, and back.

import type { Accessor, TypedArray } from '@gltf-transform/core';

/** The values of an accessor; quantised ones are what they stand for. Errors: another number of elements than vertices. */
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

/** An accessor with the elements of their sources. */
export function gathered(accessor: Accessor, sources: Uint32Array): Accessor {
  const [array, width] = [accessor.getArray()!, accessor.getElementSize()];
  const result = new (array.constructor as Float32ArrayConstructor)(width * sources.length);
  sources.forEach((source, at) => {
    for (let component = 0; component < width; component++) result[width * at + component] = array[width * source + component]!;
  });
  return accessor.clone().setArray(result);
}

/** Indices in the numbers of the old ones if the vertices do not outgrow them; the largest number is reserved. */
export function indexArray(indices: Uint32Array<ArrayBuffer>, vertices: number, old: TypedArray | null | undefined): TypedArray {
  const kinds = [Uint8Array, Uint16Array, Uint32Array].filter((Kind) => Kind.BYTES_PER_ELEMENT >= (old?.BYTES_PER_ELEMENT ?? 2));
  const Kind = kinds.find((Kind) => vertices < 2 ** (8 * Kind.BYTES_PER_ELEMENT)) ?? Uint32Array;
  return Kind.from(indices);
}

/** Removes accessors that nothing uses any more. */
export function disposeUnused(accessors: Iterable<Accessor | null>): void {
  for (const accessor of accessors) {
    // The root is one parent.
    if (accessor && !accessor.isDisposed() && accessor.listParents().length === 1) accessor.dispose();
  }
}
