// The layout of the page: the slider between both sides, which is dragged at its line, too, and the sheet of small screens.

import { element } from './elements';

/** Connects the slider and its line in the picture. `moved` is called now and after every move. */
export function connectSplit(moved: () => void): void {
  const [input, divider] = [element<HTMLInputElement>('split'), element('divider')];
  input.addEventListener('input', moved);
  divider.addEventListener('pointerdown', (event) => {
    divider.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  divider.addEventListener('pointermove', (event) => {
    if (!divider.hasPointerCapture(event.pointerId)) return;
    const { left, width } = divider.parentElement!.getBoundingClientRect();
    input.valueAsNumber = (100 * (event.clientX - left)) / width;
    moved();
  });
  moved();
}

/** Connects the button that opens and closes the sheet. */
export function connectSheet(): void {
  const button = element('sheet');
  button.addEventListener('click', () => {
    const isClosed = element('panel').classList.toggle('is-closed');
    button.ariaExpanded = String(!isClosed);
  });
}
