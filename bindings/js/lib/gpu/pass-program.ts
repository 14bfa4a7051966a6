// Compiles and binds lists of compute passes. crates/darboux-gpu writes the lists (shaders/passes.json); its own runner is
// src/mikktspace/program.rs.

import { dispatchStep, indirectStep, scanSteps, shaderModule, storageBuffer, type Buffers, type Step } from './pipelines.js';
import { exactStep, LIST_BINDING } from './unsure-items.js';
import { buffers, type Domain, type Entry, type Pass, type Run } from 'darboux-gpu/passes';

/** The size of a mesh. */
export interface Sizes {
  vertices: number;
  triangles: number;
}

/** Buffers by the names that the list of passes uses. */
export type NamedBuffers = Record<string, GPUBuffer>;

/** The source files of each kernel, by its name. */
type KernelSources = Readonly<Record<string, readonly string[]>>;

/** The entry points of a prefix sum. */
const SCAN = [{ kernel: 'scan', entry: 'scan' }, { kernel: 'scan', entry: 'add_sums' }] as const;

/** The distinct entry points of passes. */
function entriesOf(passes: readonly Pass[]): Entry[] {
  const entries = passes.flatMap((pass): readonly Entry[] => {
    if ('clear' in pass) return [];
    if ('scan' in pass) return SCAN;
    return pass.unsure ? [pass, pass.unsure] : [pass];
  });
  return [...new Map(entries.map((entry) => [keyOf(entry), entry])).values()];
}

const keyOf = ({ kernel, entry }: Entry) => `${kernel} ${entry}`;

/** A pipeline descriptor per entry point; a shader module per kernel. */
function descriptors(device: GPUDevice, kernels: KernelSources, passes: readonly Pass[]): [key: string, GPUComputePipelineDescriptor][] {
  const entries = entriesOf(passes);
  const modules = new Map([...new Set(entries.map(({ kernel }) => kernel))].map((kernel) => [kernel, shaderModule(device, kernels[kernel]!)]));
  return entries.map((entry) => {
    const compute = { module: modules.get(entry.kernel)!, entryPoint: entry.entry };
    return [keyOf(entry), { label: keyOf(entry), layout: 'auto', compute }];
  });
}

/** Compiled passes. */
export class PassProgram {
  readonly #passes: readonly Pass[];
  readonly #pipelines: Map<string, GPUComputePipeline>;

  private constructor(passes: readonly Pass[], pipelines: Iterable<readonly [string, GPUComputePipeline]>) {
    [this.#passes, this.#pipelines] = [passes, new Map(pipelines)];
  }

  /** Returns at once. The device compiles the shaders no later than at their first use. */
  static compileLazily(device: GPUDevice, kernels: KernelSources, passes: readonly Pass[]): PassProgram {
    const all = descriptors(device, kernels, passes);
    return new PassProgram(passes, all.map(([key, descriptor]) => [key, device.createComputePipeline(descriptor)]));
  }

  /** Compiles in the background. Errors: the device refuses a shader. */
  static async compile(device: GPUDevice, kernels: KernelSources, passes: readonly Pass[]): Promise<PassProgram> {
    const all = descriptors(device, kernels, passes);
    const pipelines = all.map(async ([key, descriptor]) => [key, await device.createComputePipelineAsync(descriptor)] as const);
    return new PassProgram(passes, await Promise.all(pipelines));
  }

  /** Binds the passes to buffers and adds the missing buffers to `named`. Errors: RangeError for a buffer that the device cannot bind. */
  bind(device: GPUDevice, sizes: Sizes, named: NamedBuffers): Step[] {
    const bufferOf = (name: string) => (named[name] ??= newBuffer(device, sizes, name));
    const bound = (run: Run): Buffers => Object.fromEntries(Object.entries(run.buffers).map(([binding, name]) => [binding, bufferOf(name)]));
    const pipeline = (entry: Entry) => this.#pipelines.get(keyOf(entry))!;
    return this.#passes.flatMap((pass): Step[] => {
      if ('clear' in pass) {
        const cleared = bufferOf(pass.clear);
        return [(encoder) => encoder.clearBuffer(cleared)];
      }
      const threads = countOf(sizes, pass.domain);
      if ('scan' in pass) return scanSteps(device, { scan: pipeline(SCAN[0]), addSums: pipeline(SCAN[1]) }, bufferOf(pass.scan), threads);
      if (!pass.unsure) return [dispatchStep(device, pipeline(pass), bound(pass), threads)];
      const { record, unsure } = exactStep(device, pipeline(pass), bound(pass), threads);
      return [record, indirectStep(device, pipeline(pass.unsure), { ...bound(pass.unsure), [LIST_BINDING]: unsure }, unsure)];
    });
  }
}

function newBuffer(device: GPUDevice, sizes: Sizes, name: string): GPUBuffer {
  const [domain, words] = buffers[name]!;
  const length = words * countOf(sizes, domain);
  checkBufferSize(device, name, 4 * length);
  return storageBuffer(device, name, length);
}

/** Errors: a buffer that the device cannot create or bind. */
export function checkBufferSize({ limits }: GPUDevice, name: string, bytes: number): void {
  const limit = Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize);
  if (bytes <= limit) return;
  throw new RangeError(`the buffer of ${name} needs ${bytes} bytes but the device binds ${limit} at most; request a device with larger limits, or compute on the CPU`);
}

function countOf({ vertices, triangles }: Sizes, domain: Domain): number {
  switch (domain) {
    case 'mesh': return 1;
    case 'vertex': return vertices;
    case 'slot': return 2 ** (32 - Math.clz32(2 * vertices - 1));
    case 'triangle': return triangles;
    case 'corner': return 3 * triangles;
  }
}
