// The page's side of the thread of the check.

import { callerOf, type Caller } from '../worker/client';
import type { CheckerFunctions } from './checker';

let caller: Caller<CheckerFunctions> | undefined;

/** Calls a function of checker.ts. The thread starts with the first call, so that it does not delay the first picture. */
export const checker: Caller<CheckerFunctions> = (name, ...args) => {
  caller ??= callerOf<CheckerFunctions>(new Worker(new URL('./checker.ts', import.meta.url), { type: 'module' }));
  return caller(name, ...args);
};
