// A picture of the model with everything that says what it shows: the divide, the captions, the legend and its scale.

import { COLORS, RAMP } from '../scene/frame-material';
import type { Captions } from './captions';
import { scaleTicks, type Key, type Legend } from './legend';

/** The colours of the page that labels are written in. */
interface Ink {
  paper: string;
  text: string;
  error: string;
}

/** The size of letters in CSS pixels. */
const LETTERS = 14;
/** The space around and between labels in CSS pixels. */
const GAP = 8;
/** The width of the scale of angles in CSS pixels. */
const SCALE_WIDTH = 220;

/** Draws a picture with its labels. `out`: takes the picture's size; `split`: the position of the divide from 0 to 1; `scale`: the picture's pixels per CSS pixel. */
export function drawLabelled(out: HTMLCanvasElement, picture: HTMLCanvasElement, captions: Captions, legend: Legend, split: number, scale: number): void {
  // A new size clears a canvas, which recorders take for a new picture.
  if (out.width !== picture.width || out.height !== picture.height) [out.width, out.height] = [picture.width, picture.height];
  const context = out.getContext('2d')!;
  context.resetTransform();
  context.drawImage(picture, 0, 0);
  context.scale(scale, scale);
  context.font = `${LETTERS}px system-ui, sans-serif`;
  context.textBaseline = 'middle';
  const [width, height] = [picture.width / scale, picture.height / scale];
  const labels = new Labels(context, inkOfPage());
  if (split > 0 && split < 1) {
    context.fillStyle = labels.ink.text;
    context.fillRect(split * width - 1, 0, 2, height);
  }
  labels.side(captions.sides[0], '', GAP, 'left');
  labels.side(captions.sides[1], captions.mistake && `✕ ${captions.mistake}`, width - GAP, 'right');
  if (captions.chip) labels.box([{ text: captions.chip, color: labels.ink.text }], GAP, 3 * GAP + LETTERS + GAP, 'left');
  labels.legend(legend, GAP, height - 4 * GAP - (legend.hasScale ? LETTERS : 0));
}

function inkOfPage(): Ink {
  const style = getComputedStyle(document.documentElement);
  const [paper, text, error] = ['--back', '--front', '--bad'].map((name) => style.getPropertyValue(name).trim());
  return { paper, text, error };
}

/** Writes labels on a canvas. */
class Labels {
  constructor(private readonly context: CanvasRenderingContext2D, readonly ink: Ink) {}

  /** The caption of a side, in a box that ends at `x`. */
  side(name: string, mistake: string, x: number, align: 'left' | 'right'): void {
    const words = [{ text: name, color: this.ink.text }, { text: mistake, color: this.ink.error }].filter(({ text }) => text);
    if (words.length) this.box(words, x, GAP, align);
  }

  /** Words in a box of the page's colour. */
  box(words: { text: string; color: string }[], x: number, top: number, align: 'left' | 'right'): void {
    const { context } = this;
    const width = words.reduce((sum, { text }) => sum + context.measureText(text).width + GAP, GAP);
    let left = align === 'left' ? x : x - width;
    context.fillStyle = this.ink.paper;
    context.fillRect(left, top, width, LETTERS + GAP);
    for (const { text, color } of words) {
      context.fillStyle = color;
      context.fillText(text, left + GAP, top + (LETTERS + GAP) / 2);
      left += context.measureText(text).width + GAP;
    }
  }

  legend({ hasScale, keys }: Legend, left: number, top: number): void {
    const { context } = this;
    if (!hasScale && !keys.length) return;
    const widths = keys.map(({ text }) => context.measureText(text).width + LETTERS + 2 * GAP);
    const width = (hasScale ? SCALE_WIDTH + 4 * GAP : GAP) + widths.reduce((sum, one) => sum + one, 0);
    context.fillStyle = this.ink.paper;
    context.fillRect(left, top, width, LETTERS + 2 * GAP + (hasScale ? LETTERS : 0));
    let at = left + GAP;
    if (hasScale) {
      this.scale(at + GAP, top + GAP);
      at += SCALE_WIDTH + 3 * GAP;
    }
    keys.forEach((key, index) => {
      this.key(key, at, top + GAP);
      at += widths[index];
    });
  }

  private scale(left: number, top: number): void {
    const { context } = this;
    const ramp = context.createLinearGradient(left, 0, left + SCALE_WIDTH, 0);
    RAMP.forEach((color, step) => ramp.addColorStop(step / (RAMP.length - 1), color));
    context.fillStyle = ramp;
    context.fillRect(left, top, SCALE_WIDTH, LETTERS - 2);
    context.fillStyle = this.ink.text;
    context.textAlign = 'center';
    for (const { text, at } of scaleTicks()) context.fillText(text, left + at * SCALE_WIDTH, top + 1.5 * LETTERS + 1);
    context.textAlign = 'left';
  }

  private key({ color, text, stripes, dashes }: Key, left: number, top: number): void {
    const { context } = this;
    context.fillStyle = color;
    if (dashes) for (let dash = 0; dash < dashes; dash++) context.fillRect(left + (dash * LETTERS) / dashes, top + LETTERS / 2 - 1, (LETTERS / dashes) * (dashes > 1 ? 0.6 : 1), 3);
    else context.fillRect(left, top, LETTERS, LETTERS);
    if (stripes) {
      context.fillStyle = COLORS.stripe;
      for (let stripe = 0; stripe < 3; stripe++) context.fillRect(left + 1 + stripe * 5, top, 2, LETTERS);
    }
    context.fillStyle = this.ink.text;
    context.fillText(text, left + LETTERS + GAP / 2, top + LETTERS / 2);
  }
}
