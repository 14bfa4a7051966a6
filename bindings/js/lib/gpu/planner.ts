// Tangents of moving vertices on WebGPU: the mesh is grouped once (`planTopology` of `darboux`), and shaders evaluate its tangents every frame.
// The native counterpart is crates/darboux-gpu/src/plan.rs.

import shaders from 'darboux-gpu/kernels';
import { checkRows } from './buffer-checks.js';
import { BUFFER_USAGE, computePipeline, dispatchStep, filledBuffer, indirectStep, shaderModule, storageBuffer, type Step } from './pipelines.js';
import { exactStep, itemList, LIST_BINDING } from './unsure-items.js';
import type { PlanTopology } from '../types.js';

/** Where the floats of vertices or corners lie, in a buffer with the usage STORAGE. Stride and offset are in bytes and multiples of 4. */
export interface GpuAttribute {
  buffer: GPUBuffer;
  stride: number;
  offset: number;
}

/** The moving vertices of a planned mesh, and where their tangents go. All attributes may share one buffer. */
export interface GpuMovingMesh {
  /** Three floats per vertex. */
  positions: GpuAttribute;
  /** Three floats per vertex. */
  normals: GpuAttribute;
  /** Four floats each, unit xyz and the sign w. The tangent of an unused vertex is not written. */
  tangents: GpuAttribute;
  /** Whether tangents are written per vertex or per corner. */
  per: 'vertex' | 'corner';
}

/** The pipelines of plans. */
interface Kernels {
  terms: GPUComputePipeline;
  gather: GPUComputePipeline;
  repair: GPUComputePipeline;
  write: GPUComputePipeline;
}

/** The shaders of plans, compiled for a device. */
export class Planner {
  readonly #device: GPUDevice;
  readonly #kernels: Kernels;

  constructor(device: GPUDevice) {
    this.#device = device;
    const compiled = (files: readonly string[], entry = 'every_item') => computePipeline(device, shaderModule(device, files), entry);
    this.#kernels = {
      terms: compiled(shaders.terms),
      gather: compiled(shaders.gather),
      repair: compiled(shaders.repair),
      write: compiled(shaders.write, 'write'),
    };
  }

  /** Uploads the result of `planTopology` of `darboux`. Errors: RangeError for a mesh beyond the device's limits. */
  plan(topology: PlanTopology): GpuPlan {
    const { maxStorageBufferBindingSize: limit } = this.#device.limits;
    const bytes = Math.max(36 * topology.triangleCount, topology.sums.byteLength, topology.sumOfCorner.byteLength);
    if (bytes > limit) throw new RangeError(`the plan needs a buffer of ${bytes} bytes but the device binds ${limit} at most; use Plan`);
    return new GpuPlan(this.#device, this.#kernels, topology);
  }
}

/**
 * The groups of one mesh on a device. Its tangents can be evaluated wherever its vertices are, bit for bit as by `Plan` of `darboux` where
 * {@link BoundPlan.counts} are 0.
 */
export class GpuPlan {
  readonly #device: GPUDevice;
  readonly #kernels: Kernels;
  readonly #topology: PlanTopology;
  readonly #triangles: GPUBuffer;
  readonly #representatives: GPUBuffer;
  readonly #sums: GPUBuffer;
  readonly #terms: GPUBuffer;
  readonly #tangents: GPUBuffer;

  /** @internal */
  constructor(device: GPUDevice, kernels: Kernels, topology: PlanTopology) {
    [this.#device, this.#kernels, this.#topology] = [device, kernels, topology];
    this.#triangles = filledBuffer(device, 'triangles', topology.triangles);
    this.#representatives = filledBuffer(device, 'representatives', topology.representatives);
    this.#sums = filledBuffer(device, 'sums', topology.sums);
    this.#terms = storageBuffer(device, 'terms', 9 * topology.triangleCount);
    this.#tangents = storageBuffer(device, 'tangents', 4 * topology.sumCount);
  }

  /**
   * Binds the plan to buffers. One plan may be bound to any number of buffers and recorded for one after the other.
   *
   * @throws RangeError for strides and offsets that are not multiples of 4, for attributes past the end of their buffer, for tangents that
   * overlap positions or normals, and for tangents per vertex where corners of one vertex have several.
   */
  bind(mesh: GpuMovingMesh): BoundPlan {
    const { triangleCount, sumCount, repairs } = this.#topology;
    const sumOfOutput = this.#sumOfOutput(mesh.per);
    checkBuffers(mesh, this.#topology.vertexCount, sumOfOutput.length);
    const device = this.#device;
    const plan = filledBuffer(device, 'plan', this.#words(mesh, sumOfOutput.length), BUFFER_USAGE.UNIFORM);
    const unusable = itemList(device, 'unusable', sumCount);
    const repaired = storageBuffer(device, 'repaired', 1);
    const [positions, normals] = [mesh.positions.buffer, mesh.normals.buffer];
    const ofTriangles = { 0: plan, 1: positions, 2: normals, 3: this.#triangles, 4: this.#representatives };
    const toSums = { 0: plan, 2: normals, 3: this.#terms, 5: this.#sums, 6: this.#tangents, 7: unusable.items };
    const toRepair = { ...ofTriangles, 5: this.#sums, 6: this.#tangents, 8: repaired, [LIST_BINDING]: unusable.items };
    const toWrite = { 0: plan, 1: filledBuffer(device, 'sum_of_output', sumOfOutput), 2: this.#tangents, 3: mesh.tangents.buffer };
    const { terms, gather, repair, write } = this.#kernels;
    const counts = storageBuffer(device, 'counts', 3);
    const [ofTerms, ofSums] = [
      exactStep(device, terms, { ...ofTriangles, 5: this.#terms }, triangleCount),
      exactStep(device, gather, toSums, sumCount),
    ];
    const steps: Step[] = [
      unusable.clear,
      (encoder) => encoder.clearBuffer(repaired),
      ofTerms.record,
      ofSums.record,
      ...(repairs ? [indirectStep(device, repair, toRepair, unusable.items)] : []),
      dispatchStep(device, write, toWrite, sumOfOutput.length),
      (encoder) => ofTerms.copyUnsureCount(encoder, counts, 0),
      (encoder) => ofSums.copyUnsureCount(encoder, counts, 4),
      (encoder) => encoder.copyBufferToBuffer(repaired, 0, counts, 8, 4),
    ];
    return new BoundPlan(steps, counts);
  }

  #sumOfOutput(per: GpuMovingMesh['per']): Uint32Array {
    const { sumOfCorner, sumOfVertex, splitVertices } = this.#topology;
    if (per === 'corner') return sumOfCorner;
    if (!splitVertices) return sumOfVertex;
    throw new RangeError(`${splitVertices} vertices have several tangents; split them first (splitVertices)`);
  }

  /** The struct `Plan` of the shaders. */
  #words({ positions, normals, tangents }: GpuMovingMesh, outputs: number): Uint32Array {
    const { vertexCount, triangleCount, degenerateCount, sumCount, repairs } = this.#topology;
    const places = [positions, normals, tangents].flatMap(({ offset, stride }) => [offset / 4, stride / 4]);
    // The last words are read by the native checks only.
    return Uint32Array.of(vertexCount, triangleCount, degenerateCount, sumCount, outputs, ...places, Number(repairs), 0, 0, 0, 0);
  }
}

/** A {@link GpuPlan} bound to a caller's buffers. Recording it every frame allocates nothing. */
export class BoundPlan {
  readonly #steps: readonly Step[];

  /**
   * Three words to copy from: triangles whose last bits the device's floats leave open, tangents likewise, and unusable tangents that were
   * replaced, nearly as by `Plan`. Where one of the first two is not 0, `Plan` computes the exact bits.
   */
  readonly counts: GPUBuffer;

  /** @internal */
  constructor(steps: readonly Step[], counts: GPUBuffer) {
    [this.#steps, this.counts] = [steps, counts];
  }

  /** Records the evaluation. It reads the vertices when the device executes the commands. */
  record(encoder: GPUCommandEncoder): void {
    for (const step of this.#steps) step(encoder);
  }
}

function checkBuffers({ positions, normals, tangents }: GpuMovingMesh, vertices: number, outputs: number): void {
  const check = (name: string, { buffer, stride, offset }: GpuAttribute, count: number, bytes: number) =>
    checkRows(name, buffer, stride, offset, count, bytes);
  check('positions', positions, vertices, 12);
  check('normals', normals, vertices, 12);
  check('tangents', tangents, outputs, 16);
  if (tangents.stride < 16) throw new RangeError(`the stride of the tangents is ${tangents.stride} bytes but a tangent has 16`);
  for (const [name, other] of [['positions', positions], ['normals', normals]] as const) {
    const isBeside = other.buffer === tangents.buffer && other.stride === tangents.stride;
    const [start, end] = [tangents.offset % tangents.stride, (tangents.offset % tangents.stride) + 16];
    const own = other.offset % tangents.stride;
    if (isBeside && start < own + 12 && own < end) throw new RangeError(`the tangents would overwrite the ${name}; give them another offset`);
  }
}
