// The values at the corner under the pointer. A click pins them, and Escape or a click beside the model frees them.

import type { Values } from '../scene/model-view';
import type { Picked, Viewport } from '../scene/viewport';
import { SOURCE_NAMES, type Shown } from '../surface/sources';
import { element } from './elements';

/** Moves in pixels between press and release that are still a click. */
const CLICK = 4;

/** What the panel asks the application for. */
export interface ValuesHost {
  viewport: Viewport;
  /** The values at a picked corner, and what its side shows. */
  valuesAt(picked: Picked): { values: Values; shown: Shown };
  /** Marks a corner of the model; null removes the mark. */
  mark(picked: Picked | null): void;
  /** Whether the model is small enough to be searched while the pointer moves. */
  isQuick(): boolean;
}

export class ValuesPanel {
  private isPinned = false;
  private requestedFrame = 0;

  constructor(private readonly host: ValuesHost) {
    const view = element('view');
    let pressed = { x: 0, y: 0 };
    view.addEventListener('pointerdown', ({ clientX: x, clientY: y }) => (pressed = { x, y }));
    view.addEventListener('pointerup', (event) => {
      const isClick = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y) <= CLICK;
      if (isClick && event.button === 0 && !event.shiftKey) this.pin(event.offsetX, event.offsetY);
    });
    view.addEventListener('pointermove', (event) => event.buttons || event.pointerType === 'touch' || this.hover(event.offsetX, event.offsetY));
    view.addEventListener('pointerleave', () => this.isPinned || this.hide());
    view.addEventListener('keydown', ({ key }) => {
      if (key === 'Escape') this.free();
      if (key === 'Enter') this.pin(view.clientWidth * (0.5 - 1e-3), view.clientHeight / 2);
    });
    element('unpin').addEventListener('click', () => this.free());
  }

  /** Hides the values and frees them. */
  free(): void {
    if (this.isPinned) this.host.mark(null);
    this.isPinned = false;
    this.hide();
  }

  private pin(x: number, y: number): void {
    const picked = this.host.viewport.pick(x, y);
    if (!picked) return this.free();
    this.isPinned = true;
    this.show(picked);
    this.host.mark(picked);
  }

  /** Shows what is under the pointer, once per frame. */
  private hover(x: number, y: number): void {
    if (this.isPinned || !this.host.isQuick()) return;
    cancelAnimationFrame(this.requestedFrame);
    this.requestedFrame = requestAnimationFrame(() => {
      const picked = this.isPinned ? null : this.host.viewport.pick(x, y);
      if (picked) this.show(picked);
      else if (!this.isPinned) this.hide();
    });
  }

  private hide(): void {
    cancelAnimationFrame(this.requestedFrame);
    element('values').hidden = true;
  }

  private show(picked: Picked): void {
    const { values, shown } = this.host.valuesAt(picked);
    const { partName, triangle, corner, vertex, position, normal, tangent, uv, angle } = values;
    const rows: [string, string][] = [
      [SOURCE_NAMES[shown], partName],
      ['Triangle, corner, vertex', `${triangle}, ${corner}, ${vertex}`],
      ['Position', numbers(position)],
      ['Normal', numbers(normal)],
      ['Tangent', tangent ? numbers(tangent.slice(0, 3)) : 'none'],
      ['w', tangent ? String(tangent[3]) : 'none'],
      ['UV', uv ? numbers(uv) : 'none'],
      ['Angle to the other side', angle === null ? 'none' : `${Number(angle.toPrecision(3))}°`],
    ];
    const cells = rows.flatMap(([name, value]) => [cell('dt', name), cell('dd', value)]);
    element('values-list').replaceChildren(...cells);
    element('unpin').hidden = !this.isPinned;
    element('values').hidden = false;
  }
}

function cell(tag: string, text: string): HTMLElement {
  const out = document.createElement(tag);
  out.textContent = text;
  return out;
}

function numbers(values: number[]): string {
  return values.map((x) => Number(x.toPrecision(5))).join(', ');
}
