// Primitives over the same vertices, which are split together and go on sharing them.

import type { Accessor, Primitive, PrimitiveTarget } from '@gltf-transform/core';
import { TRIANGLE_FAN, TRIANGLE_STRIP, type Chosen } from './selection.js';

/** Primitives over the same positions, normals and UVs, named as the first. */
export interface Group extends Omit<Chosen, 'primitive'> {
  jobs: Job[];
}

/** Primitives of a group over the same triangles. */
export interface Job {
  members: Member[];
  /** The vertex of each corner. */
  corners: Uint32Array<ArrayBuffer>;
  /** What moves the vertices of its members. */
  movements: Map<string, Movement>;
}

/** A primitive, and for each of its targets the key of the movement; none where the target gets no offsets. */
export interface Member {
  primitive: Primitive;
  movements: (string | null)[];
}

/** Offsets of morph targets. */
export interface Movement {
  position: Accessor | null;
  normal: Accessor | null;
}

/** Primitives in groups, in the order in which each is met first. Targets keep the offsets that they have, unless these are overwritten. */
export function grouped(chosen: Chosen[], overwrite: boolean): Group[] {
  const key = keys();
  const groups = new Map<string, Group>();
  const jobs = new Map<string, Job>();
  for (const { primitive, ...shared } of chosen) {
    const { position, normal, uv } = shared;
    const group = entry(groups, key(position, normal, uv), () => ({ ...shared, jobs: [] }));
    const job = entry(jobs, key(position, normal, uv, primitive.getIndices(), primitive.getMode()), () => {
      const made = { members: [], corners: corners(primitive, position.getCount()), movements: new Map() };
      group.jobs.push(made);
      return made;
    });
    ownTargets(primitive);
    const movements = primitive.listTargets().map((target) => {
      const movement = { position: target.getAttribute('POSITION'), normal: target.getAttribute('NORMAL') };
      const isWanted = overwrite || !target.getAttribute('TANGENT');
      if (!isWanted || !(movement.position || movement.normal)) return null;
      const name = key(movement.position, movement.normal);
      job.movements.set(name, movement);
      return name;
    });
    job.members.push({ primitive, movements });
  }
  return [...groups.values()];
}

/** Makes keys that lists of the same objects have in common. */
function keys(): (...objects: unknown[]) => string {
  const ids = new Map<unknown, number>();
  const id = (object: unknown) => ids.get(object) ?? ids.set(object, ids.size).size - 1;
  return (...objects) => objects.map(id).join();
}

/** Gives a primitive targets that no other has. */
function ownTargets(primitive: Primitive): void {
  const targets = primitive.listTargets();
  const isShared = (target: PrimitiveTarget) => target.listParents().some((parent) => parent.propertyType === 'Primitive' && parent !== primitive);
  if (!targets.some(isShared)) return;
  for (const target of targets) primitive.removeTarget(target);
  for (const target of targets) primitive.addTarget(isShared(target) ? target.clone() : target);
}

/** The vertex of each corner, of lists, strips and fans alike (glTF 2.0, 3.7.2.1). */
function corners(primitive: Primitive, vertices: number): Uint32Array<ArrayBuffer> {
  const given = primitive.getIndices()?.getArray();
  const list = given ? Uint32Array.from(given) : Uint32Array.from({ length: vertices }, (_, vertex) => vertex);
  const mode = primitive.getMode();
  if (mode !== TRIANGLE_STRIP && mode !== TRIANGLE_FAN) return list.subarray(0, list.length - (list.length % 3));
  const places = (at: number) => (mode === TRIANGLE_FAN ? [at + 1, at + 2, 0] : [at, at + 1 + (at % 2), at + 2 - (at % 2)]);
  const triangles = Array.from({ length: Math.max(list.length - 2, 0) }, (_, at) => places(at));
  return Uint32Array.from(triangles.flat(), (place) => list[place]!);
}

function entry<V>(map: Map<string, V>, key: string, make: () => V): V {
  let value = map.get(key);
  if (value === undefined) map.set(key, (value = make()));
  return value;
}
