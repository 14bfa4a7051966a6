// `darboux/mikktspace`: the functions of the npm package mikktspace and of three.js's module of that name, over `darboux/tangents`.

import { ready } from './tangents.js';

export { generateTangents, ready } from './tangents.js';

/** True once `ready` has resolved. */
export let isReady = false;

// A caller that awaits `ready` gets its error; nobody else needs it.
ready.then(() => (isReady = true), () => {});

/** Does nothing, because nothing has to be released. Callers of three.js's module call it. */
export function dispose(): void {}
