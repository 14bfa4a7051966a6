// `darboux/webgpu`: MikkTSpace, plans and the method 'average' on WebGPU.

import kernels from 'darboux-gpu/kernels';
import { adjacency } from 'darboux-gpu/passes';
import { checkRows, reach } from './gpu/buffer-checks.js';
import { ON_CPU } from './gpu/device.js';
import { buffer, module, pipeline, step, USAGE, type Step } from './gpu/pipelines.js';
import { Program, type Named } from './gpu/pass-program.js';
import type { GpuTangentOptions, GpuTangents, Indices } from './types.js';

export { GpuPlan, Planner, PlanOfBuffers } from './gpu/planner.js';
export type { GpuAttribute, GpuMovingMesh } from './gpu/planner.js';
export type * from './types.js';

/**
 * The shaders of plans and of 'average' as data, each of texts that are read one after the other, after the constants WORKGROUP,
 * VALUES_PER_THREAD, BLOCK, MAX_GROUPS and MAX_ITERATIONS.
 */
export const shaders: Readonly<Record<'adjacency' | 'average' | 'scan' | 'terms' | 'gather' | 'repair' | 'write', readonly string[]>> = kernels;

/**
 * A device of the adapter that the browser takes for the fastest, which binds as large buffers as that allows.
 *
 * @throws Error where there is no WebGPU, or no adapter.
 */
export async function openDevice(): Promise<GPUDevice> {
  const gpu = globalThis.navigator?.gpu;
  if (!gpu) throw new Error(`there is no WebGPU here: use a browser that has it, from https or localhost, or ${ON_CPU}`);
  const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
  if (!adapter) throw new Error(`no GPU adapter was found: install a driver, or ${ON_CPU}`);
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

/**
 * The tangent of every corner, as `generateTangents` of `darboux`, bit for bit: the device welds, finds neighbours and groups and evaluates; what is
 * rare, and what the device's floats leave open, the CPU does.
 *
 * The shaders, and `darboux` with its WebAssembly, are loaded by the first call and compiled by the first call for a device.
 *
 * @param device As {@link openDevice} gives it, or one of yours: its limits decide how large meshes may be.
 * @returns 4 per corner. Other parameters as there; the arrays must stay as they are until then.
 * @throws TypeError and RangeError as there; RangeError for a mesh past the device's limits or memory; Error where the device is lost or refuses.
 */
export function generateTangents(
  device: GPUDevice,
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: Indices | null,
  options?: GpuTangentOptions & { returnReport?: false },
): Promise<Float32Array<ArrayBuffer>>;
/** As above, with the report of the run, and what the CPU did. */
export function generateTangents(
  device: GPUDevice,
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: Indices | null | undefined,
  options: GpuTangentOptions & { returnReport: true },
): Promise<GpuTangents>;
export async function generateTangents(
  device: GPUDevice,
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: Indices | null,
  options: GpuTangentOptions & { returnReport?: boolean } = {},
): Promise<Float32Array<ArrayBuffer> | GpuTangents> {
  const { generateTangents } = await import('./webgpu.tangents.js');
  const made = await generateTangents(device, positions, normals, uvs, indices, options);
  return options.returnReport ? made : made.tangents;
}

/** Vertices and indices on the GPU. Offsets and strides count bytes and are multiples of 4; buffers have the usage STORAGE. */
export interface GpuMesh {
  vertices: GPUBuffer;
  vertexCount: number;
  /** From vertex to vertex. */
  stride: number;
  /** Offsets of three floats, three floats and two floats. */
  position: number;
  normal: number;
  uv: number;
  indices: GPUBuffer;
  indexFormat: GPUIndexFormat;
  /** Counted in indices. Default: 0. */
  firstIndex?: number;
  indexCount: number;
}

/** Where frames go: a buffer of their own, with the usage STORAGE. */
export interface GpuFrames {
  buffer: GPUBuffer;
  stride: number;
  /** The offset of three floats, unit length. */
  tangent: number;
  /** The offset of three floats, unit length, if wanted. */
  bitangent?: number;
  /** The offset of one float, +1 or -1, if wanted. */
  sign?: number;
}

/**
 * The method 'average' of `darboux` per vertex, compiled for a device: the mean of the adjacent triangles' unit tangents.
 *
 * Where both UV orientations meet, the CPU splits a vertex; here it has the frame of the orientation with more triangles, and is counted:
 * split such vertices first. The sign is that of the UVs as given. Sums are the CPU's; divisions and roots are the device's, so that the last bits are.
 */
export class Average {
  readonly #device: GPUDevice;
  readonly #table: Program;
  readonly #gather: GPUComputePipeline;

  constructor(device: GPUDevice) {
    this.#device = device;
    this.#table = Program.now(device, shaders, adjacency);
    this.#gather = pipeline(device, module(device, shaders.average), 'gather');
  }

  /** Makes what recording needs. Errors: RangeError for indices that are not whole triangles, places that are not whole words or past their buffer. */
  ofMesh(mesh: GpuMesh, frames: GpuFrames): AverageOfMesh {
    check(mesh, frames);
    const device = this.#device;
    const { vertexCount, indices } = mesh;
    const words = describe(device, mesh, frames);
    const counts = buffer(device, 'counts', 3);
    const named: Named = { mesh: words, vertex_of_corner: indices };
    const table = this.#table.on(device, { vertices: vertexCount, triangles: mesh.indexCount / 3 }, named);
    const [ends, entries] = [named.ends!, named.triangle_of_entry!];
    const gathering = { 0: words, 1: indices, 2: mesh.vertices, 3: frames.buffer, 4: counts, 5: ends, 6: entries };
    return new AverageOfMesh(counts, table, step(device, this.#gather, gathering, vertexCount));
  }
}

/** {@link Average} of one mesh, to be recorded as often as its vertices change. */
export class AverageOfMesh {
  readonly #table: Step[];
  readonly #frames: Step;

  /**
   * Three words to copy from: vertices without a direction; vertices of both UV orientations; vertices of more than 32,768 triangles, which
   * have no direction.
   */
  readonly counts: GPUBuffer;

  /** @internal */
  constructor(counts: GPUBuffer, table: Step[], frames: Step) {
    [this.counts, this.#table, this.#frames] = [counts, table, frames];
  }

  /** Records everything. Once at least, and after a change of indices. */
  record(encoder: GPUCommandEncoder): void {
    for (const record of this.#table) record(encoder);
    this.recordFrames(encoder);
  }

  /** Records the frames alone, for vertices that moved. */
  recordFrames(encoder: GPUCommandEncoder): void {
    encoder.clearBuffer(this.counts);
    this.#frames(encoder);
  }
}

/** In place of an offset: not wanted. */
const ABSENT = 2 ** 32 - 1;

/** The shaders' `Mesh`. */
function describe(device: GPUDevice, mesh: GpuMesh, frames: GpuFrames): GPUBuffer {
  const { vertexCount, indexCount, indexFormat, firstIndex = 0, stride, position, normal, uv } = mesh;
  const word = (offset?: number) => (offset === undefined ? ABSENT : offset / 4);
  const words = [
    ...[vertexCount, indexCount / 3, firstIndex, indexFormat === 'uint16' ? 1 : 0],
    ...[stride, position, normal, uv, frames.stride, frames.tangent, frames.bitangent, frames.sign].map(word),
    0,
  ];
  const result = device.createBuffer({ size: 64, usage: USAGE.UNIFORM | USAGE.COPY_DST });
  device.queue.writeBuffer(result, 0, Uint32Array.from(words));
  return result;
}

/** Errors: indices that are not whole triangles; places that are not whole words or past their buffer. */
function check(mesh: GpuMesh, frames: GpuFrames): void {
  const { vertexCount, indexCount, firstIndex = 0 } = mesh;
  if (vertexCount < 1 || indexCount < 3 || indexCount % 3) {
    throw new RangeError(`${indexCount} indices over ${vertexCount} vertices do not make whole triangles`);
  }
  const size = mesh.indexFormat === 'uint16' ? 2 : 4;
  reach('indices', mesh.indices, (firstIndex + indexCount) * size);
  const rows = (what: string, buffer: GPUBuffer, stride: number, offset: number | undefined, bytes: number) => {
    if (offset !== undefined) checkRows(what, buffer, stride, offset, vertexCount, bytes);
  };
  rows('positions', mesh.vertices, mesh.stride, mesh.position, 12);
  rows('normals', mesh.vertices, mesh.stride, mesh.normal, 12);
  rows('UVs', mesh.vertices, mesh.stride, mesh.uv, 8);
  rows('tangents', frames.buffer, frames.stride, frames.tangent, 12);
  rows('bitangents', frames.buffer, frames.stride, frames.bitangent, 12);
  rows('signs', frames.buffer, frames.stride, frames.sign, 4);
}
