// What the page does: opens models, computes, and shows what its controls say.

import { Matrix3, Vector3 } from 'three';

import { openModel, type Model } from '../files/model';
import { repairedGlb } from '../files/export-glb';
import { Marker } from '../scene/place-marker';
import { partsOf, placesOf, squareOf, type Part } from '../scene/model-parts';
import { Shown } from '../scene/model-view';
import { Stage } from '../scene/viewport';
import type { Arrangement } from '../surface/comparison';
import { SOURCE_NAMES } from '../surface/sources';
import { call } from '../worker/client';
import { connectControls, offerSources, settings } from './controls';
import { element, numberOf } from './elements';
import { connectKeys, connectLightDrag } from './keyboard';
import { showLegend } from './legend';
import { connectOpening, type Find } from './opening';
import { clearReport, showReport, type Found } from './report-list';
import { nameLike, save } from './download';
import { clearError, showDone, showError, showProgress } from './status';
import { connectTheme } from './theme';
import { counted } from '../plural';

/** How much of the model is in view where the report leads, as a part of its radius. */
const CLOSE = 0.12;

const LOST = 'The graphics card was lost, perhaps for want of memory; load the page again, and a smaller model.';

export class App {
  private readonly stage = new Stage(element('view'));
  private readonly shown = new Shown();
  private readonly marker = new Marker();
  private model: Model | null = null;
  private parts: Part[] = [];
  /** Grow with each model and each arrangement: what belongs to older ones is dropped. */
  private opening = 0;
  private arranging = 0;

  start(): void {
    this.stage.add(this.marker.object);
    element('view').addEventListener('webglcontextlost', () => showError(new Error(LOST)));
    connectTheme((model, layout) => this.stage.background(model, layout));
    connectKeys(this.stage);
    connectLightDrag();
    connectControls({ sources: () => this.attempt(() => this.arrange()), look: () => this.build(), light: () => this.light() });
    this.connectSplit();
    element('save-picture').addEventListener('click', () => this.attempt(() => this.savePicture()));
    element('save-model').addEventListener('click', () => this.attempt(() => this.saveModel()));
    connectOpening((find) => this.attempt(() => this.open(find)));
  }

  private connectSplit(): void {
    element('split').addEventListener('input', () => this.moveSplit());
    this.moveSplit();
  }

  private moveSplit(): void {
    const input = element<HTMLInputElement>('split');
    this.stage.split = input.valueAsNumber / 100;
    element('divider').style.insetInlineStart = `${input.value}%`;
    const [left, right] = settings().sources.map((source) => SOURCE_NAMES[source]);
    input.ariaValueText = `${Math.round(input.valueAsNumber)} percent: ${left} on the left, ${right} on the right`;
    this.stage.draw();
  }

  /** Does something that may fail with a sentence. */
  private async attempt(work: () => Promise<void>): Promise<void> {
    clearError();
    try {
      await work();
    } catch (error) {
      showError(error);
    }
  }

  private async open(find: Find): Promise<void> {
    const turn = ++this.opening;
    const isOld = () => turn !== this.opening;
    try {
      showProgress('Looking for a model', null);
      const model = await openModel(await find(), (what, done) => isOld() || showProgress(what, done));
      const parts = partsOf(model.scene, model.kind);
      if (isOld()) return;
      // What is computed of the model before asks for no more of it.
      this.arranging++;
      await call('open', parts.map((part) => part.surface));
      if (isOld()) return;
      this.take(model, parts);
      await this.arrange();
      if (isOld()) return;
      this.stage.lookAtAll();
      this.light();
      showReport(await this.findings(isOld), (finding, place) => this.visit(finding, place));
      showDone(this.told());
    } catch (error) {
      if (!isOld()) throw error;
    }
  }

  /** Takes a model in place of the one before. */
  private take(model: Model, parts: Part[]): void {
    [this.model, this.parts] = [model, parts];
    this.stage.measureLayout(...squareOf(parts));
    this.marker.hide();
    offerSources(parts.some((part) => part.surface.tangents));
    element('name').textContent = model.name;
    clearReport();
  }

  /** What is odd about the model. */
  private async findings(isOld: () => boolean): Promise<Found[]> {
    const found: Found[] = [];
    for (const [at, part] of this.parts.entries()) {
      showProgress(`Looking at ${part.name}`, this.done(at));
      for (const finding of await call('report', at)) found.push({ ...finding, part: at, partName: part.name });
      if (isOld()) throw new Error('Another model was opened.');
    }
    return found;
  }

  /** Computes what both sides show. */
  private async arrange(): Promise<void> {
    const turn = ++this.arranging;
    const { sources } = settings();
    const arrangements: Arrangement[] = [];
    for (const [at, part] of this.parts.entries()) {
      showProgress(`Computing tangents of ${part.name}`, this.done(at));
      arrangements.push(await call('arrange', at, sources));
      if (turn !== this.arranging) return;
    }
    this.shown.arrange(this.parts, arrangements);
    this.stage.measure(this.shown.bounds());
    for (const [at, id] of ['caption-left', 'caption-right'].entries()) element(id).textContent = SOURCE_NAMES[sources[at]];
    this.moveSplit();
    this.build();
    showDone(this.told());
  }

  /** The model in a line, and what is odd about its file. */
  private told(): string {
    const triangles = this.parts.reduce((sum, { surface }) => sum + surface.indices.length / 3, 0);
    const size = `${counted(triangles, 'triangle', 'triangles')} in ${counted(this.parts.length, 'part', 'parts')}`;
    return [size, ...(this.model?.warnings ?? [])].join('; ');
  }

  /** How much is done when as many parts are. */
  private done(parts: number): number | null {
    return this.parts.length > 1 ? parts / this.parts.length : null;
  }

  /** Shows what was computed, as the controls say. */
  private build(): void {
    const now = settings();
    this.shown.build(now, this.stage.radius);
    this.stage.show(this.shown.sides, now.layout);
    showLegend(now);
  }

  private light(): void {
    this.stage.lightFrom(numberOf('light-around'), numberOf('light-above'));
    this.stage.brightness(numberOf('surroundings'), numberOf('light'));
  }

  /** Flies to a place of the report; gives its coordinates. */
  private visit({ part, places }: Found, place: number): number[] {
    const [matrix] = placesOf(this.parts[part]);
    const at = new Vector3().fromArray(places, place * 6).applyMatrix4(matrix);
    const normal = new Vector3().fromArray(places, place * 6 + 3).applyMatrix3(new Matrix3().getNormalMatrix(matrix));
    this.marker.showAt(at);
    this.stage.look(at, CLOSE * this.stage.radius, normal.lengthSq() > 0 ? normal : new Vector3(0, 0, 1), true);
    return at.toArray();
  }

  private async savePicture(): Promise<void> {
    save(nameLike(this.model?.name ?? 'picture', '.png'), await this.stage.picture());
  }

  private async saveModel(): Promise<void> {
    if (!this.model) throw new Error('There is no model to save.');
    showProgress('Writing tangents', null);
    const { bytes, told } = await repairedGlb(this.model);
    save(nameLike(this.model.name, '.tangents.glb'), new Blob([bytes], { type: 'model/gltf-binary' }));
    const { written, skipped } = told.totals;
    const lines = [`Tangents written to ${counted(written, 'primitive', 'primitives')}, ${skipped} left alone`, ...told.warnings];
    showDone(lines.join('. '));
  }
}
