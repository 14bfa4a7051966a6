// `darboux/webgpu`: tangents on WebGPU. MikkTSpace of whole meshes (`generateTangents`), tangents of moving vertices (`Planner`), and the
// methods 'average' and 'lengyel' per vertex (`Average`).

import kernels from 'darboux-gpu/kernels';
import { adjacency } from 'darboux-gpu/passes';
import { checkLength, checkRows } from './gpu/buffer-checks.js';
import { USE_CPU } from './gpu/device.js';
import { PassProgram, type NamedBuffers } from './gpu/pass-program.js';
import { BUFFER_USAGE, computePipeline, dispatchStep, shaderModule, storageBuffer, type Step } from './gpu/pipelines.js';
import type { GpuTangentOptions, GpuTangents, Indices } from './types.js';

export { GpuPlan, Planner, BoundPlan } from './gpu/planner.js';
export type { GpuAttribute, GpuMovingMesh } from './gpu/planner.js';
export type * from './types.js';

/**
 * The WGSL of plans and of 'average' and 'lengyel', by kernel. A kernel is the concatenation of its texts, after declarations of the constants WORKGROUP,
 * VALUES_PER_THREAD, BLOCK, MAX_GROUPS and MAX_ITERATIONS.
 */
export const shaders: Readonly<Record<'adjacency' | 'average' | 'lengyel' | 'scan' | 'terms' | 'gather' | 'repair' | 'write', readonly string[]>> = kernels;

/**
 * Opens a device of the adapter that the browser considers fastest, with the largest buffer limits of that adapter.
 *
 * @throws Error without WebGPU, or without an adapter.
 */
export async function openDevice(): Promise<GPUDevice> {
  const gpu = globalThis.navigator?.gpu;
  if (!gpu) throw new Error(`WebGPU is missing here: use a browser that has it, from https or localhost, or ${USE_CPU}`);
  const adapter = await gpu.requestAdapter({ powerPreference: 'high-performance' });
  if (!adapter) throw new Error(`no GPU adapter was found: install a driver, or ${USE_CPU}`);
  const { maxBufferSize, maxStorageBufferBindingSize } = adapter.limits;
  return adapter.requestDevice({ requiredLimits: { maxBufferSize, maxStorageBufferBindingSize } });
}

/**
 * Computes the tangent of every corner with the same bits as `generateTangents` of `darboux`. The device welds, finds neighbours, groups and
 * evaluates. The CPU computes rare cases, and corners whose last bits the device's floats leave open.
 *
 * The first call loads the shaders and `darboux` with its WebAssembly. The first call for a device compiles the shaders.
 *
 * @param device The result of {@link openDevice}, or another device. Its limits bound the size of meshes.
 * @returns 4 per corner. The other parameters are those of `darboux`; the arrays must not change until the result is there.
 * @throws TypeError and RangeError as `generateTangents` of `darboux`; RangeError for a mesh beyond the device's limits or memory; Error
 * where the device is lost or refuses a call.
 */
export function generateTangents(
  device: GPUDevice,
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices?: Indices | null,
  options?: (GpuTangentOptions & { returnReport?: false }) | null,
): Promise<Float32Array<ArrayBuffer>>;
/** As above, and also returns the report of the run and the share of the CPU. */
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
  options?: (GpuTangentOptions & { returnReport?: boolean }) | null,
): Promise<Float32Array<ArrayBuffer> | GpuTangents> {
  const { generateTangents } = await import('./webgpu.tangents.js');
  const result = await generateTangents(device, positions, normals, uvs, indices, options);
  return options?.returnReport ? result : result.tangents;
}

/** Vertices and indices on the GPU. Offsets and strides are in bytes and multiples of 4. Buffers have the usage STORAGE. */
export interface GpuMesh {
  vertices: GPUBuffer;
  vertexCount: number;
  /** Bytes from one vertex to the next. */
  stride: number;
  /** The offset of three floats. */
  position: number;
  /** The offset of three floats. */
  normal: number;
  /** The offset of two floats. */
  uv: number;
  indices: GPUBuffer;
  indexFormat: GPUIndexFormat;
  /** The first index of the mesh, counted in indices. Default: 0. */
  firstIndex?: number;
  indexCount: number;
}

/** Where frames are written: a separate buffer with the usage STORAGE. */
export interface GpuFrames {
  buffer: GPUBuffer;
  stride: number;
  /** The offset of three floats, unit length. */
  tangent: number;
  /** The offset of three floats, unit length. Default: not written. */
  bitangent?: number;
  /** The offset of one float, +1 or -1. Default: not written. */
  sign?: number;
}

/**
 * The method 'average' or 'lengyel' of `darboux` per vertex, compiled for a device: the mean of the adjacent triangles' unit tangents, or the
 * sum of their tangents dP/du, not normalised (E. Lengyel, "Computing Tangent Space Basis Vectors for an Arbitrary Mesh", 2001).
 *
 * The CPU splits a vertex where both UV orientations meet. The device gives such a vertex the frame of the orientation with more triangles,
 * and counts it: split such vertices first. The sign is that of the UVs as given. The sums have the bits of the CPU; divisions and square
 * roots are the device's, so the last bits of tangents may differ.
 */
export class Average {
  readonly #device: GPUDevice;
  readonly #adjacency: PassProgram;
  readonly #gather: GPUComputePipeline;

  /** Errors: RangeError for another method. */
  constructor(device: GPUDevice, method: 'average' | 'lengyel' = 'average') {
    if (method !== 'average' && method !== 'lengyel') throw new RangeError(`method is '${method}'; use 'average' or 'lengyel'`);
    this.#device = device;
    this.#adjacency = PassProgram.compileLazily(device, shaders, adjacency);
    this.#gather = computePipeline(device, shaderModule(device, shaders[method]), 'gather');
  }

  /** Binds a mesh. Errors: RangeError for a number of indices that is not a multiple of 3, for strides and offsets that are not multiples of 4,
   * and for attributes past the end of their buffer. */
  ofMesh(mesh: GpuMesh, frames: GpuFrames): AverageOfMesh {
    checkMesh(mesh, frames);
    const device = this.#device;
    const { vertexCount, indices } = mesh;
    const layout = layoutBuffer(device, mesh, frames);
    const counts = storageBuffer(device, 'counts', 3);
    const named: NamedBuffers = { mesh: layout, vertex_of_corner: indices };
    const steps = this.#adjacency.bind(device, { vertices: vertexCount, triangles: mesh.indexCount / 3 }, named);
    const [ends, triangles] = [named.adjacency_ends!, named.adjacent_triangles!];
    const gathering = { 0: layout, 1: indices, 2: mesh.vertices, 3: frames.buffer, 4: counts, 5: ends, 6: triangles };
    return new AverageOfMesh(counts, steps, dispatchStep(device, this.#gather, gathering, vertexCount));
  }
}

/** {@link Average} bound to one mesh. Record it again whenever the vertices have changed. */
export class AverageOfMesh {
  readonly #adjacency: Step[];
  readonly #frames: Step;

  /**
   * Three words to copy from: the number of vertices without a tangent, of vertices with both UV orientations, and of vertices with more than
   * 32,768 triangles, which get no tangent.
   */
  readonly counts: GPUBuffer;

  /** @internal */
  constructor(counts: GPUBuffer, adjacency: Step[], frames: Step) {
    [this.counts, this.#adjacency, this.#frames] = [counts, adjacency, frames];
  }

  /** Records everything: necessary once, and again after a change of indices. */
  record(encoder: GPUCommandEncoder): void {
    for (const record of this.#adjacency) record(encoder);
    this.recordFrames(encoder);
  }

  /** Records the frames only, for vertices that have moved. */
  recordFrames(encoder: GPUCommandEncoder): void {
    encoder.clearBuffer(this.counts);
    this.#frames(encoder);
  }
}

/** Stands for the offset of an attribute that is not written. */
const ABSENT = 2 ** 32 - 1;

/** The struct `Mesh` of the shaders. */
function layoutBuffer(device: GPUDevice, mesh: GpuMesh, frames: GpuFrames): GPUBuffer {
  const { vertexCount, indexCount, indexFormat, firstIndex = 0, stride, position, normal, uv } = mesh;
  const word = (offset?: number) => (offset === undefined ? ABSENT : offset / 4);
  const words = [
    ...[vertexCount, indexCount / 3, firstIndex, indexFormat === 'uint16' ? 1 : 0],
    ...[stride, position, normal, uv, frames.stride, frames.tangent, frames.bitangent, frames.sign].map(word),
    0,
  ];
  const result = device.createBuffer({ size: 64, usage: BUFFER_USAGE.UNIFORM | BUFFER_USAGE.COPY_DST });
  device.queue.writeBuffer(result, 0, Uint32Array.from(words));
  return result;
}

/** Errors: those of {@link Average.ofMesh}. */
function checkMesh(mesh: GpuMesh, frames: GpuFrames): void {
  const { vertexCount, indexCount, firstIndex = 0 } = mesh;
  if (vertexCount < 1 || indexCount < 3 || indexCount % 3) {
    throw new RangeError(`${indexCount} indices over ${vertexCount} vertices are not triangles; indexCount must be a multiple of 3 and vertexCount at least 1`);
  }
  const size = mesh.indexFormat === 'uint16' ? 2 : 4;
  checkLength('indices', mesh.indices, (firstIndex + indexCount) * size);
  const check = (name: string, buffer: GPUBuffer, stride: number, offset: number | undefined, bytes: number) => {
    if (offset !== undefined) checkRows(name, buffer, stride, offset, vertexCount, bytes);
  };
  check('positions', mesh.vertices, mesh.stride, mesh.position, 12);
  check('normals', mesh.vertices, mesh.stride, mesh.normal, 12);
  check('UVs', mesh.vertices, mesh.stride, mesh.uv, 8);
  check('tangents', frames.buffer, frames.stride, frames.tangent, 12);
  check('bitangents', frames.buffer, frames.stride, frames.bitangent, 12);
  check('signs', frames.buffer, frames.stride, frames.sign, 4);
}
