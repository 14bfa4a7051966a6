// The model by keyboard.

import type { Stage } from '../scene/stage';
import { element } from './elements';

/** Degrees per key, and how much nearer. */
const TURN = 5;
const NEARER = 1.15;

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

/** Moves the light's controls, as a hand would. */
function moveLight([around, above]: [number, number]): void {
  for (const [id, degrees] of [['light-around', around], ['light-above', above]] as const) {
    const input = element<HTMLInputElement>(id);
    input.valueAsNumber += degrees;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }
}
