// Runs lists of passes, which crates/darboux-gpu writes (src/mikktspace/passes.rs): the counterpart of its src/mikktspace/program.rs.

import { buffer, module, scanSteps, step, stepOverList, type Buffers, type Step } from './pipelines.js';
import { LIST, realStep } from './unsure-items.js';
import { buffers, type Domain, type Entry, type Pass, type Run } from 'darboux-gpu/passes';

/** How many there are. */
export interface Sizes {
  vertices: number;
  triangles: number;
}

/** Buffers by the names that passes know them by. */
export type Named = Record<string, GPUBuffer>;

/** Texts of kernels, by their names. */
type Kernels = Readonly<Record<string, readonly string[]>>;

/** What makes prefix sums. */
const SCAN = [{ kernel: 'scan', entry: 'scan' }, { kernel: 'scan', entry: 'add_sums' }] as const;

/** Entry points, each once. */
function entriesOf(passes: readonly Pass[]): Entry[] {
  const entries = passes.flatMap((pass): readonly Entry[] => {
    if ('clear' in pass) return [];
    if ('scan' in pass) return SCAN;
    return pass.unsure ? [pass, pass.unsure] : [pass];
  });
  return [...new Map(entries.map((entry) => [keyOf(entry), entry])).values()];
}

const keyOf = ({ kernel, entry }: Entry) => `${kernel} ${entry}`;

/** What to compile; each kernel has one shader. */
function descriptors(device: GPUDevice, kernels: Kernels, passes: readonly Pass[]): [key: string, GPUComputePipelineDescriptor][] {
  const entries = entriesOf(passes);
  const modules = new Map([...new Set(entries.map(({ kernel }) => kernel))].map((kernel) => [kernel, module(device, kernels[kernel]!)]));
  return entries.map((entry) => {
    const compute = { module: modules.get(entry.kernel)!, entryPoint: entry.entry };
    return [keyOf(entry), { label: keyOf(entry), layout: 'auto', compute }];
  });
}

/** Compiled passes. */
export class Program {
  readonly #passes: readonly Pass[];
  readonly #pipelines: Map<string, GPUComputePipeline>;

  private constructor(passes: readonly Pass[], pipelines: Iterable<readonly [string, GPUComputePipeline]>) {
    [this.#passes, this.#pipelines] = [passes, new Map(pipelines)];
  }

  /** Compiled when it is first used, or before: as the device likes. */
  static now(device: GPUDevice, kernels: Kernels, passes: readonly Pass[]): Program {
    const all = descriptors(device, kernels, passes);
    return new Program(passes, all.map(([key, descriptor]) => [key, device.createComputePipeline(descriptor)]));
  }

  /** Compiled while the page goes on. Errors: the device refuses a shader. */
  static async soon(device: GPUDevice, kernels: Kernels, passes: readonly Pass[]): Promise<Program> {
    const all = descriptors(device, kernels, passes);
    const pipelines = all.map(async ([key, descriptor]) => [key, await device.createComputePipelineAsync(descriptor)] as const);
    return new Program(passes, await Promise.all(pipelines));
  }

  /** What records the passes, after buffers that `named` lacks have been made there. Errors: RangeError for one that the device cannot bind. */
  on(device: GPUDevice, sizes: Sizes, named: Named): Step[] {
    const make = (name: string) => (named[name] ??= made(device, sizes, name));
    const bound = (run: Run): Buffers => Object.fromEntries(Object.entries(run.buffers).map(([binding, name]) => [binding, make(name)]));
    const pipeline = (entry: Entry) => this.#pipelines.get(keyOf(entry))!;
    return this.#passes.flatMap((pass): Step[] => {
      if ('clear' in pass) {
        const cleared = make(pass.clear);
        return [(encoder) => encoder.clearBuffer(cleared)];
      }
      const threads = count(sizes, pass.domain);
      if ('scan' in pass) return scanSteps(device, { scan: pipeline(SCAN[0]), addSums: pipeline(SCAN[1]) }, make(pass.scan), threads);
      if (!pass.unsure) return [step(device, pipeline(pass), bound(pass), threads)];
      const { record, list } = realStep(device, pipeline(pass), bound(pass), threads);
      return [record, stepOverList(device, pipeline(pass.unsure), { ...bound(pass.unsure), [LIST]: list }, list)];
    });
  }
}

function made(device: GPUDevice, sizes: Sizes, name: string): GPUBuffer {
  const [domain, words] = buffers[name]!;
  const length = words * count(sizes, domain);
  checkSize(device, name, 4 * length);
  return buffer(device, name, length);
}

/** Errors: a buffer that the device cannot make or bind. */
export function checkSize({ limits }: GPUDevice, what: string, bytes: number): void {
  const limit = Math.min(limits.maxStorageBufferBindingSize, limits.maxBufferSize);
  if (bytes <= limit) return;
  throw new RangeError(`the buffer of ${what} has ${bytes} bytes, the device binds ${limit} at most; ask for one with larger limits, or compute on the CPU`);
}

function count({ vertices, triangles }: Sizes, domain: Domain): number {
  switch (domain) {
    case 'mesh': return 1;
    case 'vertex': return vertices;
    case 'slot': return 2 ** (32 - Math.clz32(2 * vertices - 1));
    case 'triangle': return triangles;
    case 'corner': return 3 * triangles;
  }
}
