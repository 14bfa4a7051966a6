// Operations on vectors of three numbers.

export type Vector = [number, number, number];

export function cross(a: Vector, b: Vector): Vector {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function dot(a: Vector, b: Vector): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** The vectors from the first corner of a triangle to the other two. Components from `width` on are 0. */
export function edges(array: Float32Array, width: number, indices: Uint32Array, face: number): [Vector, Vector] {
  const between = (corner: number): Vector => {
    const edge: Vector = [0, 0, 0];
    for (let i = 0; i < width; i++) edge[i] = array[indices[corner] * width + i] - array[indices[face] * width + i];
    return edge;
  };
  return [between(face + 1), between(face + 2)];
}
