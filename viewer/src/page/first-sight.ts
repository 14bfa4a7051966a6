// The first screen of a model: its worst fault. The camera goes there, the light sweeps across it, the slider swings between the file and the cure, and one
// sentence says what is wrong and what the cure costs.

import type { Finding } from 'darboux/check';

import type { Checked } from '../check/checker';
import { contentOf } from '../files/glb';
import type { Difference } from '../surface/fault';
import { counted } from '../plural';
import { element } from './elements';
import { isRepairable, placeOf } from './findings-panel';
import { isStill, move } from './motion';
import { severityIcon } from './severity-icon';

/** How far the slider swings to both sides, in percent. */
const SWING = 30;

/** How far the light sweeps to both sides, in degrees. */
const SWEEP = 70;

/** Smaller angles in degrees are not told. */
const SMALLEST = 0.01;

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

/** A problem: a finding, and the number of other parts of which a finding says the same. */
export interface Problem {
  finding: Finding;
  others: number;
}

/**
 * The problem that the first screen shows: of the most severe ones one that can be repaired, because its cure can be shown beside it, and of these the one
 * with the most parts; of several the first one, as in the diagnosis. Notes are no problems.
 */
export function worstOf({ findings, statements }: Checked): Problem | null {
  const problems = statements.map((numbers) => numbers.map((number) => findings[number]));
  const isFault = ([{ severity }]: Finding[]) => severity === 'error' || severity === 'warning';
  const rank = (parts: Finding[]) => [Number(parts[0].severity === 'error'), Number(parts.some(isRepairable)), parts.length];
  const isBefore = (a: number[], b: number[]) => a.reduceRight((later, x, at) => (x === b[at] ? later : x > b[at]), false);
  const [first, ...later] = problems.filter(isFault);
  if (!first) return null;
  const worst = later.reduce((worst, parts) => (isBefore(rank(parts), rank(worst)) ? parts : worst), first);
  const finding = worst.reduce((most, part) => (part.count > most.count ? part : most));
  return { finding, others: worst.length - 1 };
}

/** Swings the slider between both sides once, and sweeps the light across. `rest`: the slider's position in percent at the end. */
export async function swing(stage: Stage, rest: number): Promise<void> {
  if (!isStill()) {
    const isWhole = await move(DURATION, (done) => {
      const wave = Math.sin(2 * Math.PI * done);
      stage.split(50 + (rest - 50) * done + SWING * wave);
      stage.turnLight(SWEEP * wave);
    });
    stage.turnLight(0);
    // Who took the slider keeps it.
    if (!isWhole) return;
  }
  stage.split(rest);
}

/**
 * Says what is wrong, what it looks like and what the cure costs. `cost`: null where it is not known; `alike`: where both sides look alike the difference
 * of their tangents, or 'unmeasured', otherwise null.
 */
export function showVerdict({ finding: worst, others }: Problem, cost: Cost | null, alike: Difference | 'unmeasured' | null, show: () => void): void {
  const text = element('verdict-text');
  const severity = document.createElement('span');
  severity.className = 'severity';
  severity.append(severityIcon(worst.severity));
  const what = document.createElement('strong');
  const more = others ? ` and ${counted(others, 'other part', 'other parts')}` : '';
  what.textContent = `${placeOf(worst)}${more}: ${worst.text}.`;
  text.replaceChildren(severity, what, ` ${worst.looksLike} ${costOf(worst, cost)}`);
  if (alike === 'unmeasured') text.append(' Both sides look alike here.');
  else if (alike) text.append(' ', ...differing(alike, show));
  const box = element('verdict');
  box.dataset.severity = worst.severity;
  box.hidden = false;
}

/** Removes what was said about the model before. */
export function hideVerdict(): void {
  element('verdict').hidden = true;
}

function costOf({ leftBecause }: Finding, cost: Cost | null): string {
  if (leftBecause !== null) return 'It is not repaired here; Evidence, in Check, says why.';
  if (!cost) return '';
  const vertices = cost.vertices > 0 ? `${counted(cost.vertices, 'vertex', 'vertices')} more` : 'the same number of vertices';
  const bytes = cost.bytes > 0 ? ` and ${bytesInWords(cost.bytes)} more` : '';
  return `The repaired file has ${vertices}${bytes}.`;
}

function bytesInWords(size: number): string {
  if (size < 1000) return counted(size, 'byte', 'bytes');
  return `${Number((size / (size < 1e6 ? 1e3 : 1e6)).toPrecision(2)).toLocaleString('en')} ${size < 1e6 ? 'kB' : 'MB'}`;
}

function differing({ median, worst, flipped }: Difference, show: () => void): (string | HTMLElement)[] {
  const degrees = (x: number) => `${Number(x.toPrecision(2))}°`;
  const angles = median === null || worst === null || worst < SMALLEST ? [] : [`they differ by ${degrees(median)} (median), ${degrees(worst)} (worst)`];
  const signs = flipped ? [`the signs differ at ${counted(flipped, 'vertex', 'vertices')}`] : [];
  const button = document.createElement('button');
  Object.assign(button, { type: 'button', textContent: 'show' });
  button.addEventListener('click', show);
  const differences = [...angles, ...signs].join('; ');
  return differences ? [`Both sides look alike from here: ${differences}: `, button] : ['Both sides look alike here.'];
}

/** The vertices of all meshes in a GLB. */
export function verticesIn(glb: Uint8Array<ArrayBuffer>): number {
  const { accessors = [], meshes = [] } = contentOf(glb).json;
  const primitives = meshes.flatMap(({ primitives = [] }) => primitives);
  const positions = new Set(primitives.map(({ attributes }) => attributes?.POSITION).filter((at) => at !== undefined));
  return [...positions].reduce((sum, at) => sum + (accessors[at]?.count ?? 0), 0);
}
