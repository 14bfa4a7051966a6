// Kernels of exact arithmetic list the items whose last bits the device's floats leave open. The native counterpart,
// crates/darboux-gpu/src/device/precision.rs, computes these items with a second kernel on integers. Software adapters of browsers take minutes to
// compile that kernel, so here the caller computes the listed items on the CPU.

import { BUFFER_USAGE, dispatchStep, filledBuffer, type Buffers, type Step } from './pipelines.js';

/** The binding number of the list. */
export const LIST_BINDING = 9;

/** The head of an empty list: an indirect dispatch of no workgroups, and the length 0. */
const EMPTY_HEAD = Uint32Array.of(0, 1, 1, 0);

/** The numbers of items that another kernel, or the CPU, computes. */
export interface ItemList {
  items: GPUBuffer;
  clear: Step;
  /** Records a copy of the length to a byte offset of `into`. */
  copyLength(encoder: GPUCommandEncoder, into: GPUBuffer, offset: number): void;
}

/** An empty list of at most `capacity` items. */
export function itemList(device: GPUDevice, label: string, capacity: number): ItemList {
  const usage = BUFFER_USAGE.STORAGE | BUFFER_USAGE.INDIRECT | BUFFER_USAGE.COPY_DST | BUFFER_USAGE.COPY_SRC;
  const items = device.createBuffer({ label, size: EMPTY_HEAD.byteLength + 4 * Math.max(capacity, 1), usage });
  const head = filledBuffer(device, 'empty_head', EMPTY_HEAD, BUFFER_USAGE.COPY_SRC);
  return {
    items,
    clear: (encoder) => encoder.copyBufferToBuffer(head, 0, items, 0, EMPTY_HEAD.byteLength),
    copyLength: (encoder, into, offset) => encoder.copyBufferToBuffer(items, 12, into, offset, 4),
  };
}

/** A kernel of exact arithmetic with its buffers. */
export interface ExactStep {
  record: Step;
  /** The items that the kernel left open. */
  unsure: GPUBuffer;
  /** Records a copy of the number of these items. */
  copyUnsureCount: ItemList['copyLength'];
}

export function exactStep(device: GPUDevice, kernel: GPUComputePipeline, buffers: Buffers, items: number): ExactStep {
  const unsure = itemList(device, 'unsure', items);
  const run = dispatchStep(device, kernel, { ...buffers, [LIST_BINDING]: unsure.items }, items);
  return { record: (encoder) => [unsure.clear, run].forEach((step) => step(encoder)), unsure: unsure.items, copyUnsureCount: unsure.copyLength };
}
