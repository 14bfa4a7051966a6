// The camera's way to a place.

import { Vector3 } from 'three';

/** Milliseconds. */
const DURATION = 600;

/** Where a camera is, and what it looks at. */
export interface View {
  eye: Vector3;
  target: Vector3;
}

/** Leads from one view to another, frame by frame; at once where motion is not wanted. Gives a way to stop it. */
export function fly(from: View, to: View, move: (view: View) => void): () => void {
  if (matchMedia('(prefers-reduced-motion: reduce)').matches) {
    move(to);
    return () => {};
  }
  const start = performance.now();
  let frame = 0;
  const step = (now: number) => {
    const done = Math.min(1, Math.max(0, (now - start) / DURATION));
    const eased = done * done * (3 - 2 * done);
    const between = (a: Vector3, b: Vector3) => new Vector3().lerpVectors(a, b, eased);
    move({ eye: between(from.eye, to.eye), target: between(from.target, to.target) });
    if (done < 1) frame = requestAnimationFrame(step);
  };
  frame = requestAnimationFrame(step);
  return () => cancelAnimationFrame(frame);
}
