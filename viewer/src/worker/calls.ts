// Calls of functions in a worker thread: the messages, and the worker's side.

/** Functions that the page can call. */
export type Functions = Record<string, (...args: never[]) => unknown>;

/** A call of a function, with a number that the reply repeats. */
export interface Call {
  id: number;
  name: string;
  args: unknown[];
}

/** The reply to a call: a result, or the message of an error. */
export type Reply = { id: number; result: unknown } | { id: number; error: string };

/** The finished part of the running call, from 0 to 1. */
export interface Progress {
  progress: number;
}

/** Answers the page's calls, once `ready` has resolved. Buffers in results are transferred, except those in `kept`. */
export function answer(functions: Functions, ready: Promise<unknown>, kept: () => unknown = () => null): void {
  addEventListener('message', async ({ data }: MessageEvent<Call>) => {
    const { id, name, args } = data;
    try {
      await ready;
      const result = await (functions[name] as (...args: unknown[]) => unknown)(...args);
      const stay = transferables(kept());
      const transfer = [...transferables(result)].filter((one) => !stay.has(one));
      postMessage({ id, result } satisfies Reply, { transfer });
    } catch (error) {
      postMessage({ id, error: error instanceof Error ? error.message : String(error) } satisfies Reply);
    }
  });
}

/** Tells the page the finished part of the running call, from 0 to 1. */
export function tellProgress(progress: number): void {
  postMessage({ progress } satisfies Progress);
}

/** The buffers of all arrays, and all images. */
function transferables(value: unknown, found = new Set<Transferable>()): Set<Transferable> {
  if (ArrayBuffer.isView(value)) found.add(value.buffer as ArrayBuffer);
  else if (value instanceof ImageBitmap) found.add(value);
  else if (value && typeof value === 'object') for (const member of Object.values(value)) transferables(member, found);
  return found;
}
