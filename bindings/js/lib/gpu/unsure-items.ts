// Kernels of exact arithmetic, which list what they are unsure of: the counterpart of crates/darboux-gpu/src/device/precision.rs, whose second kernels,
// on whole numbers, take software adapters of browsers minutes to compile. Here the caller has the CPU.

import { filled, step, USAGE, type Buffers, type Step } from './pipelines.js';

/** The binding of the list. */
export const LIST = 9;

/** An indirect dispatch of no groups, and an empty list. */
const NOTHING = Uint32Array.of(0, 1, 1, 0);

/** Items that a kernel leaves to others. */
export interface List {
  items: GPUBuffer;
  clear: Step;
  /** Records a copy of the number of items to a byte of `into`. */
  count(encoder: GPUCommandEncoder, into: GPUBuffer, offset: number): void;
}

/** Room for so many items. */
export function list(device: GPUDevice, label: string, room: number): List {
  const usage = USAGE.STORAGE | USAGE.INDIRECT | USAGE.COPY_DST | USAGE.COPY_SRC;
  const items = device.createBuffer({ label, size: NOTHING.byteLength + 4 * Math.max(room, 1), usage });
  const nothing = filled(device, 'nothing', NOTHING, USAGE.COPY_SRC);
  return {
    items,
    clear: (encoder) => encoder.copyBufferToBuffer(nothing, 0, items, 0, NOTHING.byteLength),
    count: (encoder, into, offset) => encoder.copyBufferToBuffer(items, 12, into, offset, 4),
  };
}

/** Such a kernel with its buffers. */
export interface RealStep {
  record: Step;
  /** The items that it was unsure of. */
  list: GPUBuffer;
  /** Records a copy of their number. */
  count: List['count'];
}

export function realStep(device: GPUDevice, kernel: GPUComputePipeline, buffers: Buffers, items: number): RealStep {
  const unsure = list(device, 'unsure', items);
  const run = step(device, kernel, { ...buffers, [LIST]: unsure.items }, items);
  return { record: (encoder) => [unsure.clear, run].forEach((step) => step(encoder)), list: unsure.items, count: unsure.count };
}
