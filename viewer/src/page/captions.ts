// What stands over the picture: the names of both sides, with the mistakes made on the right, and a chip where the surface shows what is not in the file.

import { SOURCE_NAMES } from '../surface/sources';
import { takesBumps } from '../scene/side-geometry';
import type { Part } from '../scene/model-parts';
import { counted } from '../plural';
import { mistakeCaption } from './controls';
import { element } from './elements';
import type { Paint, Settings } from '../settings';

/** The texts over a picture. */
export interface Captions {
  /** The names of the sides. */
  sides: [string, string];
  /** The mistakes made on the right; empty without one. */
  mistake: string;
  /** What the surface shows that is not in the file; empty for nothing. */
  chip: string;
}

/** The captions for settings. */
export function captionsOf({ sources, mistakes, paint }: Settings, parts: Part[]): Captions {
  const [left, right] = sources.map((source) => SOURCE_NAMES[source]);
  const bumpy = parts.filter(takesBumps).length;
  const bumps = bumpy ? `Test bumps: not in the file, on ${counted(bumpy, 'part', 'parts')}` : 'Test bumps: no part lacks a normal map';
  const chips: Partial<Record<Paint, string>> = { bumps, plain: 'Plain grey, without the colours of the file' };
  return { sides: [left, right], mistake: mistakeCaption(mistakes), chip: chips[paint] ?? '' };
}

/** Shows captions. */
export function showCaptions({ sides, mistake, chip }: Captions): void {
  element('caption-left').textContent = sides[0];
  const made = document.createElement('strong');
  made.className = 'made';
  made.textContent = mistake && `✕ ${mistake}`;
  element('caption-right').replaceChildren(sides[1], ...(mistake ? [' ', made] : []));
  element('chips').replaceChildren(...(chip ? [chipOf(chip)] : []));
}

/** A chip with a button that shows the surface as it is in the file. */
function chipOf(text: string): HTMLElement {
  const button = document.createElement('button');
  Object.assign(button, { type: 'button', className: 'chip', textContent: `${text} ✕`, title: 'Show the surface as it is in the file' });
  button.addEventListener('click', () => {
    const shaded = document.querySelector<HTMLInputElement>('input[name=paint][value=shaded]')!;
    shaded.checked = true;
    shaded.dispatchEvent(new Event('change', { bubbles: true }));
    element('view').focus();
  });
  return button;
}
