// Motions of the page, which a press, a key or a wish for less motion ends.

/** Whether the system asks for less motion. */
export function isStill(): boolean {
  return matchMedia('(prefers-reduced-motion: reduce)').matches;
}

/** Calls `step` with the finished part of a motion, from 0 to 1, and resolves at its end: true, or false where somebody pressed or typed something. */
export function move(milliseconds: number, step: (done: number) => void): Promise<boolean> {
  return new Promise((resolve) => {
    const [start, stop] = [performance.now(), new AbortController()];
    const end = (isWhole: boolean) => {
      stop.abort();
      resolve(isWhole);
    };
    for (const event of ['pointerdown', 'keydown', 'wheel']) document.addEventListener(event, () => end(false), { signal: stop.signal, capture: true, passive: true });
    const frame = (now: number) => {
      if (stop.signal.aborted) return;
      const done = Math.min(1, Math.max(0, (now - start) / milliseconds));
      step(done);
      if (done < 1) requestAnimationFrame(frame);
      else end(true);
    };
    requestAnimationFrame(frame);
  });
}
