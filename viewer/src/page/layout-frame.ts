// The frame over the UV layout, which takes pointers, the wheel and keys: drag to move, pinch or wheel to zoom, double-click to set back.

import type { LayoutCamera } from '../scene/layout-camera';
import { element } from './elements';

/** The factor of a zoom by one pixel of the wheel, and by one key. */
const [WHEEL, KEY] = [1.002, 1.25];

/** The movement by one key, in sides of the picture. */
const STEP = 0.1;

/** The move, rightwards and upwards, of each key. */
const MOVES: Record<string, [number, number]> = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };

/** Connects the frame with the layout. */
export function connectLayoutFrame(camera: LayoutCamera): void {
  const frame = element('layout-frame');
  frame.addEventListener('wheel', (event) => {
    event.preventDefault();
    camera.zoom(WHEEL ** -event.deltaY, ...placeOf(frame, event));
  }, { passive: false });
  frame.addEventListener('dblclick', () => camera.reset());
  frame.addEventListener('keydown', ({ key }) => {
    if (MOVES[key]) camera.move(...MOVES[key]);
    else if (key === '+' || key === '=') camera.zoom(KEY);
    else if (key === '-') camera.zoom(1 / KEY);
    else if (key === 'Home') camera.reset();
  });
  connectPointers(frame, camera);
}

/** Shows the frame, or hides it. */
export function showLayoutFrame(isShown: boolean): void {
  element('layout-frame').hidden = !isShown;
}

/** One pointer moves the layout, and two zoom it around their middle. */
function connectPointers(frame: HTMLElement, camera: LayoutCamera): void {
  const pressed = new Map<number, [number, number]>();
  frame.addEventListener('pointerdown', (event) => {
    frame.setPointerCapture(event.pointerId);
    pressed.set(event.pointerId, placeOf(frame, event));
  });
  for (const end of ['pointerup', 'pointercancel'] as const) frame.addEventListener(end, ({ pointerId }) => pressed.delete(pointerId));
  frame.addEventListener('pointermove', (event) => {
    const from = pressed.get(event.pointerId);
    if (!from) return;
    const to = placeOf(frame, event);
    const [other] = [...pressed].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    if (other) {
      const apart = (place: [number, number]) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1e-3;
      camera.zoom(apart(to) / apart(from), (to[0] + other[0]) / 2, (to[1] + other[1]) / 2);
    } else camera.move(to[0] - from[0], to[1] - from[1]);
    pressed.set(event.pointerId, to);
  });
}

/** A pointer's place in the frame, from 0 to 1 rightwards and upwards. */
function placeOf(frame: HTMLElement, { clientX, clientY }: MouseEvent): [number, number] {
  const { left, bottom, width, height } = frame.getBoundingClientRect();
  return [(clientX - left) / width, (bottom - clientY) / height];
}
