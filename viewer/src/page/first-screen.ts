// The first screen of a model: finds the view and the surface on which the worst fault is seen best, goes there, and draws the outline of the fault.

import type { Finding } from 'darboux/check';
import { Matrix3, Vector3 } from 'three';

import description from '../../../crates/darboux-render/src/studio.json';
import type { Checked } from '../check/checker';
import type { View } from '../scene/camera-flight';
import { outlineLines } from '../scene/fault-outline';
import { placesOf, type Part } from '../scene/model-parts';
import type { SeenDifference } from '../scene/seen-difference';
import type { Viewport } from '../scene/viewport';
import { isLit, type Paint, type Settings } from '../settings';
import type { Comparison } from '../surface/comparison';
import { differenceOf, faultOf, type Fault } from '../surface/fault';
import { chosenPaint, choosePaint } from './controls';
import { element, numberOf } from './elements';
import { hideVerdict, showVerdict, swing, worstOf, type Cost, type Problem } from './first-sight';
import { isRepairable } from './findings-panel';

/** The most triangles of a model whose worst place is searched. */
const SEARCHED_TRIANGLES = 300_000;

/** The time in milliseconds after which no further view is tried. */
const SEARCH_TIME = 700;

/** The radius around the worst place that is in view, relative to the model's radius. */
const CLOSE_UP = 0.45;

/** The share of a model's triangles from which a fault is everywhere, and has no outline. */
const MOST_OF_A_MODEL = 0.6;

/** The share of a picture's pixels below which a difference is not seen. */
const ALIKE = 0.0015;

/** The share of a picture's pixels from which a difference is seen at once. */
const PLAIN_TO_SEE = 0.1;

/** The angle in degrees between the camera and the light around the model, as when the page opens. */
const LIGHT_BESIDE = description.light.azimuth - description.camera_yaw;

/** How much more of the picture must differ in another view or on another surface than in the first one. */
const BETTER = 1.5;

/** The radii in view around the place where the sides differ most, relative to the model's radius. */
const CLOSER = [0.45, 0.2] as const;

/** The slider's positions in percent at the end: where the fault is one place, left of the slider, and within which bounds where it is everywhere. Both as far as something of the model is on either side. */
const BESIDE = 62;
const WITHIN = [35, 65] as const;

/** Where the camera looks, in percent from the left: at the fault, if that is one place. */
const MIDDLE = 50;

/** What the first screen needs of the application. */
export interface Host {
  parts(): Part[];
  comparisons(): Comparison[];
  costOfRepair(): Promise<Cost | null>;
  /** Shows the repaired file on the right. */
  repair(): Promise<void>;
  /** Leads to the first place of a finding, with enough of the model in sight to recognise it. */
  visit(finding: Finding): Promise<unknown>;
  /** Rebuilds the drawing by the settings. */
  build(): void;
  split(percent: number): void;
  /** Shows the angles between the sides. */
  showAngles(): void;
}

/** A view with what differs in it. */
interface Found {
  view: View;
  seen: SeenDifference;
  /** Whether it shows one place that is wrong, with its outline. */
  isOutlined: boolean;
}

export class FirstScreen {
  /** Where the sides of the parts differed when the model was opened. */
  private faults: (Fault | null)[] = [];
  private outline: ReturnType<typeof outlineLines>[] = [];
  /** Whether the surface is plain because the fault is seen better so. */
  private isPlain = false;
  /** The direction of the light around the model before the model was opened; null where it was not changed. */
  private lightBefore: number | null = null;

  constructor(private readonly viewport: Viewport, private readonly host: Host) {
    element('verdict-close').addEventListener('click', () => this.close());
  }

  /** Forgets the model before. */
  clear(): void {
    this.faults = [];
    this.close();
    if (this.isPlain && chosenPaint() === 'plain') choosePaint('shaded');
    this.isPlain = false;
    if (this.lightBefore !== null) this.turnLight(this.lightBefore);
    this.lightBefore = null;
  }

  private close(): void {
    hideVerdict();
    this.viewport.keepFree(0, 0);
  }

  /** Shows the worst fault of a model that has just been checked: its place, one sentence, the file and the cure. */
  async show(checked: Checked): Promise<void> {
    const problem = worstOf(checked);
    if (!problem) return;
    const { finding: worst, others } = problem;
    const { host, viewport } = this;
    const parts = host.parts();
    const hasTangents = parts.some((part) => part.surface.tangents);
    const isSmall = trianglesOf(parts) <= SEARCHED_TRIANGLES;
    const isOfTangents = worst.code.startsWith('tangent') && hasTangents;
    this.faults = isSmall && isOfTangents ? host.comparisons().map(faultOf) : [];
    const cost = isSmall && isRepairable(worst) ? await host.costOfRepair() : null;
    // The cure of other faults is the repaired file: tangents computed again do not show it.
    if (cost && !isOfTangents) await host.repair();
    this.announce(problem, cost, null);
    host.build();
    if (!isSmall || !(cost || isOfTangents)) {
      // No other side shows the fault.
      const isOnePlace = worst.mesh !== null && (worst.first.length > 0 || !others);
      if (isOnePlace) await host.visit(worst);
      else viewport.lookAtAll();
      return;
    }
    this.lightBefore = numberOf('light-around');
    const { view, seen, isOutlined } = this.search();
    this.host.build();
    this.turnLight(lightAround(view));
    viewport.moveTo(view, true);
    const isAlike = seen.share < ALIKE;
    if (isAlike) this.announce(problem, cost, isOfTangents ? differenceOf(host.comparisons()) : 'unmeasured');
    // Something of the model stays on both sides, and not more than half of the fault under the cure.
    const divided = clamped(isOutlined || isAlike ? BESIDE : clamped(100 * seen.column, WITHIN), seen.divides.map((column) => 100 * column));
    const rest = isOutlined ? Math.max(MIDDLE, divided) : divided;
    const turnLight = (degrees: number) => viewport.lightFrom(numberOf('light-around') + degrees, numberOf('light-above'));
    void swing({ split: (percent) => host.split(percent), turnLight }, rest);
  }

  /** Says what is wrong, and keeps the model out of what lies over the picture. */
  private announce(problem: Problem, cost: Cost | null, alike: Parameters<typeof showVerdict>[2]): void {
    showVerdict(problem, cost, alike, () => this.host.showAngles());
    const [stage, caption, verdict] = ['view', 'caption-left', 'verdict'].map((id) => element(id).getBoundingClientRect());
    this.viewport.keepFree(caption.bottom - stage.top, stage.bottom - verdict.top);
  }

  /** The view and the surface on which the sides differ most. Dark and colourful surfaces hide what light does, so a plain one is tried, too. */
  private search(): Found {
    const found = this.bestView();
    if (chosenPaint() !== 'shaded' || found.seen.share >= PLAIN_TO_SEE) return found;
    this.paint('plain');
    const [same, other] = [this.look(found.view, found.isOutlined), this.bestView()];
    const plain = same.seen.share > other.seen.share ? same : other;
    this.isPlain = plain.seen.share > Math.max(ALIKE, BETTER * found.seen.share);
    if (this.isPlain) return plain;
    this.paint('shaded');
    return found;
  }

  /** Sets the direction of the light around the model, as its slider does. */
  private turnLight(degrees: number): void {
    const slider = element<HTMLInputElement>('light-around');
    slider.valueAsNumber = degrees;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }

  private paint(paint: Paint): void {
    choosePaint(paint);
    this.host.build();
  }

  /** The view in which the sides differ most: the place of the fault, or all of the model from a direction, or a part of it from nearby. */
  private bestView(): Found {
    const { viewport } = this;
    const start = performance.now();
    const fault = this.hasFault() ? this.viewOfFault() : null;
    const place = fault && this.look(viewport.recognised(fault), true);
    if (place && place.seen.share >= ALIKE) return place;
    const [first, ...others] = viewport.viewsAround();
    let best = this.look(first);
    for (const view of others) {
      if (performance.now() - start > SEARCH_TIME) break;
      const other = this.look(view);
      if (other.seen.share > BETTER * best.seen.share) best = other;
    }
    for (const radius of CLOSER) {
      const view = best.seen.share < PLAIN_TO_SEE ? this.closer(best, radius) : null;
      const near = view && this.look(view);
      if (near && near.seen.share > BETTER * best.seen.share) best = near;
    }
    if (!place || best.seen.share >= ALIKE) return best;
    // What nobody sees with so much of the model in sight is shown from nearer.
    const near = this.look(fault, true);
    return near.seen.share >= ALIKE ? near : place;
  }

  /** What differs in a view, with the light beside the camera. */
  private look(view: View, isOutlined = false): Found {
    this.viewport.lightFrom(lightAround(view), numberOf('light-above'));
    return { view, seen: this.viewport.differenceFrom(view), isOutlined };
  }

  /** The view from nearby of where the sides differ most; null where that is not on the model. */
  private closer({ view, seen }: Found, radius: number): View | null {
    const at = this.viewport.pointAt(view, seen.strongest);
    return at && this.viewport.recognised(this.viewport.viewOfSphere(at, radius * this.viewport.radius, view.eye.clone().sub(view.target)));
  }

  /** The number of triangles that are wrong. */
  private wrong(): number {
    return this.faults.reduce((sum, fault) => sum + (fault?.triangles ?? 0), 0);
  }

  /** Whether a part of the model is wrong, and not nearly all of it. */
  hasFault(): boolean {
    const wrong = this.wrong();
    return wrong > 0 && wrong < MOST_OF_A_MODEL * trianglesOf(this.host.parts());
  }

  /** The view from nearby of the place where the sides differ most. */
  private viewOfFault(): View {
    const part = this.faults.reduce((worst, fault, at) => ((fault?.weight ?? 0) > (this.faults[worst]?.weight ?? 0) ? at : worst), 0);
    const { position, normal, radius } = this.faults[part]!;
    const [matrix] = placesOf(this.host.parts()[part]);
    const at = new Vector3(...position).applyMatrix4(matrix);
    const direction = facing(new Vector3(...normal).applyMatrix3(new Matrix3().getNormalMatrix(matrix))).normalize();
    // From a little above, where bumps throw longer highlights.
    direction.y += 0.25;
    const around = Math.max(CLOSE_UP * this.viewport.radius, 1.5 * radius * matrix.getMaxScaleOnAxis());
    return this.viewport.viewOfSphere(at, Math.min(this.viewport.radius, around), direction);
  }

  /** Draws the outline of the fault, unless nearly everything is wrong. */
  drawOutline({ outline, hidden, paint }: Settings): void {
    for (const lines of this.outline) {
      lines.removeFromParent();
      lines.geometry.dispose();
      lines.material.dispose();
    }
    const parts = this.host.parts();
    const isDrawn = outline && isLit(paint) && this.faults.length === parts.length && this.hasFault();
    const drawn = isDrawn ? parts.map((part, at) => ({ part, fault: hidden.has(at) ? null : this.faults[at] })) : [];
    this.outline = drawn.flatMap(({ part, fault }) => (fault?.outline.length ? [outlineLines(fault.outline, placesOf(part))] : []));
    for (const lines of this.outline) this.viewport.add(lines);
    this.viewport.draw();
  }
}

/** A direction to look from: the normal, or along z where there is none. */
export function facing(normal: Vector3): Vector3 {
  return normal.lengthSq() > 0 ? normal : new Vector3(0, 0, 1);
}

/** The number of triangles of parts. */
export function trianglesOf(parts: Part[]): number {
  return parts.reduce((sum, { surface }) => sum + surface.indices.length / 3, 0);
}

/** The direction of the light around the model in degrees, so that it comes from beside the camera, as at first. */
function lightAround({ eye, target }: View): number {
  const towards = eye.clone().sub(target);
  const yaw = (Math.atan2(towards.x, towards.z) * 180) / Math.PI;
  const around = yaw + LIGHT_BESIDE;
  return around > 180 ? around - 360 : around;
}

/** The nearest number within bounds. */
function clamped(x: number, [least, most]: readonly number[]): number {
  return Math.min(most, Math.max(least, x));
}
