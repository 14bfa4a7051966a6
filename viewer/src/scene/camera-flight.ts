// Animates the camera from one view to another.

import { Vector3 } from 'three';

/** The duration in milliseconds. */
const DURATION = 600;

/** The position of a camera and the point that it looks at. */
export interface View {
  eye: Vector3;
  target: Vector3;
}

/** Calls `move` every frame, or once where the user prefers reduced motion. Returns a function that stops the animation. */
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
