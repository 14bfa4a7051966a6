// The normal maps of the model, each with its verdict and, over it, the tiles that voted.

import type { MapJudgement } from 'darboux/check';

import type { JudgedMap } from '../check/judge-maps';
import { element, isOn } from './elements';

/** The width of a picture in pixels of the screen's full resolution. */
const WIDTH = 640;

/** The colours of votes; triangles that point up or down say the same. */
const VOTE_COLORS = { up: '#3d8bd9', down: '#e8873a' } as const;

/** The smallest triangle in pixels that can be told from its opposite. */
const MIN_TRIANGLE = 8;

/** A map as it is in the file, or after the repair. */
export interface ShownMap extends JudgedMap {
  isRepaired: boolean;
}

/** Shows maps; none hides the section. */
export function showMaps(maps: ShownMap[]): void {
  element('maps-section').hidden = !maps.length;
  element('maps').replaceChildren(...maps.map(figure));
}

/** Connects the switch of the tiles. */
export function connectMaps(): void {
  element('tiles').addEventListener('change', () => {
    for (const redraw of redraws.values()) redraw();
  });
}

/** Brings the map of an image into view. Returns whether it is shown. */
export function visitMap(image: number): boolean {
  const found = element('maps').querySelector<HTMLElement>(`[data-image="${image}"]`);
  found?.scrollIntoView({ block: 'nearest' });
  found?.focus({ preventScroll: true });
  return found !== null;
}

/** Draws the picture of a figure again, per figure on the page. */
const redraws = new Map<HTMLElement, () => void>();

function figure(map: ShownMap): HTMLElement {
  const out = document.createElement('figure');
  out.dataset.image = String(map.image);
  out.tabIndex = -1;
  for (const old of redraws.keys()) if (!old.isConnected) redraws.delete(old);
  const caption = document.createElement('figcaption');
  const title = document.createElement('strong');
  title.textContent = `${map.isRepaired ? 'After the repair: ' : ''}${map.name} (${map.materials.join(', ')})`;
  const verdict = document.createElement('span');
  verdict.className = 'verdict';
  verdict.textContent = verdictOf(map.judgement);
  caption.append(title, verdict);
  if (map.judgement) caption.append(votesOf(map.judgement));
  if (map.picture) {
    const canvas = document.createElement('canvas');
    canvas.setAttribute('role', 'img');
    canvas.ariaLabel = `The normal map ${map.name}. ${verdict.textContent}`;
    redraws.set(out, () => draw(canvas, map));
    draw(canvas, map);
    out.append(canvas);
  }
  out.append(caption);
  return out;
}

/** A probability in percent, rounded down, as the command prints it: nothing is 100 % sure. */
function sureOf(probability: number): string {
  return `${(Math.min(Math.floor(1000 * probability + 1e-3), 999) / 10).toFixed(1)} %`;
}

/** The verdict in a sentence. */
function verdictOf(judgement: MapJudgement | null): string {
  if (!judgement) return 'The image cannot be decoded.';
  const sure = `${sureOf(judgement.confidence)} sure`;
  switch (judgement.verdict) {
    case 'opengl':
      return `OpenGL: green points up, as glTF wants it (${sure}).`;
    case 'directx':
      return `DirectX: green points down, so bumps look like dents in glTF (${sure}).`;
    case 'no_gradient':
      return 'No gradient: its texels are not the slopes of a surface.';
    case 'flat':
      return 'Flat: all texels are the same, so it changes nothing.';
    default:
      return 'Its texels do not tell whether green points up or down.';
  }
}

/** The number of tiles that voted for each direction. */
function votesOf({ tiles: { correlations } }: MapJudgement): HTMLElement {
  const out = document.createElement('span');
  out.className = 'votes';
  const count = (test: (vote: number) => boolean) => correlations.filter((vote) => vote !== null && test(vote)).length.toLocaleString('en');
  const silent = correlations.filter((vote) => vote === null).length.toLocaleString('en');
  for (const [name, content] of [
    ['up', `▲ ${count((vote) => vote > 0)} tiles for up`],
    ['down', `▼ ${count((vote) => vote <= 0)} for down`],
    ['silent', `${silent} without a vote`],
  ]) {
    const part = document.createElement('span');
    part.dataset.vote = name;
    part.textContent = content;
    out.append(part);
  }
  return out;
}

/** Draws a map and, where they are switched on, its tiles: opaque where a tile is certain. */
function draw(canvas: HTMLCanvasElement, { picture, width, height, judgement }: ShownMap): void {
  const scale = WIDTH / width;
  [canvas.width, canvas.height] = [WIDTH, Math.max(1, Math.round(height * scale))];
  const context = canvas.getContext('2d')!;
  context.drawImage(picture!, 0, 0, canvas.width, canvas.height);
  if (!judgement || !isOn('tiles')) return;
  const { side, columns, correlations } = judgement.tiles;
  const step = side * scale;
  for (const [at, vote] of correlations.entries()) {
    if (vote === null) continue;
    const [x, y] = [(at % columns) * step, Math.floor(at / columns) * step];
    context.globalAlpha = 0.1 + 0.35 * Math.min(1, Math.abs(vote));
    context.fillStyle = vote > 0 ? VOTE_COLORS.up : VOTE_COLORS.down;
    context.fillRect(x, y, step, step);
    if (step >= MIN_TRIANGLE) triangle(context, x, y, step, vote > 0);
  }
  context.globalAlpha = 1;
}

/** A triangle that points up or down, in the middle of a tile. */
function triangle(context: CanvasRenderingContext2D, x: number, y: number, side: number, isUp: boolean): void {
  const [base, tip] = isUp ? [0.7, 0.3] : [0.3, 0.7];
  context.globalAlpha = 1;
  context.fillStyle = '#fff';
  context.beginPath();
  context.moveTo(x + 0.3 * side, y + base * side);
  context.lineTo(x + 0.7 * side, y + base * side);
  context.lineTo(x + 0.5 * side, y + tip * side);
  context.fill();
}
