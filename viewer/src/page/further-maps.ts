// The maps of a bake beside the normal map: a checkbox for each kind, and each baked map with its picture and a button that saves it.

import type { ShownBake } from '../bake/baker';
import { FURTHER_KINDS, type FurtherKind, type FurtherMap } from '../bake/map-texels';
import { nameLike, save } from './download';
import { element, isOn } from './elements';

/** The ids of the checkboxes. */
export const KIND_BOXES = FURTHER_KINDS.map(boxOf);

/** Makes the checkboxes and the places of the maps. `changed` is called after a choice; `nameOf` returns the name of the low model. */
export function connectFurtherMaps(changed: () => void, nameOf: () => string): void {
  for (const kind of FURTHER_KINDS) {
    const label = document.createElement('label');
    label.className = 'tick';
    const input = document.createElement('input');
    Object.assign(input, { type: 'checkbox', id: boxOf(kind) });
    input.addEventListener('input', changed);
    label.append(input, ` ${kind}`);
    element('bake-kinds').append(label);
    element('bake-maps').append(figure(kind, nameOf));
  }
}

/** The kinds that are chosen. */
export function chosenKinds(): FurtherKind[] {
  return FURTHER_KINDS.filter((kind) => isOn(boxOf(kind)));
}

/** Shows the further maps of a bake, or none. Figures stay in the page, so that a button keeps the focus while maps are baked again. */
export function showFurtherMaps(bake: ShownBake | null): void {
  for (const kind of FURTHER_KINDS) {
    const map = bake?.further.find((one) => one.kind === kind);
    const out = element(figureOf(kind));
    out.hidden = !map;
    const canvas = out.querySelector('canvas')!;
    // A canvas without texels frees its memory.
    Object.assign(canvas, map ? { width: bake!.width, height: bake!.height } : { width: 0, height: 0 });
    if (!map) continue;
    canvas.getContext('2d')!.putImageData(new ImageData(map.texels, canvas.width, canvas.height), 0, 0);
    out.querySelector('.faint')!.textContent = rangeText(map);
  }
}

function boxOf(kind: FurtherKind): string {
  return `bake-kind-${kind}`;
}

function figureOf(kind: FurtherKind): string {
  return `bake-figure-${kind}`;
}

function figure(kind: FurtherKind, nameOf: () => string): HTMLElement {
  const out = document.createElement('figure');
  Object.assign(out, { id: figureOf(kind), hidden: true });
  const canvas = document.createElement('canvas');
  canvas.setAttribute('role', 'img');
  canvas.ariaLabel = `The baked map ${kind} over the UV layout`;
  const range = document.createElement('span');
  range.className = 'faint';
  const button = document.createElement('button');
  Object.assign(button, { type: 'button', textContent: `Save ${kind}` });
  button.addEventListener('click', () => canvas.toBlob((blob) => blob && save(nameLike(nameOf(), `.${kind}.png`), blob), 'image/png'));
  const caption = document.createElement('figcaption');
  caption.append(button, range);
  out.append(canvas, caption);
  return out;
}

/** What black and white stand for, unless that is the same for all maps of a kind. */
function rangeText({ ranges }: FurtherMap): string {
  if (ranges.every(([black, white]) => white === 1 && (black === 0 || black === -1))) return '';
  const texts = ranges.map(([black, white]) => `${black.toPrecision(3)} to ${white.toPrecision(3)}`);
  return `Black to white: ${new Set(texts).size === 1 ? texts[0] : texts.join(', ')}`;
}
