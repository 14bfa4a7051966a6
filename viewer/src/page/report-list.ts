// The list of findings. A click leads to the places of a finding, one after the other.

import type { Finding, FindingKind } from '../surface/findings';
import { element } from './elements';
import { counted } from '../plural';

/** A finding, and the part of the model that it concerns. */
export interface Found extends Finding {
  part: number;
  partName: string;
}

/** The text for one and for several. */
const TEXTS: Record<FindingKind, [string, string]> = {
  'no-uvs': ['No texture coordinates, so no tangents', ''],
  'no-normals': ['No normals: shown flat, and skipped by the export', ''],
  'no-tangents': ['No tangents in the file', ''],
  zero: ['corner with a zero tangent', 'corners with a zero tangent'],
  'not-finite': ['corner with a tangent that is not finite', 'corners with tangents that are not finite'],
  'not-unit': ['corner whose tangent is not of unit length', 'corners whose tangents are not of unit length'],
  'bad-sign': ['corner whose w is neither 1 nor -1', 'corners whose w is neither 1 nor -1'],
  mixed: ['triangle with both signs', 'triangles with both signs'],
  differs: ['corner differs from a fresh run', 'corners differ from a fresh run'],
  flipped: ['corner with the opposite sign of a fresh run', 'corners with the opposite sign of a fresh run'],
  degenerate: ['degenerate triangle', 'degenerate triangles'],
  'uv-degenerate': ['triangle without area in the UVs', 'triangles without area in the UVs'],
  repaired: ['corner that needs repair', 'corners that need repair'],
  seams: ['mirrored edge', 'mirrored edges'],
};

/** The findings that are not faults. */
const NOT_FAULTS: FindingKind[] = ['seams', 'no-tangents'];

/** Moves the camera to a place of a finding. Returns its coordinates in the scene. */
export type Visit = (finding: Found, place: number) => number[];

/** Lists findings. A click calls `visit` with the next place. */
export function showReport(found: Found[], visit: Visit): void {
  element('report').replaceChildren(...found.map((finding) => row(finding, visit)));
  const faults = found.filter(({ kind }) => !NOT_FAULTS.includes(kind));
  element('report-none').textContent = faults.length ? '' : 'No faults found.';
}

/** Clears the list. */
export function clearReport(): void {
  element('report').replaceChildren();
  element('report-none').textContent = '';
}

function row(finding: Found, visit: Visit): HTMLElement {
  const item = document.createElement('li');
  item.dataset.kind = finding.kind;
  const places = finding.places.length / 6;
  const text = `${sentence(finding)}: ${finding.partName}`;
  if (!places) {
    item.textContent = text;
    return item;
  }
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'place';
  button.textContent = text;
  let next = 0;
  button.addEventListener('click', () => {
    // Single precision has about seven decimal digits.
    const at = visit(finding, next).map((x) => Number(x.toPrecision(7)));
    element('status').textContent = `${text}, place ${next + 1} of ${places < finding.count ? `the first ${places} of ${finding.count}` : places}, at (${at.join(', ')})`;
    next = (next + 1) % places;
  });
  item.append(button);
  return item;
}

function sentence({ kind, count, worst }: Finding): string {
  const [one, many] = TEXTS[kind];
  if (!many) return one;
  const by = worst === undefined ? '' : `, by up to ${worst.toFixed(1)}°`;
  return counted(count, one, many) + by;
}
