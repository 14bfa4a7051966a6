// Compute pipelines, buffers, dispatches and prefix sums. The native counterpart is crates/darboux-gpu/src/device/kernel.rs.

import { constants } from 'darboux-gpu/passes';

const { WORKGROUP, VALUES_PER_THREAD, BLOCK } = constants;

/** GPUBufferUsage. The global exists only where WebGPU does. */
export const BUFFER_USAGE = { MAP_READ: 1, COPY_SRC: 4, COPY_DST: 8, UNIFORM: 64, STORAGE: 128, INDIRECT: 256 } as const;

/** A shader module of concatenated source files. */
export function shaderModule(device: GPUDevice, files: readonly string[]): GPUShaderModule {
  const declarations = Object.entries(constants).map(([name, value]) => `const ${name}: u32 = ${value}u;\n`);
  return device.createShaderModule({ label: 'darboux', code: [...declarations, files.join('\n')].join('') });
}

/** The pipeline of one entry point. */
export function computePipeline(device: GPUDevice, module: GPUShaderModule, entryPoint: string): GPUComputePipeline {
  return device.createComputePipeline({ label: entryPoint, layout: 'auto', compute: { module, entryPoint } });
}

/** A storage buffer of 32-bit words that shaders fill. */
export function storageBuffer(device: GPUDevice, label: string, words: number): GPUBuffer {
  const usage = BUFFER_USAGE.STORAGE | BUFFER_USAGE.COPY_DST | BUFFER_USAGE.COPY_SRC;
  return device.createBuffer({ label, size: 4 * Math.max(words, 1), usage });
}

/** A buffer that holds these words. */
export function filledBuffer(device: GPUDevice, label: string, words: Uint32Array, usage: number = BUFFER_USAGE.STORAGE): GPUBuffer {
  const result = device.createBuffer({ label, size: Math.max(words.byteLength, 4), usage, mappedAtCreation: true });
  new Uint32Array(result.getMappedRange()).set(words);
  result.unmap();
  return result;
}

/** Records a compute pass of one dispatch, or a copy. */
export type Step = (encoder: GPUCommandEncoder) => void;

/** Buffers by binding number. */
export type Buffers = Record<number, GPUBuffer>;

/** Dispatches at least `threads` threads. The shader returns at once in surplus threads. */
export function dispatchStep(device: GPUDevice, pipeline: GPUComputePipeline, buffers: Buffers, threads: number): Step {
  const groups = Math.ceil(threads / WORKGROUP);
  const row = Math.min(Math.max(groups, 1), device.limits.maxComputeWorkgroupsPerDimension);
  return recorded(device, pipeline, buffers, (pass) => pass.dispatchWorkgroups(row, Math.ceil(groups / row)));
}

/** Dispatches one thread per item of a list, as many as the list holds when the device reaches the step. */
export function indirectStep(device: GPUDevice, pipeline: GPUComputePipeline, buffers: Buffers, list: GPUBuffer): Step {
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
export interface ScanPipelines {
  scan: GPUComputePipeline;
  addSums: GPUComputePipeline;
}

/** The steps of an exclusive prefix sum of `count` values, in place: blocks, then the sums of blocks recursively, then their addition. */
export function scanSteps(device: GPUDevice, pipelines: ScanPipelines, values: GPUBuffer, count: number): Step[] {
  const blocks = Math.ceil(count / BLOCK);
  const sumOfBlock = storageBuffer(device, 'sum_of_block', blocks);
  const threads = Math.ceil(count / VALUES_PER_THREAD);
  const buffers = { 0: values, 1: sumOfBlock };
  const first = dispatchStep(device, pipelines.scan, buffers, threads);
  if (blocks <= 1) return [first];
  return [first, ...scanSteps(device, pipelines, sumOfBlock, blocks), dispatchStep(device, pipelines.addSums, buffers, threads)];
}
