// The model by keyboard, and the light by hand.

import type { Stage } from '../scene/viewport';
import { element } from './elements';

/** Degrees per key, and how much nearer. */
const TURN = 5;
const NEARER = 1.15;

const DEGREES_PER_PIXEL = 0.5;

const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-TURN, 0],
  ArrowRight: [TURN, 0],
  ArrowUp: [0, TURN],
  ArrowDown: [0, -TURN],
};

/** Takes keys while the model has the focus. */
export function connectKeys(stage: Stage): void {
  element('view').addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = ARROWS[event.key];
    if (arrow && event.shiftKey) moveLight(arrow);
    else if (arrow) stage.orbit(...arrow);
    else if (event.key === '+' || event.key === '=') stage.orbit(0, 0, NEARER);
    else if (event.key === '-') stage.orbit(0, 0, 1 / NEARER);
    else if (event.key === 'Home') stage.lookAtAll();
    else return;
    event.preventDefault();
  });
}

/** With Shift, dragging moves the light instead of the model. */
export function connectLightDrag(): void {
  const view = element('view');
  // Before the orbit's own listener, which must not see it.
  view.addEventListener('pointerdown', (event) => event.shiftKey && begin(event), { capture: true });

  function begin(event: PointerEvent): void {
    event.stopImmediatePropagation();
    view.setPointerCapture(event.pointerId);
    const move = ({ movementX, movementY }: PointerEvent) => moveLight([movementX * DEGREES_PER_PIXEL, -movementY * DEGREES_PER_PIXEL]);
    const end = () => view.removeEventListener('pointermove', move);
    view.addEventListener('pointermove', move);
    view.addEventListener('pointerup', end, { once: true });
    view.addEventListener('pointercancel', end, { once: true });
  }
}

/** Moves the light's controls, around as far as one likes. */
function moveLight([around, above]: [number, number]): void {
  for (const [id, degrees] of [['light-around', around], ['light-above', above]] as const) {
    const input = element<HTMLInputElement>(id);
    const wanted = input.valueAsNumber + degrees;
    input.valueAsNumber = id === 'light-around' ? ((wanted + 540) % 360) - 180 : wanted;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }
}
