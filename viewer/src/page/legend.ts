// The legend of the colours.

import { COLORS, RAMP, SCALE } from '../scene/frame-material';
import { SEAM_COLOR, VECTOR_COLORS } from '../scene/frame-lines';
import { element } from './elements';
import { VECTORS, type Settings } from '../settings';

/** Shows the legend for the settings. */
export function showLegend({ paint, layout, vectors, seams }: Settings): void {
  const legend = element('legend');
  legend.replaceChildren();
  if (paint === 'angle') legend.append(scale(), key(COLORS.flipped, 'signs differ'), key(COLORS.none, 'no tangent'));
  if (paint === 'sign' || (paint === 'shaded' && layout)) {
    legend.append(key(COLORS.plus, 'w = 1'), key(COLORS.minus, 'w = -1'));
  }
  if (['tangent', 'bitangent', 'normal'].includes(paint)) {
    legend.append(key('#ff8080', '+x'), key('#80ff80', '+y'), key('#8080ff', '+z'));
  }
  for (const name of VECTORS) if (vectors[name]) legend.append(key(VECTOR_COLORS[name], name));
  if (seams) legend.append(key(SEAM_COLOR, 'mirrored edge'));
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
  const [least, most] = SCALE.ends.map(Math.log);
  for (const tick of SCALE.ticks) {
    const label = document.createElement('span');
    label.textContent = `${tick}°`;
    label.style.insetInlineStart = `${(100 * (Math.log(tick) - least)) / (most - least)}%`;
    ticks.append(label);
  }
  box.append(bar, ticks);
  return box;
}

function key(color: string, text: string): HTMLElement {
  const box = document.createElement('span');
  box.className = 'key';
  const spot = document.createElement('span');
  spot.className = 'spot';
  spot.style.background = color;
  box.append(spot, text);
  return box;
}
