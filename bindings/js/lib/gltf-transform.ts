// `darboux/gltf-transform`: tangents of glTF documents.

import type { Accessor, Document, Transform } from '@gltf-transform/core';
import { generateTangents, Plan, ready, splitVertices } from './darboux.js';
import { disposeUnused, floats, gathered, indexArray } from './gltf/accessors.js';
import { grouped, type Group, type Job, type Movement } from './gltf/groups.js';
import { select, TRIANGLES } from './gltf/selection.js';
import { choice } from './core/mesh.js';
import type { TangentOptions, VertexSplit } from './types.js';

/** What {@link tangents} does. */
export interface TangentsOptions extends Omit<TangentOptions, 'faces' | 'mode'> {
  /** Default: 'repaired'. Zero tangents and NaN, as 'reference' would leave them, make a file invalid. */
  mode?: (typeof MODES)[number];
  /** Whether existing tangents are replaced. Default: false. */
  overwrite?: boolean;
  /** Taken, as callers of glTF-Transform's own `tangents()` give it, and not used: `darboux` computes. */
  generateTangents?: unknown;
}

const MODES = ['repaired', 'corrected'] as const;

/**
 * Gives every primitive of triangles, indexed or not, tangents for the UV set of its normal texture. Vertices are copied only where their
 * corners need different tangents, as at mirrored seams; then everything of a vertex follows. Primitives that share vertices go on sharing.
 * Morph targets that move positions or normals get tangent offsets. Primitives without normals or that UV set are left alone, as are
 * tangents that are there, unless `overwrite` is set. `ready` need not be awaited.
 *
 * The sign is glTF's: MikkTSpace's for the UVs as stored, negated, because v points down the image.
 *
 * @throws RangeError, naming the primitive, where lengths do not fit together or an index is out of range.
 */
export function tangents(options: TangentsOptions = {}): Transform {
  const { overwrite = false, generateTangents: _, ...computation } = options;
  if (computation.mode !== undefined) choice('mode', computation.mode, MODES);
  const transform = async (document: Document): Promise<void> => {
    await ready;
    const logger = document.getLogger();
    if (document.hasExtension('KHR_mesh_primitive_restart')) {
      throw new Error('tangents: Missing support for KHR_mesh_primitive_restart.');
    }
    const chosen = select(document, overwrite);
    for (const group of grouped(chosen, overwrite)) {
      try {
        addTangents(document, group, computation);
      } catch (error) {
        throw error instanceof RangeError ? new RangeError(`tangents: ${group.name}: ${error.message}`, { cause: error }) : error;
      }
    }
    if (chosen.length) logger.debug('tangents: Complete.');
    else logger.warn('tangents: No qualifying primitives found. See debug output.');
  };
  return Object.defineProperty(transform, 'name', { value: 'tangents' });
}

/** A job with its tangents. */
interface Computed extends Job {
  tangents: Float32Array<ArrayBuffer>;
  /** Where vertices move. */
  plan: Plan | null;
}

/** The vertices of a group. */
interface Vertices {
  positions: Float32Array;
  normals: Float32Array;
  uvs: Float32Array;
}

function addTangents(document: Document, group: Group, computation: TangentOptions): void {
  const count = group.position.getCount();
  const vertices = {
    positions: floats(group.position, 'POSITION', 3, count),
    normals: floats(group.normal, 'NORMAL', 3, count),
    uvs: floats(group.uv, 'the UV set', 2, count),
  };
  const jobs = group.jobs.map((job) => compute(job, vertices, computation));
  const split = splitVertices(joined(jobs.map((job) => job.corners)), joined(jobs.map((job) => job.tangents)), count);
  const lists = parts(split.indices, jobs);
  // What can go wrong has gone wrong by now; from here on the document changes.
  const offsets = offsetsOf(jobs, lists, vertices, split.sourceOfVertex.length);
  const replaced = new Set<Accessor | null>();
  if (split.sourceOfVertex.length > count) follow(document, jobs, lists, split, replaced);
  write(document, group, split.tangentOfVertex, offsets, replaced);
  disposeUnused(replaced);
}

/** The tangents of a job, in glTF's sign. */
function compute(job: Job, { positions, normals, uvs }: Vertices, computation: TangentOptions): Computed {
  const mesh = [positions, normals, uvs, job.corners, computation] as const;
  const plan = job.movements.size ? new Plan(...mesh) : null;
  const tangents = plan ? plan.base.slice() : generateTangents(...mesh);
  for (let at = 3; at < tangents.length; at += 4) tangents[at]! *= -1;
  return { ...job, tangents, plan };
}

/** Tangent offsets of every vertex, by the key of the movement. The first corner of a vertex decides. */
function offsetsOf(jobs: Computed[], lists: Uint32Array[], base: Vertices, count: number): Map<string, Float32Array<ArrayBuffer>> {
  const offsets = new Map<string, Float32Array<ArrayBuffer>>();
  for (const [at, { movements, plan, tangents }] of jobs.entries()) {
    for (const [key, movement] of movements) {
      const moved = plan!.evaluate(...move(base, movement));
      const ofVertex = offsets.get(key) ?? new Float32Array(3 * count).fill(NaN);
      offsets.set(key, ofVertex);
      lists[at]!.forEach((vertex, corner) => {
        if (!Number.isNaN(ofVertex[3 * vertex])) return;
        for (let i = 0; i < 3; i++) ofVertex[3 * vertex + i] = moved[4 * corner + i]! - tangents[4 * corner + i]!;
      });
    }
  }
  // Vertices that no corner uses do not move.
  for (const ofVertex of offsets.values()) ofVertex.forEach((x, at) => (ofVertex[at] = Number.isNaN(x) ? 0 : x));
  return offsets;
}

/** Moved positions and normals. */
function move({ positions, normals }: Vertices, { position, normal }: Movement): [Float32Array, Float32Array] {
  const add = (base: Float32Array, accessor: Accessor | null) => {
    const by = accessor && floats(accessor, 'a morph target', 3, base.length / 3);
    return by ? base.map((x, at) => x + by[at]!) : base;
  };
  return [add(positions, position), add(normals, normal)];
}

/** Gives the primitives new vertices and indices. What was in place of these is noted as replaced. */
function follow(document: Document, jobs: Job[], lists: Uint32Array<ArrayBuffer>[], split: VertexSplit, replaced: Set<Accessor | null>): void {
  const { sourceOfVertex } = split;
  const copies = new Map<Accessor, Accessor>();
  const copy = (accessor: Accessor) => {
    replaced.add(accessor);
    if (!copies.has(accessor)) copies.set(accessor, gathered(accessor, sourceOfVertex));
    return copies.get(accessor)!;
  };
  for (const [at, { members }] of jobs.entries()) {
    const old = members[0]!.primitive.getIndices();
    const array = indexArray(lists[at]!, sourceOfVertex.length, old?.getArray());
    const buffer = (old ?? members[0]!.primitive.getAttribute('POSITION'))!.getBuffer();
    const indices = document.createAccessor(old?.getName()).setBuffer(buffer).setType('SCALAR').setArray(array);
    replaced.add(old);
    for (const { primitive } of members) {
      for (const owner of [primitive, ...primitive.listTargets()]) {
        for (const semantic of owner.listSemantics()) owner.setAttribute(semantic, copy(owner.getAttribute(semantic)!));
      }
      primitive.setIndices(indices).setMode(TRIANGLES);
    }
  }
}

/** Writes tangents, one accessor for all primitives of the group, and offsets, one for each movement. */
function write(
  document: Document,
  group: Group,
  tangents: Float32Array<ArrayBuffer>,
  offsets: Map<string, Float32Array<ArrayBuffer>>,
  replaced: Set<Accessor | null>,
): void {
  const make = (type: 'VEC3' | 'VEC4', array: Float32Array<ArrayBuffer>) =>
    document.createAccessor().setBuffer(group.position.getBuffer()).setType(type).setArray(array);
  const base = make('VEC4', tangents);
  const accessors = new Map([...offsets].map(([movement, array]) => [movement, make('VEC3', array)]));
  for (const { primitive, movements } of group.jobs.flatMap((job) => job.members)) {
    replaced.add(primitive.getAttribute('TANGENT'));
    primitive.setAttribute('TANGENT', base);
    for (const [at, target] of primitive.listTargets().entries()) {
      const movement = movements[at];
      if (movement == null) continue;
      replaced.add(target.getAttribute('TANGENT'));
      target.setAttribute('TANGENT', accessors.get(movement)!);
    }
  }
}

/** Lists, one after the other. */
function joined<A extends Float32Array<ArrayBuffer> | Uint32Array<ArrayBuffer>>(lists: A[]): A {
  if (lists.length === 1) return lists[0]!;
  const result = new (lists[0]!.constructor as new (length: number) => A)(lists.reduce((sum, list) => sum + list.length, 0));
  let at = 0;
  for (const list of lists) {
    result.set(list, at);
    at += list.length;
  }
  return result;
}

/** What belongs to each job of the list for all corners. */
function parts(list: Uint32Array<ArrayBuffer>, jobs: Job[]): Uint32Array<ArrayBuffer>[] {
  let end = 0;
  return jobs.map(({ corners }) => list.subarray(end, (end += corners.length)));
}
