// How far two sets of tangents are apart.

/** Stands for an angle where one of the two is zero or not finite. */
export const NO_ANGLE = -1;

/** Stands for an angle on faces where the signs of the two differ. */
export const FLIPPED = 1000;

/** Degrees between the directions of each corner's tangents, or one of the above. */
export function angles(a: Float32Array, b: Float32Array): Float32Array<ArrayBuffer> {
  const out = new Float32Array(a.length / 4);
  for (let corner = 0; corner < out.length; corner++) out[corner] = angle(a, b, corner * 4);
  for (let face = 0; face < out.length; face += 3) {
    const differs = [0, 1, 2].some((i) => a[(face + i) * 4 + 3] * b[(face + i) * 4 + 3] < 0);
    if (differs) out.fill(FLIPPED, face, face + 3);
  }
  return out;
}

/** The angle between the vectors at a place. As atan2, which is exact at both ends. */
function angle(a: Float32Array, b: Float32Array, at: number): number {
  const [ax, ay, az] = [a[at], a[at + 1], a[at + 2]];
  const [bx, by, bz] = [b[at], b[at + 1], b[at + 2]];
  const sine = Math.hypot(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx);
  const cosine = ax * bx + ay * by + az * bz;
  const radians = Math.atan2(sine, cosine);
  return sine === 0 && cosine === 0 || !Number.isFinite(radians) ? NO_ANGLE : (radians * 180) / Math.PI;
}
