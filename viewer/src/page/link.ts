// The state of the page in its address, so that a link shows somebody else the same.

import type { Viewport } from '../scene/viewport';
import { element } from './elements';
import { KIND_BOXES } from './further-maps';
import { hiddenParts, hideParts } from './parts-list';
import { showTab, shownTab } from './tabs';

/** The controls whose values a link carries. */
const CONTROLS = ['left', 'right', 'split', 'first-sight', 'outline', 'lines-tangent', 'lines-bitangent', 'lines-normal', 'seams', 'layout', 'wireframe', 'length', 'light-around', 'light-above', 'light', 'exposure', 'surroundings-name', 'surroundings', 'ground', 'bake-rays', 'bake-distance', 'bake-inwards', 'bake-size', 'bake-samples', 'bake-back-faces', 'bake-misses', ...KIND_BOXES];

/** A choice that depends on the model, which a link does not carry. */
const OF_MODEL = 'bake-material';

/** A choice of the person, which stays. */
const PREFERENCE = 'first-sight';

/** The buttons whose state a link carries. */
const BUTTONS = ['flip-green', 'flip-w', 'flip-v'];

/** Writes the state into the address, without a new entry in the history. */
export function writeLink(viewport: Viewport): void {
  const state = new URLSearchParams();
  for (const id of CONTROLS) {
    const control = element<HTMLInputElement>(id);
    const isBox = control.type === 'checkbox';
    if (isBox ? control.checked !== control.defaultChecked : control.value !== defaultOf(control)) state.set(id, isBox ? String(Number(control.checked)) : control.value);
  }
  for (const id of BUTTONS) if (element(id).ariaPressed === 'true') state.set(id, '1');
  const paint = document.querySelector<HTMLInputElement>('input[name=paint]:checked')!.value;
  if (paint !== 'shaded') state.set('paint', paint);
  if (shownTab() !== 'check') state.set('tab', shownTab());
  const hidden = [...hiddenParts()];
  if (hidden.length) state.set('hidden', hidden.join(','));
  state.set('view', viewport.view().map((x) => Number(x.toPrecision(5))).join(','));
  history.replaceState(null, '', `#${state}`);
}

/** Sets the controls by the address. The sources of tangents must be offered already. */
export function readControls(): void {
  const state = new URLSearchParams(location.hash.slice(1));
  for (const id of CONTROLS) {
    const [control, value] = [element<HTMLInputElement>(id), state.get(id)];
    if (value === null) continue;
    if (control.type === 'checkbox') control.checked = value === '1';
    else if (isOffered(control, value)) control.value = value;
    if (control.type === 'range') control.dispatchEvent(new Event('input', { bubbles: true }));
  }
  for (const id of BUTTONS) if (state.has(id) && element(id).ariaPressed !== 'true') element(id).click();
  showTab(state.get('tab') ?? '');
  hideParts((state.get('hidden') ?? '').split(',').filter(Boolean).map(Number));
  const paint = state.get('paint');
  for (const input of document.querySelectorAll<HTMLInputElement>('input[name=paint]')) if (input.value === paint) input.checked = true;
}

/** Whether the address says where the camera is. */
export function hasView(): boolean {
  return new URLSearchParams(location.hash.slice(1)).has('view');
}

/** Moves the camera by the address, if it has one. */
export function readView(viewport: Viewport): void {
  const view = (new URLSearchParams(location.hash.slice(1)).get('view') ?? '').split(',').map(Number);
  if (view.length === 6 && view.every(Number.isFinite)) viewport.setView(view);
}

/** Sets the controls back to what they were when the page opened, except the sources of tangents. */
export function resetControls(): void {
  for (const id of [...CONTROLS, OF_MODEL].filter((id) => id !== PREFERENCE)) {
    const control = element<HTMLInputElement>(id);
    if (control.type === 'checkbox') control.checked = control.defaultChecked;
    else if (defaultOf(control) !== undefined) {
      control.value = defaultOf(control)!;
      control.dispatchEvent(new Event('input', { bubbles: true }));
    }
  }
  for (const id of BUTTONS) if (element(id).ariaPressed === 'true') element(id).click();
  document.querySelector<HTMLInputElement>('input[name=paint]')!.checked = true;
}

/** The value that the page gives a control; none where a model decides. */
function defaultOf(control: HTMLElement): string | undefined {
  if (!(control instanceof HTMLSelectElement)) return (control as HTMLInputElement).defaultValue;
  return [...control.options].find((option) => option.defaultSelected)?.value;
}

/** Whether a value is one of a control's choices. */
function isOffered(control: HTMLElement, value: string): boolean {
  if (!(control instanceof HTMLSelectElement)) return true;
  return [...control.options].some((option) => option.value === value && !option.disabled);
}
