// The page's side of the thread that computes.

import type { Call, Reply, Work } from './worker';

interface Waiting {
  resolve(result: unknown): void;
  reject(error: Error): void;
}

const waiting = new Map<number, Waiting>();
let calls = 0;

const worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });

worker.addEventListener('message', ({ data }: MessageEvent<Reply>) => {
  const { resolve, reject } = waiting.get(data.id)!;
  waiting.delete(data.id);
  if ('error' in data) reject(new Error(data.error));
  else resolve(data.result);
});

worker.addEventListener('error', (event) => {
  const error = new Error(event.message || 'the thread that computes cannot start');
  for (const { reject } of waiting.values()) reject(error);
  waiting.clear();
});

/** Calls a function of the thread. Errors: what it throws, as a sentence. */
export function call<K extends keyof Work>(name: K, ...args: Parameters<Work[K]>): Promise<Awaited<ReturnType<Work[K]>>> {
  const id = calls++;
  return new Promise((resolve, reject) => {
    waiting.set(id, { resolve: resolve as Waiting['resolve'], reject });
    worker.postMessage({ id, name, args } satisfies Call<K>);
  });
}
