// Compute pipelines, and how many groups of threads they need: the counterpart of crates/darboux-gpu/src/device/kernel.rs.

import { constants } from 'darboux-gpu/passes';

const { WORKGROUP, VALUES_PER_THREAD, BLOCK } = constants;

/** GPUBufferUsage, which is there only where WebGPU is. */
export const USAGE = { MAP_READ: 1, COPY_SRC: 4, COPY_DST: 8, UNIFORM: 64, STORAGE: 128, INDIRECT: 256 } as const;

/** A shader of files that are read one after the other. */
export function module(device: GPUDevice, files: readonly string[]): GPUShaderModule {
  const sizes = Object.entries(constants).map(([name, value]) => `const ${name}: u32 = ${value}u;\n`);
  return device.createShaderModule({ label: 'darboux', code: [...sizes, files.join('\n')].join('') });
}

/** One entry point of a shader. */
export function pipeline(device: GPUDevice, module: GPUShaderModule, entryPoint: string): GPUComputePipeline {
  return device.createComputePipeline({ label: entryPoint, layout: 'auto', compute: { module, entryPoint } });
}

/** A buffer of words that shaders fill. */
export function buffer(device: GPUDevice, label: string, words: number): GPUBuffer {
  const usage = USAGE.STORAGE | USAGE.COPY_DST | USAGE.COPY_SRC;
  return device.createBuffer({ label, size: 4 * Math.max(words, 1), usage });
}

/** A buffer with these words. */
export function filled(device: GPUDevice, label: string, words: Uint32Array, usage: number = USAGE.STORAGE): GPUBuffer {
  const result = device.createBuffer({ label, size: Math.max(words.byteLength, 4), usage, mappedAtCreation: true });
  new Uint32Array(result.getMappedRange()).set(words);
  result.unmap();
  return result;
}

/** Records a pipeline with its buffers, by binding, as a pass of its own. */
export type Step = (encoder: GPUCommandEncoder) => void;

/** Buffers by binding. */
export type Buffers = Record<number, GPUBuffer>;

/** A step of at least `threads` threads; the shader turns others away. */
export function step(device: GPUDevice, pipeline: GPUComputePipeline, buffers: Buffers, threads: number): Step {
  const groups = Math.ceil(threads / WORKGROUP);
  const row = Math.min(Math.max(groups, 1), device.limits.maxComputeWorkgroupsPerDimension);
  return recorded(device, pipeline, buffers, (pass) => pass.dispatchWorkgroups(row, Math.ceil(groups / row)));
}

/** A step over what is listed, as many as these are then. */
export function stepOverList(device: GPUDevice, pipeline: GPUComputePipeline, buffers: Buffers, list: GPUBuffer): Step {
  return recorded(device, pipeline, buffers, (pass) => pass.dispatchWorkgroupsIndirect(list, 0));
}

function recorded(device: GPUDevice, pipeline: GPUComputePipeline, buffers: Buffers, dispatch: (pass: GPUComputePassEncoder) => void): Step {
  const entries = Object.entries(buffers).map(([binding, buffer]) => ({ binding: Number(binding), resource: { buffer } }));
  const group = device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });
  return (encoder) => {
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    dispatch(pass);
    pass.end();
  };
}

/** The pipelines of a prefix sum. */
export interface Scan {
  scan: GPUComputePipeline;
  addSums: GPUComputePipeline;
}

/** Steps that make every one of `count` values the sum of those before it. */
export function scanSteps(device: GPUDevice, kernels: Scan, values: GPUBuffer, count: number): Step[] {
  const blocks = Math.ceil(count / BLOCK);
  const sumOfBlock = buffer(device, 'sum_of_block', blocks);
  const threads = Math.ceil(count / VALUES_PER_THREAD);
  const buffers = { 0: values, 1: sumOfBlock };
  const first = step(device, kernels.scan, buffers, threads);
  if (blocks <= 1) return [first];
  return [first, ...scanSteps(device, kernels, sumOfBlock, blocks), step(device, kernels.addSums, buffers, threads)];
}
