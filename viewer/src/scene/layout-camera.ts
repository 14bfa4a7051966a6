// The part of the UV layout that is shown: moved, zoomed, and set back.

import { OrthographicCamera } from 'three';

/** A square of UVs: its left, its bottom and its side. */
export type UvSquare = [left: number, bottom: number, size: number];

/** The margin around the whole layout, relative to its side. */
const MARGIN = 0.02;

/** The largest and the smallest side, relative to that of the whole layout. */
const SIDES = [1e-4, 4] as const;

export class LayoutCamera {
  readonly camera = new OrthographicCamera(0, 1, 1, 0, -1, 1);
  private whole: UvSquare = [0, 0, 1];
  private shown: UvSquare = [0, 0, 1];

  /** `changed` is called after every change. */
  constructor(private readonly changed: () => void) {}

  /** Sets the whole layout, and shows it. */
  setWhole([left, bottom, size]: UvSquare): void {
    const margin = MARGIN * size;
    this.whole = [left - margin, bottom - margin, size + 2 * margin];
    this.reset();
  }

  /** Shows the whole layout. */
  reset(): void {
    this.show(this.whole);
  }

  /** Moves the layout to the right and upwards, in sides of the picture. */
  move(right: number, up: number): void {
    const [left, bottom, size] = this.shown;
    this.show([left - right * size, bottom - up * size, size]);
  }

  /** Makes the layout larger by a factor around a place of the picture, from 0 to 1 rightwards and upwards. */
  zoom(factor: number, x = 0.5, y = 0.5): void {
    const [left, bottom, size] = this.shown;
    const to = Math.min(Math.max(size / factor, SIDES[0] * this.whole[2]), SIDES[1] * this.whole[2]);
    this.show([left + x * (size - to), bottom + y * (size - to), to]);
  }

  private show(square: UvSquare): void {
    const [left, bottom, size] = (this.shown = square);
    Object.assign(this.camera, { left, bottom, right: left + size, top: bottom + size });
    this.camera.updateProjectionMatrix();
    this.changed();
  }
}
