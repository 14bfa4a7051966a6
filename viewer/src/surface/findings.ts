// What is odd about a surface and its tangents, and where.

import { generateTangents } from 'darboux';

import { angles, FLIPPED } from './angles';
import { edgePairsOf, seamCorners } from './mirrored-edges';
import { computedTangents, tangentsFrom } from './sources';
import type { Surface } from './surface';

/** What can be found. The first three are of a whole part. */
export const FINDINGS = [
  'no-uvs',
  'no-normals',
  'no-tangents',
  'zero',
  'not-finite',
  'not-unit',
  'bad-sign',
  'mixed',
  'differs',
  'flipped',
  'degenerate',
  'uv-degenerate',
  'repaired',
  'seams',
] as const;

export type FindingKind = (typeof FINDINGS)[number];

export interface Finding {
  kind: FindingKind;
  /** Of corners, triangles or edges; 1 for what is of the whole part. */
  count: number;
  /** Where: 3 floats each of position and normal, of at most {@link MOST_PLACES}. */
  places: Float32Array<ArrayBuffer>;
  /** Degrees, where angles were compared: the first place's. */
  worst?: number;
}

/** More places than anyone visits. */
const MOST_PLACES = 200;

/** Lengths that differ from 1 by more are not unit: what glTF's validator allows. */
const UNIT_TOLERANCE = 0.0005;

/** Tangents that differ from a fresh run by less are the same but for rounding and compression. */
const SAME_DEGREES = 1;

/** Looks at a surface: its structure, the tangents in the file, and those of a fresh run. `shown`: where its vertices are seen. */
export function findings(surface: Surface, shown: Surface): Finding[] {
  const { uvs, normals } = surface.without;
  const facts: FindingKind[] = [];
  if (uvs) facts.push('no-uvs');
  if (normals) facts.push('no-normals');
  if (!surface.tangents) facts.push('no-tangents');
  const found: Finding[] = facts.map((kind) => ({ kind, count: 1, places: new Float32Array() }));
  if (uvs) return found;
  const note = (kind: FindingKind, corners: number[], worst?: number) => {
    if (corners.length) found.push({ kind, count: corners.length, places: placesAt(shown, corners), worst });
  };
  const fresh = computedTangents(surface, 'mikktspace');
  const file = tangentsFrom(surface, 'file');
  if (file) noteFile(surface, file, fresh, note);
  note('mixed', mixed(file ?? fresh));
  noteShape(surface, note);
  note('repaired', repaired(surface, fresh));
  note('seams', seamCorners(fresh, edgePairsOf(surface)));
  return found;
}

type Note = (kind: FindingKind, corners: number[], worst?: number) => void;

/** The tangents in the file, alone and against a fresh run. */
function noteFile(surface: Surface, file: Float32Array, fresh: Float32Array, note: Note): void {
  const corners = Array.from({ length: surface.indices.length }, (_, corner) => corner);
  const length = (corner: number) => Math.hypot(file[corner * 4], file[corner * 4 + 1], file[corner * 4 + 2]);
  const isUsable = (corner: number) => Number.isFinite(length(corner)) && length(corner) > 0;
  note('zero', corners.filter((corner) => length(corner) === 0));
  note('not-finite', corners.filter((corner) => !Number.isFinite(length(corner) + file[corner * 4 + 3])));
  note('not-unit', corners.filter((corner) => isUsable(corner) && Math.abs(length(corner) - 1) > UNIT_TOLERANCE));
  note('bad-sign', corners.filter((corner) => Math.abs(file[corner * 4 + 3]) !== 1));
  const between = angles(file, fresh);
  const apart = corners.filter((corner) => between[corner] > SAME_DEGREES && between[corner] < FLIPPED);
  apart.sort((a, b) => between[b] - between[a]);
  note('differs', apart, between[apart[0]]);
  note('flipped', corners.filter((corner) => file[corner * 4 + 3] * fresh[corner * 4 + 3] < 0));
}

/** The first corners of faces whose corners have both signs. */
function mixed(tangents: Float32Array): number[] {
  const out: number[] = [];
  for (let corner = 0; corner * 4 < tangents.length; corner += 3) {
    const [a, b, c] = [0, 1, 2].map((i) => tangents[(corner + i) * 4 + 3]);
    if (a * b < 0 || b * c < 0) out.push(corner);
  }
  return out;
}

/** Triangles with two equal positions, and those whose UVs span no area. */
function noteShape({ indices, positions, uvs }: Surface, note: Note): void {
  const [flat, uvFlat]: [number[], number[]] = [[], []];
  const isSame = (a: number, b: number) => [0, 1, 2].every((i) => positions[a * 3 + i] === positions[b * 3 + i]);
  for (let face = 0; face < indices.length; face += 3) {
    const [a, b, c] = indices.subarray(face, face + 3);
    if (isSame(a, b) || isSame(b, c) || isSame(c, a)) flat.push(face);
    else if (!hasUvArea(uvs, a, b, c)) uvFlat.push(face);
  }
  note('degenerate', flat);
  note('uv-degenerate', uvFlat);
}

/** In single precision, as tangents are computed, where less than the least normal number is nothing. */
function hasUvArea(uvs: Float32Array, a: number, b: number, c: number): boolean {
  const { fround } = Math;
  const [ux, uy, vx, vy] = [b, c].flatMap((to) => [fround(uvs[to * 2] - uvs[a * 2]), fround(uvs[to * 2 + 1] - uvs[a * 2 + 1])]);
  return !(Math.abs(fround(fround(ux * vy) - fround(uy * vx))) <= 1.1754943508222875e-38);
}

/** Corners whose reference tangent is unusable, so that it was replaced. */
function repaired(surface: Surface, fresh: Float32Array): number[] {
  const { positions, normals, uvs, indices } = surface;
  const { tangents, report } = generateTangents(positions, normals, uvs, indices, { mode: 'reference', returnReport: true });
  if (!report.repairedCorners) return [];
  const [a, b] = [tangents, fresh].map((field) => new Uint32Array(field.buffer));
  const differs = (corner: number) => [0, 1, 2].some((i) => a[corner * 4 + i] !== b[corner * 4 + i]);
  return Array.from(indices.keys()).filter(differs);
}

/** The position and normal of the first corners. */
function placesAt({ indices, positions, normals }: Surface, corners: number[]): Float32Array<ArrayBuffer> {
  const out = new Float32Array(Math.min(corners.length, MOST_PLACES) * 6);
  corners.slice(0, MOST_PLACES).forEach((corner, at) => {
    const vertex = indices[corner] * 3;
    out.set(positions.subarray(vertex, vertex + 3), at * 6);
    out.set(normals.subarray(vertex, vertex + 3), at * 6 + 3);
  });
  return out;
}
