// The page's side of a worker thread: calls functions of the worker.

import type { Call, Functions, Progress, Reply } from './calls';

/** A call without a reply yet. */
interface PendingCall {
  resolve(result: unknown): void;
  reject(error: Error): void;
}

/** Calls a function of a worker. Errors: those of the function. */
export type Caller<F extends Functions> = <K extends keyof F & string>(name: K, ...args: Parameters<F[K]>) => Promise<Awaited<ReturnType<F[K]>>>;

/** Ends a worker. Its running calls fail with the reason. */
export function endWorker(worker: Worker, reason: string): void {
  worker.terminate();
  worker.dispatchEvent(new ErrorEvent('error', { message: reason }));
}

/** Connects a worker with the functions `F`. `progress` receives the finished part of the running call, where the worker tells it. */
export function callerOf<F extends Functions>(worker: Worker, progress?: (done: number) => void): Caller<F> {
  const pending = new Map<number, PendingCall>();
  let callCount = 0;
  worker.addEventListener('message', ({ data }: MessageEvent<Reply | Progress>) => {
    if ('progress' in data) return progress?.(data.progress);
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
  return (name, ...args) => {
    const id = callCount++;
    return new Promise((resolve, reject) => {
      pending.set(id, { resolve: resolve as PendingCall['resolve'], reject });
      worker.postMessage({ id, name, args } satisfies Call);
    });
  };
}
