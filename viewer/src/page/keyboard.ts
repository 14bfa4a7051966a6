// Keyboard control of the camera, and dragging of the light.

import type { Viewport } from '../scene/viewport';
import { element } from './elements';

/** Degrees per key press. */
const TURN = 5;
/** The zoom factor per key press. */
const ZOOM = 1.15;

const DEGREES_PER_PIXEL = 0.5;

const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-TURN, 0],
  ArrowRight: [TURN, 0],
  ArrowUp: [0, TURN],
  ArrowDown: [0, -TURN],
};

/** Handles keys while the model has the focus. */
export function connectKeys(viewport: Viewport): void {
  element('view').addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const arrow = ARROWS[event.key];
    if (arrow && event.shiftKey) moveLight(arrow);
    else if (arrow) viewport.orbit(...arrow);
    else if (event.key === '+' || event.key === '=') viewport.orbit(0, 0, ZOOM);
    else if (event.key === '-') viewport.orbit(0, 0, 1 / ZOOM);
    else if (event.key === 'Home') viewport.lookAtAll();
    else return;
    event.preventDefault();
  });
}

/** Dragging with Shift moves the light instead of the camera. */
export function connectLightDrag(): void {
  const view = element('view');
  // In the capture phase, so that the orbit controls do not get the event.
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

/** Moves the controls of the light. The azimuth wraps around. */
function moveLight([around, above]: [number, number]): void {
  for (const [id, degrees] of [['light-around', around], ['light-above', above]] as const) {
    const input = element<HTMLInputElement>(id);
    const wanted = input.valueAsNumber + degrees;
    input.valueAsNumber = id === 'light-around' ? ((wanted + 540) % 360) - 180 : wanted;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }
}
