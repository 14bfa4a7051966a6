// Errors of a device as exceptions, buffers that live for one call, and reading back. The native counterpart is crates/darboux-gpu/src/device/readback.rs.

import { BUFFER_USAGE } from './pipelines.js';

/** The advice of messages where no device works. */
export const USE_CPU = 'compute on the CPU (generateTangents of darboux)';

/** Errors: the argument is not a device. */
export function checkDevice(device: GPUDevice): void {
  if (Object.prototype.toString.call(device) === '[object GPUDevice]') return;
  throw new TypeError('device must be a GPUDevice, as openDevice returns it');
}

const FILTERS = ['validation', 'internal', 'out-of-memory'] as const;

/**
 * Runs `work` and waits for its result. Calls of a device do not throw, so error scopes catch what the device reports.
 *
 * @throws RangeError where the device has not enough memory; Error where it refused a call; the errors of `work`.
 */
export async function reportingErrors<T>(device: GPUDevice, work: () => T): Promise<Awaited<T>> {
  for (const filter of FILTERS) device.pushErrorScope(filter);
  // The scopes are closed in the same task, so that no other call runs inside them.
  let scopes: Promise<GPUError | null>[] = [];
  let done: T;
  try {
    done = work();
  } finally {
    scopes = FILTERS.map(() => device.popErrorScope().catch(() => null));
  }
  const [result, ...errors] = await Promise.all([done, ...scopes]);
  const error = errors.find((error) => error);
  if (error instanceof GPUOutOfMemoryError) throw new RangeError(`the GPU has not enough memory for this mesh: ${USE_CPU}`);
  if (error) throw new Error(`the GPU refused to work: ${error.message}`);
  return result as Awaited<T>;
}

/** The buffers of one call. They are destroyed after it, because a garbage collector does not know how large they are. */
export class CallBuffers {
  readonly #buffers: GPUBuffer[] = [];

  /** The device. Buffers that are created through it belong to this call. */
  readonly device: GPUDevice;

  constructor(device: GPUDevice) {
    const createBuffer = (descriptor: GPUBufferDescriptor) => {
      const made = device.createBuffer(descriptor);
      this.#buffers.push(made);
      return made;
    };
    const get = (_: GPUDevice, key: keyof GPUDevice) => {
      if (key === 'createBuffer') return createBuffer;
      const value = device[key];
      return typeof value === 'function' ? value.bind(device) : value;
    };
    this.device = new Proxy(device, { get: get as ProxyHandler<GPUDevice>['get'] & {} });
  }

  /** Records a copy of a buffer into a new buffer that can be read. */
  copy(encoder: GPUCommandEncoder, source: GPUBuffer): GPUBuffer {
    const copy = this.device.createBuffer({ label: 'copy', size: source.size, usage: BUFFER_USAGE.MAP_READ | BUFFER_USAGE.COPY_DST });
    encoder.copyBufferToBuffer(source, 0, copy, 0, source.size);
    return copy;
  }

  destroy(): void {
    for (const buffer of this.#buffers) buffer.destroy();
  }
}

/** Waits for the submitted commands, then returns the words of a {@link CallBuffers.copy}. Errors: the device is lost. */
export async function readBuffer(copy: GPUBuffer): Promise<Uint32Array<ArrayBuffer>> {
  try {
    await copy.mapAsync(MODE_READ);
  } catch (cause) {
    throw new Error(`the GPU was lost: its driver was reset or it was removed; open another device, or ${USE_CPU}`, { cause });
  }
  return new Uint32Array(copy.getMappedRange().slice(0));
}

/** GPUMapMode.READ. The global exists only where WebGPU does. */
const MODE_READ = 1;
