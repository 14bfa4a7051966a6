// The controls of the page: fills them, reads them, and reports changes.

import { ENVIRONMENTS } from '../scene/studio';
import { isOtherModel, SOURCES, SOURCE_NAMES, type Shown } from '../surface/sources';
import { hiddenParts } from './parts-list';
import { element, isOn, numberOf } from './elements';
import { PAINTS, VECTORS, type Mistakes, type Paint, type Settings } from '../settings';

const PAINT_NAMES: Record<Paint, string> = {
  shaded: 'Shaded',
  bumps: 'Test bumps',
  plain: 'Plain grey',
  tangent: 'Tangent',
  bitangent: 'Bitangent',
  normal: 'Normal',
  sign: 'Sign',
  angle: 'Angle between left and right',
};

/** The choices that a model offers only after a repair or a bake. */
const LATER = ['repaired', 'high', 'baked'] as const;

/** The choices of a side. */
const SHOWN: Shown[] = [...SOURCES, ...LATER];

const MISTAKES = ['green', 'w', 'v'] as const;

/** The name of each mistake in captions. */
const MISTAKE_NAMES: Record<keyof Mistakes, string> = { green: 'green flipped', w: 'w flipped', v: 'V flipped' };

/** The mistakes that are made on the right, for its caption; empty without one. */
export function mistakeCaption(mistakes: Mistakes): string {
  const made = MISTAKES.filter((name) => mistakes[name]).map((name) => MISTAKE_NAMES[name]);
  return made.length ? `mistake: ${made.join(', ')}` : '';
}

/** The description of each mistake. */
const MISTAKE_TEXTS: Record<(typeof MISTAKES)[number], string> = {
  green: 'Green flipped: bumps look like dents along v, everywhere.',
  w: 'w flipped: the bitangent is reversed, as with UVs whose v points the other way. Bumps look like dents along v.',
  v: 'V flipped: textures are upside down or in the wrong place.',
};

/** Callbacks for changes of controls. */
export interface Changes {
  /** The sources of tangents: they must be computed. */
  sources(): void;
  /** Colours, lines, mistakes: the drawing must be rebuilt. */
  look(): void;
  /** The light: a new frame is enough. */
  light(): void;
}

/** Fills the controls and connects them to callbacks. */
export function connectControls(changes: Changes): void {
  for (const [id, source] of [['left', 'mikktspace'], ['right', 'derivatives']] as const) {
    const select = element<HTMLSelectElement>(id);
    select.append(...SHOWN.map((shown) => new Option(SOURCE_NAMES[shown], shown)));
    select.value = source;
    select.addEventListener('change', changes.sources);
  }
  element('paints').append(...PAINTS.map(paintButton));
  element('paints').addEventListener('change', changes.look);
  for (const id of [...VECTORS.map((name) => `lines-${name}`), 'seams', 'outline', 'ground', 'wireframe', 'layout']) {
    element(id).addEventListener('change', changes.look);
  }
  element('length').addEventListener('input', changes.look);
  for (const name of MISTAKES) {
    const button = element(`flip-${name}`);
    button.addEventListener('click', () => {
      button.ariaPressed = String(button.ariaPressed !== 'true');
      const active = MISTAKES.filter((mistake) => isPressed(mistake));
      element('mistake').textContent = active.map((mistake) => MISTAKE_TEXTS[mistake]).join(' ');
      changes.look();
    });
  }
  for (const input of document.querySelectorAll<HTMLInputElement>('input[data-unit]')) {
    const update = () => (input.ariaValueText = `${Math.round(input.valueAsNumber * 10) / 10} ${input.dataset.unit}`);
    input.addEventListener('input', update);
    update();
  }
  for (const id of ['light-around', 'light-above', 'light', 'exposure', 'surroundings', 'surroundings-name']) element(id).addEventListener('input', changes.light);
  element('surroundings-name').append(...ENVIRONMENTS.map(({ name }, at) => new Option(name, name, at === 0)));
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

/** Enables the tangents of the file where there are some, and selects the default sources of a model. */
export function offerSources(hasFile: boolean): void {
  const [left, right] = ['left', 'right'].map((id) => element<HTMLSelectElement>(id));
  for (const select of [left, right]) {
    const file = select.options[SOURCES.indexOf('file')];
    file.disabled = !hasFile;
    file.text = hasFile ? SOURCE_NAMES.file : `${SOURCE_NAMES.file} (none)`;
  }
  [left.value, right.value] = hasFile ? ['file', 'mikktspace'] : ['mikktspace', 'derivatives'];
  offer([...LATER], false);
}

/** Offers the repaired model and shows the file as it is on the left and the repaired model on the right. */
export function chooseRepaired(hasFile: boolean): void {
  const [left, right] = ['left', 'right'].map((id) => element<HTMLSelectElement>(id));
  offer(['repaired'], true);
  [left.value, right.value] = [hasFile ? 'file' : 'derivatives', 'repaired'];
}

/** Offers the high model and the baked map, and shows the one on the left and the other on the right. */
export function chooseBaked(): void {
  offer(['high', 'baked'], true);
  [element<HTMLSelectElement>('left').value, element<HTMLSelectElement>('right').value] = ['high', 'baked'];
}

function offer(choices: (typeof LATER)[number][], isOffered: boolean): void {
  for (const id of ['left', 'right']) {
    for (const choice of choices) {
      const option = element<HTMLSelectElement>(id).options[SHOWN.indexOf(choice)];
      option.hidden = option.disabled = !isOffered;
    }
  }
}

/** Offers the angle between the sides only where both show the same model. */
function offerAngle(isOffered: boolean): void {
  const angle = document.querySelector<HTMLInputElement>('input[name=paint][value=angle]')!;
  angle.disabled = !isOffered;
  if (!isOffered && angle.checked) document.querySelector<HTMLInputElement>('input[name=paint]')!.checked = true;
}

/** The colours of the surface. */
export function chosenPaint(): Paint {
  return document.querySelector<HTMLInputElement>('input[name=paint]:checked')!.value as Paint;
}

/** Chooses the colours of the surface. Returns false where they are not offered. */
export function choosePaint(paint: Paint): boolean {
  const input = document.querySelector<HTMLInputElement>(`input[name=paint][value=${paint}]`)!;
  input.checked ||= !input.disabled;
  return input.checked;
}

/** The settings of all controls. */
export function settings(): Settings {
  const source = (id: string) => element<HTMLSelectElement>(id).value as Shown;
  const sources = [source('left'), source('right')] as const;
  offerAngle(!sources.some(isOtherModel));
  return {
    sources,
    paint: chosenPaint(),
    vectors: { tangent: isOn('lines-tangent'), bitangent: isOn('lines-bitangent'), normal: isOn('lines-normal') },
    length: numberOf('length') / 100,
    seams: isOn('seams'),
    outline: isOn('outline'),
    ground: isOn('ground'),
    wireframe: isOn('wireframe'),
    hidden: hiddenParts(),
    layout: isOn('layout'),
    mistakes: { green: isPressed('green'), w: isPressed('w'), v: isPressed('v') },
  };
}
