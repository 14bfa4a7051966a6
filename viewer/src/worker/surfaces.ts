// The thread that computes what the page draws.

import { callerOf } from './client';
import type { WorkerFunctions } from './worker';

export const call = callerOf<WorkerFunctions>(new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' }));
