// `darboux/webgpu`: plans and the method 'average' on WebGPU.

import shaders from 'darboux-gpu/kernels';
import { checkRows, reach } from './gpu/check.js';
import { buffer, module, pipeline, scanSteps, step, USAGE } from './gpu/kernels.js';

export { GpuPlan, Planner, PlanOfBuffers } from './planner.js';
export type { GpuAttribute, GpuMovingMesh } from './planner.js';

/**
 * The shaders as data, each of texts that are read one after the other, after the constants WORKGROUP, VALUES_PER_THREAD, BLOCK, MAX_GROUPS and
 * MAX_TURNS.
 */
export { shaders };

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
  readonly #count: GPUComputePipeline;
  readonly #scatter: GPUComputePipeline;
  readonly #rank: GPUComputePipeline;
  readonly #scan: { scan: GPUComputePipeline; addSums: GPUComputePipeline };
  readonly #gather: GPUComputePipeline;

  constructor(device: GPUDevice) {
    const [tables, sums] = [module(device, shaders.adjacency), module(device, shaders.scan)];
    this.#device = device;
    this.#count = pipeline(device, tables, 'count');
    this.#scatter = pipeline(device, tables, 'scatter');
    this.#rank = pipeline(device, tables, 'rank');
    this.#scan = { scan: pipeline(device, sums, 'scan'), addSums: pipeline(device, sums, 'add_sums') };
    this.#gather = pipeline(device, module(device, shaders.average), 'gather');
  }

  /** Makes what recording needs. Errors: RangeError for indices that are not whole triangles, places that are not whole words or past their buffer. */
  ofMesh(mesh: GpuMesh, frames: GpuFrames): AverageOfMesh {
    check(mesh, frames);
    const device = this.#device;
    const { vertexCount, indices, indexCount: corners } = mesh;
    const words = describe(device, mesh, frames);
    const [ends, counts] = [buffer(device, 'ends', vertexCount), buffer(device, 'counts', 3)];
    const [cornerOfEntry, triangleOfEntry] = [buffer(device, 'corner_of_entry', corners), buffer(device, 'triangle_of_entry', corners)];
    const filling = { 0: words, 1: indices, 2: ends, 3: cornerOfEntry };
    const table = [
      step(device, this.#count, { 0: words, 1: indices, 2: ends }, corners),
      ...scanSteps(device, this.#scan, ends, vertexCount),
      step(device, this.#scatter, filling, corners),
      step(device, this.#rank, { ...filling, 4: triangleOfEntry }, corners),
    ];
    const gathering = { 0: words, 1: indices, 2: mesh.vertices, 3: frames.buffer, 4: counts, 5: ends, 6: triangleOfEntry };
    return new AverageOfMesh(ends, counts, table, step(device, this.#gather, gathering, vertexCount));
  }
}

type Recorded = (encoder: GPUCommandEncoder) => void;

/** {@link Average} of one mesh, to be recorded as often as its vertices change. */
export class AverageOfMesh {
  readonly #ends: GPUBuffer;
  readonly #table: Recorded[];
  readonly #frames: Recorded;

  /**
   * Three words to copy from: vertices without a direction; vertices of both UV orientations; vertices of more than 32,768 triangles, which
   * have no direction.
   */
  readonly counts: GPUBuffer;

  /** @internal */
  constructor(ends: GPUBuffer, counts: GPUBuffer, table: Recorded[], frames: Recorded) {
    [this.#ends, this.counts, this.#table, this.#frames] = [ends, counts, table, frames];
  }

  /** Records everything. Once at least, and after a change of indices. */
  record(encoder: GPUCommandEncoder): void {
    encoder.clearBuffer(this.#ends);
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
