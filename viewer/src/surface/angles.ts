// The angles between two sets of tangents.

/** In place of an angle where a tangent is zero or not finite. */
export const NO_ANGLE = -1;

/** In place of an angle at the corners of a face where the signs differ. */
export const FLIPPED = 1000;

/** The angle in degrees between the tangents of each corner, whatever their signs, or {@link NO_ANGLE}. `darboux compare` reports the same. */
export function cornerAngles(a: Float32Array, b: Float32Array): Float32Array<ArrayBuffer> {
  return Float32Array.from({ length: a.length / 4 }, (_, corner) => angle(a, b, corner * 4));
}

/** Like {@link cornerAngles}, with {@link FLIPPED} at all corners of a face with different signs at any corner. */
export function angles(a: Float32Array, b: Float32Array): Float32Array<ArrayBuffer> {
  const out = cornerAngles(a, b);
  for (let face = 0; face < out.length; face += 3) {
    const differs = [0, 1, 2].some((i) => a[(face + i) * 4 + 3] * b[(face + i) * 4 + 3] < 0);
    if (differs) out.fill(FLIPPED, face, face + 3);
  }
  return out;
}

/** The angle between two vectors, by atan2, which is accurate near 0 and 180 degrees. */
function angle(a: Float32Array, b: Float32Array, at: number): number {
  const [ax, ay, az] = [a[at], a[at + 1], a[at + 2]];
  const [bx, by, bz] = [b[at], b[at + 1], b[at + 2]];
  const sine = Math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
  const cosine = ax * bx + ay * by + az * bz;
  const radians = Math.atan2(sine, cosine);
  return sine === 0 && cosine === 0 || !Number.isFinite(radians) ? NO_ANGLE : (radians * 180) / Math.PI;
}
