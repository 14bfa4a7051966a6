// `darboux/mikktspace`: what the npm package mikktspace has, and three.js's module of that name.

import { ready } from './tangents.js';

export { generateTangents, ready } from './tangents.js';

/** Whether `ready` has resolved. */
export let isReady = false;

// Who awaits `ready` hears of what goes wrong.
ready.then(() => (isReady = true), () => {});

/** Does nothing, as there is nothing to release: for callers of three.js's module. */
export function dispose(): void {}
