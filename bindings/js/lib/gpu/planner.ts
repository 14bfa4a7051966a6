// Topology once, tangents every frame: the counterpart of crates/darboux-gpu/src/plan.rs.

import shaders from 'darboux-gpu/kernels';
import { checkRows } from './buffer-checks.js';
import { buffer, filled, module, pipeline, step, stepOverList, USAGE, type Step } from './pipelines.js';
import { LIST, list, realStep } from './unsure-items.js';
import type { PlanTopology } from '../types.js';

/** Floats per vertex or corner in a buffer with the usage STORAGE. Stride and offset count bytes and are multiples of 4. */
export interface GpuAttribute {
  buffer: GPUBuffer;
  stride: number;
  offset: number;
}

/** The moving vertices of a plan's mesh, and where their tangents go. All may be parts of one buffer. */
export interface GpuMovingMesh {
  /** Three floats per vertex. */
  positions: GpuAttribute;
  /** Likewise. */
  normals: GpuAttribute;
  /** Four floats each, unit xyz and the sign w. A vertex that nothing uses keeps what it has. */
  tangents: GpuAttribute;
  /** What has a tangent of its own. */
  per: 'vertex' | 'corner';
}

/** The kernels of a device. */
interface Kernels {
  terms: GPUComputePipeline;
  gather: GPUComputePipeline;
  repair: GPUComputePipeline;
  write: GPUComputePipeline;
}

/** What plans need, compiled for a device. */
export class Planner {
  readonly #device: GPUDevice;
  readonly #kernels: Kernels;

  constructor(device: GPUDevice) {
    this.#device = device;
    const compiled = (files: readonly string[], entry = 'every_item') => pipeline(device, module(device, files), entry);
    this.#kernels = {
      terms: compiled(shaders.terms),
      gather: compiled(shaders.gather),
      repair: compiled(shaders.repair),
      write: compiled(shaders.write, 'write'),
    };
  }

  /** Uploads what `planTopology` of `darboux` found. Errors: RangeError for a mesh past the device's limits. */
  plan(topology: PlanTopology): GpuPlan {
    const { maxStorageBufferBindingSize: limit } = this.#device.limits;
    const bytes = Math.max(36 * topology.triangleCount, topology.sums.byteLength, topology.sumOfCorner.byteLength);
    if (bytes > limit) throw new RangeError(`the plan has a buffer of ${bytes} bytes, the device binds ${limit} at most; use Plan`);
    return new GpuPlan(this.#device, this.#kernels, topology);
  }
}

/**
 * The groups of one mesh on a device, to evaluate its tangents wherever its vertices are: as `Plan` of `darboux`, bit for bit where
 * {@link PlanOfBuffers.counts} are 0.
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
    this.#triangles = filled(device, 'triangles', topology.triangles);
    this.#representatives = filled(device, 'representatives', topology.representatives);
    this.#sums = filled(device, 'sums', topology.sums);
    this.#terms = buffer(device, 'terms', 9 * topology.triangleCount);
    this.#tangents = buffer(device, 'tangents', 4 * topology.sumCount);
  }

  /**
   * Makes what recording needs. One plan serves any number of buffers, one after the other.
   *
   * @throws RangeError for places that are not whole words, past their buffer or in each other's; for tangents per vertex where corners of
   * one vertex have several.
   */
  ofBuffers(mesh: GpuMovingMesh): PlanOfBuffers {
    const { triangleCount, sumCount, repairs } = this.#topology;
    const sumOfOutput = this.#sumOfOutput(mesh.per);
    check(mesh, this.#topology.vertexCount, sumOfOutput.length);
    const device = this.#device;
    const plan = filled(device, 'plan', this.#words(mesh, sumOfOutput.length), USAGE.UNIFORM);
    const unusable = list(device, 'unusable', sumCount);
    const repaired = buffer(device, 'repaired', 1);
    const [positions, normals] = [mesh.positions.buffer, mesh.normals.buffer];
    const ofTriangles = { 0: plan, 1: positions, 2: normals, 3: this.#triangles, 4: this.#representatives };
    const toSums = { 0: plan, 2: normals, 3: this.#terms, 5: this.#sums, 6: this.#tangents, 7: unusable.items };
    const toRepair = { ...ofTriangles, 5: this.#sums, 6: this.#tangents, 8: repaired, [LIST]: unusable.items };
    const toWrite = { 0: plan, 1: filled(device, 'sum_of_output', sumOfOutput), 2: this.#tangents, 3: mesh.tangents.buffer };
    const { terms, gather, repair, write } = this.#kernels;
    const counts = buffer(device, 'counts', 3);
    const [ofTerms, ofSums] = [
      realStep(device, terms, { ...ofTriangles, 5: this.#terms }, triangleCount),
      realStep(device, gather, toSums, sumCount),
    ];
    const steps: Step[] = [
      unusable.clear,
      (encoder) => encoder.clearBuffer(repaired),
      ofTerms.record,
      ofSums.record,
      ...(repairs ? [stepOverList(device, repair, toRepair, unusable.items)] : []),
      step(device, write, toWrite, sumOfOutput.length),
      (encoder) => ofTerms.count(encoder, counts, 0),
      (encoder) => ofSums.count(encoder, counts, 4),
      (encoder) => encoder.copyBufferToBuffer(repaired, 0, counts, 8, 4),
    ];
    return new PlanOfBuffers(steps, counts);
  }

  #sumOfOutput(per: GpuMovingMesh['per']): Uint32Array {
    const { sumOfCorner, sumOfVertex, splitVertices } = this.#topology;
    if (per === 'corner') return sumOfCorner;
    if (!splitVertices) return sumOfVertex;
    throw new RangeError(`${splitVertices} vertices have several tangents; split them first (splitVertices)`);
  }

  /** The shaders' `Plan`. */
  #words({ positions, normals, tangents }: GpuMovingMesh, outputs: number): Uint32Array {
    const { vertexCount, triangleCount, degenerateCount, sumCount, repairs } = this.#topology;
    const places = [positions, normals, tangents].flatMap(({ offset, stride }) => [offset / 4, stride / 4]);
    // What only checks read, and a zero.
    return Uint32Array.of(vertexCount, triangleCount, degenerateCount, sumCount, outputs, ...places, Number(repairs), 0, 0, 0, 0);
  }
}

/** A {@link GpuPlan} on a caller's buffers: recorded every frame, without allocation. */
export class PlanOfBuffers {
  readonly #steps: readonly Step[];

  /**
   * Three words to copy from: triangles and tangents whose last bits the device's floats leave open, for which there is `Plan`; unusable
   * tangents that were replaced, nearly as `Plan` replaces them.
   */
  readonly counts: GPUBuffer;

  /** @internal */
  constructor(steps: readonly Step[], counts: GPUBuffer) {
    [this.#steps, this.counts] = [steps, counts];
  }

  /** Records the tangents of where the vertices are when the device comes to it. */
  record(encoder: GPUCommandEncoder): void {
    for (const step of this.#steps) step(encoder);
  }
}

function check({ positions, normals, tangents }: GpuMovingMesh, vertices: number, outputs: number): void {
  const rows = (what: string, { buffer, stride, offset }: GpuAttribute, count: number, bytes: number) =>
    checkRows(what, buffer, stride, offset, count, bytes);
  rows('positions', positions, vertices, 12);
  rows('normals', normals, vertices, 12);
  rows('tangents', tangents, outputs, 16);
  if (tangents.stride < 16) throw new RangeError(`tangents are ${tangents.stride} bytes apart but have 16`);
  for (const [what, other] of [['positions', positions], ['normals', normals]] as const) {
    const isBeside = other.buffer === tangents.buffer && other.stride === tangents.stride;
    const [start, end] = [tangents.offset % tangents.stride, (tangents.offset % tangents.stride) + 16];
    const own = other.offset % tangents.stride;
    if (isBeside && start < own + 12 && own < end) throw new RangeError(`the tangents would overwrite the ${what}; give them a place of their own`);
  }
}
