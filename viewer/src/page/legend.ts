// The legend of the colours: on the page, and in saved pictures.

import { COLORS, RAMP, SCALE } from '../scene/frame-material';
import { OUTLINE_COLOR } from '../scene/fault-outline';
import { SEAM_COLOR, VECTOR_COLORS, VECTOR_DASHES } from '../scene/frame-lines';
import { element } from './elements';
import { isLit, VECTORS, type Settings } from '../settings';

/** A colour and its meaning. */
export interface Key {
  color: string;
  text: string;
  /** The second sign beside the colour: stripes, or a line of so many dashes. */
  stripes?: boolean;
  dashes?: number;
}

/** What a legend explains. */
export interface Legend {
  hasScale: boolean;
  keys: Key[];
}

/** The legend for the settings. */
export function legendOf({ paint, layout, vectors, seams, outline }: Settings, hasFault: boolean): Legend {
  const keys: Key[] = [];
  if (paint === 'angle') keys.push({ color: COLORS.flipped, text: 'signs differ', stripes: true }, { color: COLORS.none, text: 'no tangent' });
  if (paint === 'sign' || (isLit(paint) && layout)) keys.push({ color: COLORS.plus, text: 'w = 1' }, { color: COLORS.minus, text: 'w = -1' });
  if (['tangent', 'bitangent', 'normal'].includes(paint)) keys.push({ color: '#ff8080', text: '+x' }, { color: '#80ff80', text: '+y' }, { color: '#8080ff', text: '+z' });
  for (const name of VECTORS) if (vectors[name]) keys.push({ color: VECTOR_COLORS[name], text: name, dashes: VECTOR_DASHES[name] });
  if (seams) keys.push({ color: SEAM_COLOR, text: 'mirrored edge', dashes: 1 });
  if (outline && hasFault) keys.push({ color: OUTLINE_COLOR, text: 'around the fault', dashes: 1 });
  return { hasScale: paint === 'angle', keys };
}

/** Shows the legend. */
export function showLegend({ hasScale, keys }: Legend): void {
  element('legend').replaceChildren(...(hasScale ? [scale()] : []), ...keys.map(shownKey));
}

/** The colour scale of angles. */
function scale(): HTMLElement {
  const box = document.createElement('div');
  box.className = 'scale';
  const bar = document.createElement('div');
  bar.className = 'bar';
  bar.style.background = `linear-gradient(to right, ${RAMP.join(', ')})`;
  const ticks = document.createElement('div');
  ticks.className = 'ticks';
  for (const { text, at } of scaleTicks()) {
    const label = document.createElement('span');
    label.textContent = text;
    label.style.insetInlineStart = `${100 * at}%`;
    ticks.append(label);
  }
  box.append(bar, ticks);
  return box;
}

/** The labels of the scale and their places on it, from 0 to 1. */
export function scaleTicks(): { text: string; at: number }[] {
  const [least, most] = SCALE.ends.map(Math.log);
  return SCALE.ticks.map((tick) => ({ text: `${tick}°`, at: (Math.log(tick) - least) / (most - least) }));
}

function shownKey({ color, text, stripes, dashes }: Key): HTMLElement {
  const box = document.createElement('span');
  box.className = 'key';
  const spot = document.createElement('span');
  spot.className = dashes ? 'line' : 'spot';
  spot.style.background = stripes ? `repeating-linear-gradient(135deg, ${COLORS.stripe} 0 2px, ${color} 2px 5px)` : color;
  if (dashes && dashes > 1) spot.style.background = `repeating-linear-gradient(90deg, ${color} 0 ${60 / dashes}%, transparent ${60 / dashes}% ${100 / dashes}%)`;
  box.append(spot, text);
  return box;
}
