// The first screen of a model: its worst fault. The camera goes there, the light sweeps across it, the slider swings between the file and the cure, and one
// sentence says what is wrong and what the cure costs.

import type { Finding } from 'darboux/check';

import { contentOf } from '../files/glb';
import type { Difference } from '../surface/fault';
import { counted } from '../plural';
import { element } from './elements';
import { placeOf } from './findings-panel';
import { isStill, move } from './motion';
import { severityIcon } from './severity-icon';

/** The slider's position in percent at the end: the fault is in the middle of the picture, left of it. */
const AT_REST = 62;

/** How far the slider swings to both sides, in percent. */
const SWING = 30;

/** How far the light sweeps to both sides, in degrees. */
const SWEEP = 70;

/** The duration of swing and sweep in milliseconds. */
const DURATION = 2400;

/** What a repaired file has more than the file. */
export interface Cost {
  vertices: number;
  bytes: number;
}

/** What the first screen shows, and how it moves things. */
export interface Stage {
  /** Moves the slider to a position in percent. */
  split(percent: number): void;
  /** Turns the light around the model, by degrees from where the controls have it. */
  turnLight(degrees: number): void;
}

/** The finding that the first screen shows: of the most severe ones that with the most places. A whole map has more than any mesh. Notes are no faults. */
export function worstOf(findings: Finding[]): Finding | null {
  const places = ({ mesh, count }: Finding) => (mesh === null ? Infinity : count);
  const of = (wanted: Finding['severity']) => findings.filter(({ severity }) => severity === wanted).sort((a, b) => places(b) - places(a) || 0);
  const [worst] = [...of('error'), ...of('warning')];
  return worst ?? null;
}

/** Swings the slider between both sides once, and sweeps the light across. */
export async function swing(stage: Stage): Promise<void> {
  if (!isStill()) {
    const isWhole = await move(DURATION, (done) => {
      const wave = Math.sin(2 * Math.PI * done);
      stage.split(50 + (AT_REST - 50) * done + SWING * wave);
      stage.turnLight(SWEEP * wave);
    });
    stage.turnLight(0);
    // Who took the slider keeps it.
    if (!isWhole) return;
  }
  stage.split(AT_REST);
}

/** Says what is wrong and what the cure costs. `cost`: null where it is not known; `alike`: the difference where both sides look alike, or null. */
export function showVerdict(worst: Finding, cost: Cost | null, alike: Difference | null, show: () => void): void {
  const text = element('verdict-text');
  const severity = document.createElement('strong');
  severity.className = 'severity';
  severity.append(severityIcon(worst.severity));
  text.replaceChildren(severity, `${placeOf(worst)}: ${worst.text}. ${costOf(worst, cost)}`);
  if (alike) text.append(' ', ...differing(alike, show));
  const box = element('verdict');
  box.dataset.severity = worst.severity;
  box.hidden = false;
}

/** Removes what was said about the model before. */
export function hideVerdict(): void {
  element('verdict').hidden = true;
}

function costOf({ leftBecause }: Finding, cost: Cost | null): string {
  if (leftBecause !== null) return `Not repaired here, because ${leftBecause}.`;
  if (!cost) return '';
  const vertices = cost.vertices > 0 ? `${counted(cost.vertices, 'vertex', 'vertices')} more` : 'no vertex more';
  return `The repaired file has ${vertices} and ${bytesInWords(cost.bytes)}; what is not wrong stays as it is.`;
}

function bytesInWords(bytes: number): string {
  const size = Math.abs(bytes);
  const words = size < 1000 ? counted(size, 'byte', 'bytes') : `${Number((size / (size < 1e6 ? 1e3 : 1e6)).toPrecision(2)).toLocaleString('en')} ${size < 1e6 ? 'kB' : 'MB'}`;
  return `${words} ${bytes < 0 ? 'less' : 'more'}`;
}

function differing({ median, worst, flipped }: Difference, show: () => void): (string | HTMLElement)[] {
  const degrees = (x: number | null) => (x === null ? 'unknown' : `${Number(x.toPrecision(2))}°`);
  const signs = flipped ? `; the signs differ at ${counted(flipped, 'vertex', 'vertices')}` : '';
  const button = document.createElement('button');
  Object.assign(button, { type: 'button', textContent: 'show' });
  button.addEventListener('click', show);
  return [`Both sides look alike from here: they differ by ${degrees(median)} (median), ${degrees(worst)} (worst)${signs}: `, button];
}

/** The vertices of all meshes in a GLB. */
export function verticesIn(glb: Uint8Array<ArrayBuffer>): number {
  const { accessors = [], meshes = [] } = contentOf(glb).json;
  const primitives = meshes.flatMap(({ primitives = [] }) => primitives);
  const positions = new Set(primitives.map(({ attributes }) => attributes?.POSITION).filter((at) => at !== undefined));
  return [...positions].reduce((sum, at) => sum + (accessors[at]?.count ?? 0), 0);
}
