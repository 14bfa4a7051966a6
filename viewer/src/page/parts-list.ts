// The list of parts, each of which can be hidden.

import { element } from './elements';

/** The largest number of parts that are listed. */
const MAX_PARTS = 300;

/** Lists the parts of a new model, all visible. One part alone is not listed. `changed` is called after every change. */
export function listParts(names: string[], changed: () => void): void {
  element('parts').hidden = names.length < 2;
  element('parts-list').replaceChildren(...names.slice(0, MAX_PARTS).map((name, at) => tick(name, at, changed)));
}

/** The numbers of the hidden parts. */
export function hiddenParts(): Set<number> {
  const boxes = element('parts-list').querySelectorAll<HTMLInputElement>('input:not(:checked)');
  return new Set([...boxes].map((box) => Number(box.value)));
}

/** Hides parts by their numbers. Numbers of parts that do not exist are ignored. */
export function hideParts(numbers: number[]): void {
  for (const box of element('parts-list').querySelectorAll<HTMLInputElement>('input')) if (numbers.includes(Number(box.value))) box.checked = false;
}

function tick(name: string, at: number, changed: () => void): HTMLElement {
  const label = document.createElement('label');
  label.className = 'tick';
  const box = document.createElement('input');
  Object.assign(box, { type: 'checkbox', checked: true, value: String(at) });
  box.addEventListener('change', changed);
  label.append(box, ` ${name}`);
  return label;
}
