// The page's side of the worker thread: calls functions of worker.ts.

import type { Call, Reply, WorkerFunctions } from './worker';

/** A call without a reply yet. */
interface PendingCall {
  resolve(result: unknown): void;
  reject(error: Error): void;
}

const pending = new Map<number, PendingCall>();
let callCount = 0;

const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });

worker.addEventListener('message', ({ data }: MessageEvent<Reply>) => {
  const { resolve, reject } = pending.get(data.id)!;
  pending.delete(data.id);
  if ('error' in data) reject(new Error(data.error));
  else resolve(data.result);
});

worker.addEventListener('error', (event) => {
  const error = new Error(event.message || 'the worker thread cannot start');
  for (const { reject } of pending.values()) reject(error);
  pending.clear();
});

/** Calls a function of the worker. Errors: those of the function. */
export function call<K extends keyof WorkerFunctions>(name: K, ...args: Parameters<WorkerFunctions[K]>): Promise<Awaited<ReturnType<WorkerFunctions[K]>>> {
  const id = callCount++;
  return new Promise((resolve, reject) => {
    pending.set(id, { resolve: resolve as PendingCall['resolve'], reject });
    worker.postMessage({ id, name, args } satisfies Call<K>);
  });
}
