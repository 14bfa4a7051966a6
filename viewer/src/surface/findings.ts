// Finds the faults of a surface and its tangents, and their places.

import { generateTangents } from 'darboux';

import { cornerAngles } from './angles';
import { edgePairsOf, mirroredEdges } from './mirrored-edges';
import { computedTangents, tangentsFrom } from './sources';
import type { Surface } from './surface';

/** The kinds of findings. The first three concern a whole part. */
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
  /** The number of corners, triangles or edges; 1 for a finding about the whole part. */
  count: number;
  /** Position and normal, 3 floats each, of at most {@link MAX_PLACES} places. */
  places: Float32Array<ArrayBuffer>;
  /** The largest angle in degrees, which is that of the first place, where angles were compared. */
  worst?: number;
}

/** The limit on places per finding. */
const MAX_PLACES = 200;

/** A length that differs from 1 by more is not unit length, as in the glTF validator. */
const UNIT_TOLERANCE = 0.0005;

/** Smaller angles to a fresh run are rounding or compression. */
const SAME_DEGREES = 1;

/** Checks the structure of a surface, the tangents in its file, and those of a fresh run. Places are those of `shown`, the surface in its pose. */
export function findings(surface: Surface, shown: Surface): Finding[] {
  const { uvs, normals } = surface.without;
  const missing: FindingKind[] = [];
  if (uvs) missing.push('no-uvs');
  if (normals) missing.push('no-normals');
  if (!surface.tangents) missing.push('no-tangents');
  const found: Finding[] = missing.map((kind) => ({ kind, count: 1, places: new Float32Array() }));
  if (uvs) return found;
  const add = (kind: FindingKind, corners: number[], worst?: number) => {
    if (corners.length) found.push({ kind, count: corners.length, places: placesAt(shown, corners), worst });
  };
  const fresh = computedTangents(surface, 'mikktspace');
  const file = tangentsFrom(surface, 'file');
  if (file) checkFileTangents(surface, file, fresh, add);
  add('mixed', mixedSigns(file ?? fresh));
  checkTriangles(surface, add);
  add('repaired', repaired(surface, fresh));
  add('seams', mirroredEdges(fresh, edgePairsOf(surface)));
  return found;
}

/** Adds a finding, unless there are no corners. */
type AddFinding = (kind: FindingKind, corners: number[], worst?: number) => void;

/** Checks the tangents in the file by themselves and against a fresh run. */
function checkFileTangents(surface: Surface, file: Float32Array, fresh: Float32Array, add: AddFinding): void {
  const corners = Array.from({ length: surface.indices.length }, (_, corner) => corner);
  const length = (corner: number) => Math.hypot(file[corner * 4], file[corner * 4 + 1], file[corner * 4 + 2]);
  const isUsable = (corner: number) => Number.isFinite(length(corner)) && length(corner) > 0;
  add('zero', corners.filter((corner) => length(corner) === 0));
  add('not-finite', corners.filter((corner) => !Number.isFinite(length(corner) + file[corner * 4 + 3])));
  add('not-unit', corners.filter((corner) => isUsable(corner) && Math.abs(length(corner) - 1) > UNIT_TOLERANCE));
  add('bad-sign', corners.filter((corner) => Math.abs(file[corner * 4 + 3]) !== 1));
  const between = cornerAngles(file, fresh);
  const apart = corners.filter((corner) => between[corner] > SAME_DEGREES);
  apart.sort((a, b) => between[b] - between[a]);
  add('differs', apart, between[apart[0]]);
  add('flipped', corners.filter((corner) => file[corner * 4 + 3] * fresh[corner * 4 + 3] < 0));
}

/** The first corner of each triangle whose corners have both signs. */
function mixedSigns(tangents: Float32Array): number[] {
  const out: number[] = [];
  for (let corner = 0; corner * 4 < tangents.length; corner += 3) {
    const [a, b, c] = [0, 1, 2].map((i) => tangents[(corner + i) * 4 + 3]);
    if (a * b < 0 || b * c < 0) out.push(corner);
  }
  return out;
}

/** Finds triangles with two equal positions, and others whose UVs span no area. */
function checkTriangles({ indices, positions, uvs }: Surface, add: AddFinding): void {
  const [flat, uvFlat]: [number[], number[]] = [[], []];
  const isSame = (a: number, b: number) => [0, 1, 2].every((i) => positions[a * 3 + i] === positions[b * 3 + i]);
  for (let face = 0; face < indices.length; face += 3) {
    const [a, b, c] = indices.subarray(face, face + 3);
    if (isSame(a, b) || isSame(b, c) || isSame(c, a)) flat.push(face);
    else if (!hasUvArea(uvs, a, b, c)) uvFlat.push(face);
  }
  add('degenerate', flat);
  add('uv-degenerate', uvFlat);
}

/** Whether UVs span an area, in single precision as in the computation of tangents: at least the smallest normal number. */
function hasUvArea(uvs: Float32Array, a: number, b: number, c: number): boolean {
  const { fround } = Math;
  const [ux, uy, vx, vy] = [b, c].flatMap((to) => [fround(uvs[to * 2] - uvs[a * 2]), fround(uvs[to * 2 + 1] - uvs[a * 2 + 1])]);
  return !(Math.abs(fround(fround(ux * vy) - fround(uy * vx))) <= 1.1754943508222875e-38);
}

/** Corners whose reference tangent is unusable and was replaced. */
function repaired(surface: Surface, fresh: Float32Array): number[] {
  const { positions, normals, uvs, indices } = surface;
  const { tangents, report } = generateTangents(positions, normals, uvs, indices, { mode: 'reference', returnReport: true });
  if (!report.repairedCorners) return [];
  const [a, b] = [tangents, fresh].map((field) => new Uint32Array(field.buffer));
  const differs = (corner: number) => [0, 1, 2].some((i) => a[corner * 4 + i] !== b[corner * 4 + i]);
  return Array.from(indices.keys()).filter(differs);
}

/** The positions and normals of the first corners. */
function placesAt({ indices, positions, normals }: Surface, corners: number[]): Float32Array<ArrayBuffer> {
  const out = new Float32Array(Math.min(corners.length, MAX_PLACES) * 6);
  corners.slice(0, MAX_PLACES).forEach((corner, at) => {
    const vertex = indices[corner] * 3;
    out.set(positions.subarray(vertex, vertex + 3), at * 6);
    out.set(normals.subarray(vertex, vertex + 3), at * 6 + 3);
  });
  return out;
}
