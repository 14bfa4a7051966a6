// The application: opens models, computes tangents, and draws them by the settings.

import { Matrix3, Vector3 } from 'three';

import { openModel, type Model } from '../files/model';
import { repairedGlb } from '../files/export-glb';
import { PlaceMarker } from '../scene/place-marker';
import { partsOf, placesOf, uvSquare, type Part } from '../scene/model-parts';
import { ModelView } from '../scene/model-view';
import { Viewport } from '../scene/viewport';
import type { Comparison } from '../surface/comparison';
import { SOURCE_NAMES } from '../surface/sources';
import { call } from '../worker/client';
import { connectControls, offerSources, settings } from './controls';
import { element, numberOf } from './elements';
import { connectKeys, connectLightDrag } from './keyboard';
import { showLegend } from './legend';
import { connectOpening, type FindFiles } from './opening';
import { clearReport, showReport, type Found } from './report-list';
import { nameLike, save } from './download';
import { clearError, showDone, showError, showProgress } from './status';
import { connectTheme } from './theme';
import { counted } from '../plural';

/** The radius around a place of the report that is in view, relative to the model's radius. */
const CLOSE_UP = 0.12;

const CONTEXT_LOST = 'The connection to the graphics card was lost, perhaps because of too little memory; reload the page and open a smaller model.';

export class App {
  private readonly viewport = new Viewport(element('view'));
  private readonly view = new ModelView();
  private readonly marker = new PlaceMarker();
  private model: Model | null = null;
  private parts: Part[] = [];
  /** The number of the current opening. Results of older openings are dropped. */
  private opening = 0;
  /** The number of the current comparison. Results of older comparisons are dropped. */
  private comparing = 0;

  start(): void {
    this.viewport.add(this.marker.object);
    element('view').addEventListener('webglcontextlost', () => showError(new Error(CONTEXT_LOST)));
    connectTheme((model, layout) => this.viewport.background(model, layout));
    connectKeys(this.viewport);
    connectLightDrag();
    connectControls({ sources: () => this.attempt(() => this.compare()), look: () => this.build(), light: () => this.light() });
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
    this.viewport.split = input.valueAsNumber / 100;
    element('divider').style.insetInlineStart = `${input.value}%`;
    const [left, right] = settings().sources.map((source) => SOURCE_NAMES[source]);
    input.ariaValueText = `${Math.round(input.valueAsNumber)} percent: ${left} on the left, ${right} on the right`;
    this.viewport.draw();
  }

  /** Runs a task and shows its error, if any. */
  private async attempt(work: () => Promise<void>): Promise<void> {
    clearError();
    try {
      await work();
    } catch (error) {
      showError(error);
    }
  }

  private async open(find: FindFiles): Promise<void> {
    const turn = ++this.opening;
    const isOutdated = () => turn !== this.opening;
    try {
      showProgress('Searching for a model', null);
      const model = await openModel(await find(), (task, fraction) => isOutdated() || showProgress(task, fraction));
      const parts = partsOf(model.scene, model.kind);
      if (isOutdated()) return;
      // Stops the comparison of the model before.
      this.comparing++;
      await call('open', parts.map((part) => part.surface));
      if (isOutdated()) return;
      this.setModel(model, parts);
      await this.compare();
      if (isOutdated()) return;
      this.viewport.lookAtAll();
      this.light();
      showReport(await this.findings(isOutdated), (finding, place) => this.visit(finding, place));
      showDone(this.summary());
    } catch (error) {
      if (!isOutdated()) throw error;
    }
  }

  /** Replaces the model. */
  private setModel(model: Model, parts: Part[]): void {
    [this.model, this.parts] = [model, parts];
    this.viewport.setLayoutSquare(...uvSquare(parts));
    this.marker.hide();
    offerSources(parts.some((part) => part.surface.tangents));
    element('name').textContent = model.name;
    clearReport();
  }

  /** Collects the findings of all parts. */
  private async findings(isOutdated: () => boolean): Promise<Found[]> {
    const found: Found[] = [];
    for (const [at, part] of this.parts.entries()) {
      showProgress(`Checking ${part.name}`, this.fraction(at));
      for (const finding of await call('report', at)) found.push({ ...finding, part: at, partName: part.name });
      if (isOutdated()) throw new Error('Another model was opened.');
    }
    return found;
  }

  /** Computes the tangents of both sides. */
  private async compare(): Promise<void> {
    const turn = ++this.comparing;
    const { sources } = settings();
    const comparisons: Comparison[] = [];
    for (const [at, part] of this.parts.entries()) {
      showProgress(`Computing tangents of ${part.name}`, this.fraction(at));
      comparisons.push(await call('compare', at, sources));
      if (turn !== this.comparing) return;
    }
    this.view.setParts(this.parts, comparisons);
    this.viewport.setBounds(this.view.bounds());
    for (const [at, id] of ['caption-left', 'caption-right'].entries()) element(id).textContent = SOURCE_NAMES[sources[at]];
    this.moveSplit();
    this.build();
    showDone(this.summary());
  }

  /** The size of the model and the warnings about its file, in one line. */
  private summary(): string {
    const triangles = this.parts.reduce((sum, { surface }) => sum + surface.indices.length / 3, 0);
    const size = `${counted(triangles, 'triangle', 'triangles')} in ${counted(this.parts.length, 'part', 'parts')}`;
    return [size, ...(this.model?.warnings ?? [])].join('; ');
  }

  /** The progress after some parts; null for a single part. */
  private fraction(parts: number): number | null {
    return this.parts.length > 1 ? parts / this.parts.length : null;
  }

  /** Rebuilds the drawing by the settings. */
  private build(): void {
    const now = settings();
    this.view.build(now, this.viewport.radius);
    this.viewport.show(this.view.sides, now.layout);
    showLegend(now);
  }

  private light(): void {
    this.viewport.lightFrom(numberOf('light-around'), numberOf('light-above'));
    this.viewport.brightness(numberOf('surroundings'), numberOf('light'));
  }

  /** Moves the camera to a place of the report. Returns its coordinates. */
  private visit({ part, places }: Found, place: number): number[] {
    const [matrix] = placesOf(this.parts[part]);
    const at = new Vector3().fromArray(places, place * 6).applyMatrix4(matrix);
    const normal = new Vector3().fromArray(places, place * 6 + 3).applyMatrix3(new Matrix3().getNormalMatrix(matrix));
    this.marker.showAt(at);
    this.viewport.look(at, CLOSE_UP * this.viewport.radius, normal.lengthSq() > 0 ? normal : new Vector3(0, 0, 1), true);
    return at.toArray();
  }

  private async savePicture(): Promise<void> {
    save(nameLike(this.model?.name ?? 'picture', '.png'), await this.viewport.picture());
  }

  private async saveModel(): Promise<void> {
    if (!this.model) throw new Error('There is no model to save.');
    showProgress('Writing tangents', null);
    const { bytes, description } = await repairedGlb(this.model);
    save(nameLike(this.model.name, '.tangents.glb'), new Blob([bytes], { type: 'model/gltf-binary' }));
    const { written, skipped } = description.totals;
    const lines = [`Tangents written to ${counted(written, 'primitive', 'primitives')}, ${skipped} skipped`, ...description.warnings];
    showDone(lines.join('. '));
  }
}
