// What can go wrong on a device, as errors; reading back: the counterpart of crates/darboux-gpu/src/device/readback.rs.

import { USAGE } from './pipelines.js';

/** What to do without a device. */
export const ON_CPU = 'compute on the CPU (generateTangents of darboux)';

/** Errors: something else, as where there is no adapter. */
export function checkDevice(device: GPUDevice): void {
  if (Object.prototype.toString.call(device) === '[object GPUDevice]') return;
  throw new TypeError('device must be a GPUDevice, as openDevice gives it');
}

const FILTERS = ['validation', 'internal', 'out-of-memory'] as const;

/**
 * What `work` gives, whose calls of the device say nothing where it refuses.
 *
 * @throws Error where the device has no memory left, or refused something; those of `work`.
 */
export async function guarded<T>(device: GPUDevice, work: () => T): Promise<Awaited<T>> {
  for (const filter of FILTERS) device.pushErrorScope(filter);
  // Scopes are closed before anybody else can work in them.
  let scopes: Promise<GPUError | null>[] = [];
  let done: T;
  try {
    done = work();
  } finally {
    scopes = FILTERS.map(() => device.popErrorScope().catch(() => null));
  }
  const [result, ...errors] = await Promise.all([done, ...scopes]);
  const error = errors.find((error) => error);
  if (error instanceof GPUOutOfMemoryError) throw new RangeError(`the GPU has not enough memory for this mesh: ${ON_CPU}`);
  if (error) throw new Error(`the GPU refused to work: ${error.message}`);
  return result as Awaited<T>;
}

/** Buffers of one call, destroyed after it: garbage collectors see little of them. */
export class Room {
  readonly #buffers: GPUBuffer[] = [];

  /** The device, but that the buffers that it makes are this room's. */
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

  /** Records a copy to read from. */
  copy(encoder: GPUCommandEncoder, source: GPUBuffer): GPUBuffer {
    const copy = this.device.createBuffer({ label: 'copy', size: source.size, usage: USAGE.MAP_READ | USAGE.COPY_DST });
    encoder.copyBufferToBuffer(source, 0, copy, 0, source.size);
    return copy;
  }

  leave(): void {
    for (const buffer of this.#buffers) buffer.destroy();
  }
}

/** Waits for what was submitted, then gives the words of a {@link Room.copy}. Errors: the device is lost. */
export async function read(copy: GPUBuffer): Promise<Uint32Array<ArrayBuffer>> {
  try {
    await copy.mapAsync(MODE_READ);
  } catch (cause) {
    throw new Error(`the GPU was lost: its driver was reset or it was removed; open another device, or ${ON_CPU}`, { cause });
  }
  return new Uint32Array(copy.getMappedRange().slice(0));
}

/** GPUMapMode.READ, which is there only where WebGPU is. */
const MODE_READ = 1;
