// The controls: what they say, and when they change.

import { SOURCES, SOURCE_NAMES, type Source } from '../surface/sources';
import { element, isOn, numberOf } from './elements';
import { PAINTS, VECTORS, type Paint, type Settings } from '../settings';

const PAINT_NAMES: Record<Paint, string> = {
  shaded: 'Shaded',
  tangent: 'Tangent',
  bitangent: 'Bitangent',
  normal: 'Normal',
  sign: 'Sign',
  angle: 'Angle between left and right',
};

const MISTAKES = ['green', 'w', 'v'] as const;

/** What each mistake is, and what it looks like. */
const MISTAKE_TEXTS: Record<(typeof MISTAKES)[number], string> = {
  green: 'Green flipped: bumps are lit as dents along v, everywhere alike.',
  w: 'w flipped: the bitangent points the other way, as with UVs whose v runs the other way. Bumps are lit as dents along v.',
  v: 'V flipped: textures stand on their heads, or land where they do not belong.',
};

/** What a change of a control asks for: computing, building anew, or drawing again. */
export interface Changes {
  sources(): void;
  look(): void;
  light(): void;
}

/** Fills the controls, and says when they change. */
export function connectControls(changes: Changes): void {
  for (const [id, source] of [['left', 'mikktspace'], ['right', 'derivatives']] as const) {
    const select = element<HTMLSelectElement>(id);
    select.append(...SOURCES.map((source) => new Option(SOURCE_NAMES[source], source)));
    select.value = source;
    select.addEventListener('change', changes.sources);
  }
  element('paints').append(...PAINTS.map(paintButton));
  element('paints').addEventListener('change', changes.look);
  for (const id of [...VECTORS.map((name) => `lines-${name}`), 'seams', 'layout', 'pattern']) {
    element(id).addEventListener('change', changes.look);
  }
  element('length').addEventListener('input', changes.look);
  for (const name of MISTAKES) {
    const button = element(`flip-${name}`);
    button.addEventListener('click', () => {
      button.ariaPressed = String(button.ariaPressed !== 'true');
      const made = MISTAKES.filter((mistake) => isPressed(mistake));
      element('mistake').textContent = made.map((mistake) => MISTAKE_TEXTS[mistake]).join(' ');
      changes.look();
    });
  }
  for (const input of document.querySelectorAll<HTMLInputElement>('input[data-unit]')) {
    const tell = () => (input.ariaValueText = `${Math.round(input.valueAsNumber * 10) / 10} ${input.dataset.unit}`);
    input.addEventListener('input', tell);
    tell();
  }
  for (const id of ['light-around', 'light-above', 'light', 'surroundings']) element(id).addEventListener('input', changes.light);
}

function paintButton(paint: Paint): HTMLElement {
  const label = document.createElement('label');
  label.className = 'tick';
  const input = document.createElement('input');
  Object.assign(input, { type: 'radio', name: 'paint', value: paint, checked: paint === 'shaded' });
  label.append(input, ` ${PAINT_NAMES[paint]}`);
  return label;
}

function isPressed(mistake: (typeof MISTAKES)[number]): boolean {
  return element(`flip-${mistake}`).ariaPressed === 'true';
}

/** Offers the tangents of the file only where there are some, and chooses what the model is best shown with. */
export function offerSources(hasFile: boolean): void {
  const [left, right] = ['left', 'right'].map((id) => element<HTMLSelectElement>(id));
  for (const select of [left, right]) {
    const file = select.options[SOURCES.indexOf('file')];
    file.disabled = !hasFile;
    file.text = hasFile ? SOURCE_NAMES.file : `${SOURCE_NAMES.file} (none)`;
  }
  [left.value, right.value] = hasFile ? ['file', 'mikktspace'] : ['mikktspace', 'derivatives'];
}

/** What the controls say. */
export function settings(): Settings {
  const source = (id: string) => element<HTMLSelectElement>(id).value as Source;
  const paint = document.querySelector<HTMLInputElement>('input[name=paint]:checked')!.value as Paint;
  return {
    sources: [source('left'), source('right')],
    paint,
    vectors: { tangent: isOn('lines-tangent'), bitangent: isOn('lines-bitangent'), normal: isOn('lines-normal') },
    length: numberOf('length') / 100,
    seams: isOn('seams'),
    layout: isOn('layout'),
    pattern: isOn('pattern'),
    mistakes: { green: isPressed('green'), w: isPressed('w'), v: isPressed('v') },
  };
}
