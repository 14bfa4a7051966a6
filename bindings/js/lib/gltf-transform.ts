// `darboux/gltf-transform`: a transform that adds tangents to glTF documents, in place of glTF-Transform's own `tangents()`.
//
//   select primitives; group those that share vertices
//   per group: compute the tangents of corners; split vertices; give primitives the new vertices and indices; write TANGENT

import type { Accessor, Document, Transform } from '@gltf-transform/core';
import { generateTangents, Plan, ready, splitVertices } from './darboux.js';
import { disposeUnused, floats, gathered, indexArray } from './gltf/accessors.js';
import { groupPrimitives, type Group, type Job, type Morph } from './gltf/groups.js';
import { selectPrimitives, TRIANGLES } from './gltf/selection.js';
import { choice } from './core/checks.js';
import type { TangentOptions, VertexSplit } from './types.js';

/** Options of {@link tangents}. */
export interface TangentsOptions extends Omit<TangentOptions, 'faces' | 'mode'> {
  /** Default: 'repaired'. 'reference' is refused, because its zero tangents and NaN make a file invalid. */
  mode?: (typeof MODES)[number] | null;
  /** Whether existing tangents are replaced. Default: false. */
  overwrite?: boolean;
  /** Ignored. Callers of glTF-Transform's own `tangents()` pass it. */
  generateTangents?: unknown;
}

const MODES = ['repaired', 'corrected'] as const;

/**
 * Adds tangents to every primitive of triangles, indexed or not, for the UV set of its normal texture. A vertex is copied, with all its
 * attributes, only where its corners need different tangents, as at mirrored seams. Primitives that share vertices keep sharing them. Morph
 * targets with position or normal offsets get tangent offsets. Primitives without normals or without that UV set are skipped. Existing
 * tangents are kept unless `overwrite` is set. The transform awaits `ready` itself.
 *
 * The sign is that of glTF: the sign of MikkTSpace for the stored UVs, negated, because v points down the image.
 *
 * @throws RangeError where lengths do not fit together or an index is out of range. The message names the primitive.
 */
export function tangents(options?: TangentsOptions | null): Transform {
  const { overwrite = false, generateTangents: _, ...computation } = options ?? {};
  choice('mode', computation.mode, MODES, 'repaired');
  const transform = async (document: Document): Promise<void> => {
    await ready;
    const logger = document.getLogger();
    if (document.hasExtension('KHR_mesh_primitive_restart')) {
      throw new Error('tangents: Missing support for KHR_mesh_primitive_restart.');
    }
    const selected = selectPrimitives(document, overwrite);
    for (const group of groupPrimitives(selected, overwrite)) {
      try {
        addTangents(document, group, computation);
      } catch (error) {
        throw error instanceof RangeError ? new RangeError(`tangents: ${group.name}: ${error.message}`, { cause: error }) : error;
      }
    }
    if (selected.length) logger.debug('tangents: Complete.');
    else logger.warn('tangents: No qualifying primitives found. See debug output.');
  };
  return Object.defineProperty(transform, 'name', { value: 'tangents' });
}

/** A job and its tangents. */
interface Computed extends Job {
  tangents: Float32Array<ArrayBuffer>;
  /** The plan that evaluates morph targets; null without any. */
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
  const split = splitVertices(concatenated(jobs.map((job) => job.corners)), concatenated(jobs.map((job) => job.tangents)), count);
  const lists = perJob(split.indices, jobs);
  // Everything above may throw; nothing below does, so that an error leaves the document unchanged.
  const offsets = offsetsOf(jobs, lists, vertices, split.sourceOfVertex.length);
  const replaced = new Set<Accessor | null>();
  if (split.sourceOfVertex.length > count) replaceVertices(document, jobs, lists, split, replaced);
  writeTangents(document, group, split.tangentOfVertex, offsets, replaced);
  disposeUnused(replaced);
}

/** The tangents of a job, with glTF's sign. */
function compute(job: Job, { positions, normals, uvs }: Vertices, computation: TangentOptions): Computed {
  const mesh = [positions, normals, uvs, job.corners, computation] as const;
  const plan = job.morphs.size ? new Plan(...mesh) : null;
  const tangents = plan ? plan.base.slice() : generateTangents(...mesh);
  for (let at = 3; at < tangents.length; at += 4) tangents[at]! *= -1;
  return { ...job, tangents, plan };
}

/** The tangent offsets of every vertex, by the key of the morph target. They are those of the vertex's first corner. */
function offsetsOf(jobs: Computed[], lists: Uint32Array[], base: Vertices, count: number): Map<string, Float32Array<ArrayBuffer>> {
  const offsets = new Map<string, Float32Array<ArrayBuffer>>();
  for (const [at, { morphs, plan, tangents }] of jobs.entries()) {
    for (const [key, morph] of morphs) {
      const moved = plan!.evaluate(...morphed(base, morph));
      const ofVertex = offsets.get(key) ?? new Float32Array(3 * count).fill(NaN);
      offsets.set(key, ofVertex);
      lists[at]!.forEach((vertex, corner) => {
        if (!Number.isNaN(ofVertex[3 * vertex])) return;
        for (let i = 0; i < 3; i++) ofVertex[3 * vertex + i] = moved[4 * corner + i]! - tangents[4 * corner + i]!;
      });
    }
  }
  // A vertex that no corner uses has no offset.
  for (const ofVertex of offsets.values()) ofVertex.forEach((x, at) => (ofVertex[at] = Number.isNaN(x) ? 0 : x));
  return offsets;
}

/** Positions and normals with the offsets of a morph target added. */
function morphed({ positions, normals }: Vertices, { position, normal }: Morph): [Float32Array, Float32Array] {
  const add = (base: Float32Array, accessor: Accessor | null) => {
    const offsets = accessor && floats(accessor, 'a morph target', 3, base.length / 3);
    return offsets ? base.map((x, at) => x + offsets[at]!) : base;
  };
  return [add(positions, position), add(normals, normal)];
}

/** Gives the primitives the split vertices and new indices, and adds the old accessors to `replaced`. */
function replaceVertices(document: Document, jobs: Job[], lists: Uint32Array<ArrayBuffer>[], split: VertexSplit, replaced: Set<Accessor | null>): void {
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

/** Writes the tangents (one accessor for all primitives of the group) and the tangent offsets (one accessor per morph target). */
function writeTangents(
  document: Document,
  group: Group,
  tangents: Float32Array<ArrayBuffer>,
  offsets: Map<string, Float32Array<ArrayBuffer>>,
  replaced: Set<Accessor | null>,
): void {
  const accessor = (type: 'VEC3' | 'VEC4', array: Float32Array<ArrayBuffer>) =>
    document.createAccessor().setBuffer(group.position.getBuffer()).setType(type).setArray(array);
  const base = accessor('VEC4', tangents);
  const accessors = new Map([...offsets].map(([key, array]) => [key, accessor('VEC3', array)]));
  for (const { primitive, morphs } of group.jobs.flatMap((job) => job.members)) {
    replaced.add(primitive.getAttribute('TANGENT'));
    primitive.setAttribute('TANGENT', base);
    for (const [at, target] of primitive.listTargets().entries()) {
      const key = morphs[at];
      if (key == null) continue;
      replaced.add(target.getAttribute('TANGENT'));
      target.setAttribute('TANGENT', accessors.get(key)!);
    }
  }
}

/** Arrays, one after the other. */
function concatenated<A extends Float32Array<ArrayBuffer> | Uint32Array<ArrayBuffer>>(lists: A[]): A {
  if (lists.length === 1) return lists[0]!;
  const result = new (lists[0]!.constructor as new (length: number) => A)(lists.reduce((sum, list) => sum + list.length, 0));
  let at = 0;
  for (const list of lists) {
    result.set(list, at);
    at += list.length;
  }
  return result;
}

/** The part of an array over all corners that belongs to each job. */
function perJob(list: Uint32Array<ArrayBuffer>, jobs: Job[]): Uint32Array<ArrayBuffer>[] {
  let end = 0;
  return jobs.map(({ corners }) => list.subarray(end, (end += corners.length)));
}
