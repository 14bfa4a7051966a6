// Groups primitives that share vertices. Vertices of a group are split together, so that its primitives keep sharing them.

import type { Accessor, Primitive, PrimitiveTarget } from '@gltf-transform/core';
import { TRIANGLE_FAN, TRIANGLE_STRIP, type SelectedPrimitive } from './selection.js';

/** Primitives with the same positions, normals and UVs. The name is that of the first. */
export interface Group extends Omit<SelectedPrimitive, 'primitive'> {
  jobs: Job[];
}

/** Primitives of a group with the same triangles: their tangents are computed once. */
export interface Job {
  members: Member[];
  /** The vertex of each corner. */
  corners: Uint32Array<ArrayBuffer>;
  /** The distinct morph targets of its members, by key. */
  morphs: Map<string, Morph>;
}

/** A primitive, and for each of its morph targets the key in {@link Job.morphs}; null where the target gets no tangent offsets. */
export interface Member {
  primitive: Primitive;
  morphs: (string | null)[];
}

/** The position and normal offsets of a morph target. */
export interface Morph {
  position: Accessor | null;
  normal: Accessor | null;
}

/** Groups primitives, in the order of the first of each group. Existing tangent offsets of targets are kept unless `overwrite` is set. */
export function groupPrimitives(selected: SelectedPrimitive[], overwrite: boolean): Group[] {
  const key = keyMaker();
  const groups = new Map<string, Group>();
  const jobs = new Map<string, Job>();
  for (const { primitive, ...shared } of selected) {
    const { position, normal, uv } = shared;
    const group = getOrInsert(groups, key(position, normal, uv), () => ({ ...shared, jobs: [] }));
    const job = getOrInsert(jobs, key(position, normal, uv, primitive.getIndices(), primitive.getMode()), () => {
      const job = { members: [], corners: cornersOf(primitive, position.getCount()), morphs: new Map() };
      group.jobs.push(job);
      return job;
    });
    unshareTargets(primitive);
    const morphs = primitive.listTargets().map((target) => {
      const morph = { position: target.getAttribute('POSITION'), normal: target.getAttribute('NORMAL') };
      const isWanted = overwrite || !target.getAttribute('TANGENT');
      if (!isWanted || !(morph.position || morph.normal)) return null;
      const name = key(morph.position, morph.normal);
      job.morphs.set(name, morph);
      return name;
    });
    job.members.push({ primitive, morphs });
  }
  return [...groups.values()];
}

/** Makes a function that gives equal keys to lists of the same objects. */
function keyMaker(): (...objects: unknown[]) => string {
  const ids = new Map<unknown, number>();
  const id = (object: unknown) => ids.get(object) ?? ids.set(object, ids.size).size - 1;
  return (...objects) => objects.map(id).join();
}

/** Clones the morph targets that a primitive shares with another. */
function unshareTargets(primitive: Primitive): void {
  const targets = primitive.listTargets();
  const isShared = (target: PrimitiveTarget) => target.listParents().some((parent) => parent.propertyType === 'Primitive' && parent !== primitive);
  if (!targets.some(isShared)) return;
  for (const target of targets) primitive.removeTarget(target);
  for (const target of targets) primitive.addTarget(isShared(target) ? target.clone() : target);
}

/** The vertex of each corner: a triangle list from a list, a strip or a fan (glTF 2.0, 3.7.2.1). */
function cornersOf(primitive: Primitive, vertices: number): Uint32Array<ArrayBuffer> {
  const given = primitive.getIndices()?.getArray();
  const list = given ? Uint32Array.from(given) : Uint32Array.from({ length: vertices }, (_, vertex) => vertex);
  const mode = primitive.getMode();
  if (mode !== TRIANGLE_STRIP && mode !== TRIANGLE_FAN) return list.subarray(0, list.length - (list.length % 3));
  const places = (at: number) => (mode === TRIANGLE_FAN ? [at + 1, at + 2, 0] : [at, at + 1 + (at % 2), at + 2 - (at % 2)]);
  const triangles = Array.from({ length: Math.max(list.length - 2, 0) }, (_, at) => places(at));
  return Uint32Array.from(triangles.flat(), (place) => list[place]!);
}

function getOrInsert<V>(map: Map<string, V>, key: string, create: () => V): V {
  let value = map.get(key);
  if (value === undefined) map.set(key, (value = create()));
  return value;
}
