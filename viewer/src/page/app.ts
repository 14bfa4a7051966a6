// What the page does: opens models, and shows them as its controls say.

import { BufferAttribute, Mesh, type Group } from 'three';

import { fromDrop, fromList, type Bundle } from '../files/bundle';
import { openModel, type Model } from '../files/model';
import { partsOf, type Part } from '../scene/parts';
import { geometryOf, groupOf, materialOf, shared } from '../scene/side';
import { LAYERS, Stage } from '../scene/stage';
import { SOURCES, SOURCE_NAMES, type Source } from '../surface/sources';
import { call } from '../surface/thread';
import { element } from './elements';
import { showDone, showError, showProgress } from './state';

const SAMPLE = 'sample/NormalTangentTest.glb';

export class App {
  private readonly stage = new Stage(element('view'));
  private parts: Part[] = [];
  private groups: Group[] = [];
  /** Grows with each model that is opened: what belongs to an older one is dropped. */
  private turn = 0;

  start(): void {
    this.connect();
    const named = new URLSearchParams(location.search).get('model');
    if (named) this.openAddress('model', named);
    else this.openAddress(SAMPLE, 'NormalTangentTest.glb');
  }

  private connect(): void {
    for (const [at, id] of ['left', 'right'].entries()) {
      const select = element<HTMLSelectElement>(id);
      select.append(...SOURCES.map((source) => new Option(SOURCE_NAMES[source], source)));
      select.value = at ? 'derivatives' : 'mikktspace';
      select.addEventListener('change', () => this.refresh());
    }
    element('open-sample').addEventListener('click', () => this.openAddress(SAMPLE, 'NormalTangentTest.glb'));
    for (const id of ['files', 'folder']) {
      const input = element<HTMLInputElement>(id);
      element(`open-${id}`).addEventListener('click', () => input.click());
      input.addEventListener('change', () => this.open(async () => fromList(input.files ?? [])));
    }
    document.addEventListener('dragover', (event) => event.preventDefault());
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      const bundle = event.dataTransfer && fromDrop(event.dataTransfer);
      if (bundle) this.open(() => bundle);
    });
    const split = element<HTMLInputElement>('split');
    split.addEventListener('input', () => this.splitAt(Number(split.value) / 100));
    this.splitAt(0.5);
    for (const id of ['light-around', 'light-above']) element(id).addEventListener('input', () => this.moveLight());
  }

  private splitAt(place: number): void {
    this.stage.split = place;
    element('divider').style.insetInlineStart = `${100 * place}%`;
    this.stage.draw();
  }

  private moveLight(): void {
    const [around, above] = ['light-around', 'light-above'].map((id) => Number(element<HTMLInputElement>(id).value));
    this.stage.lightFrom(around, above);
  }

  /** Opens a file of this page's own server. */
  private openAddress(address: string, name: string): void {
    this.open(async () => {
      const answer = await fetch(address);
      if (!answer.ok) throw new Error(await answer.text());
      return new Map([[name, await answer.blob()]]);
    });
  }

  private async open(find: () => Promise<Bundle>): Promise<void> {
    const turn = ++this.turn;
    showError('');
    try {
      const model = await openModel(await find(), (what, done) => this.turn === turn && showProgress(what, done));
      if (this.turn === turn) await this.show(model);
    } catch (error) {
      if (this.turn !== turn) return;
      showError(error instanceof Error ? error.message : String(error));
      showDone('');
    }
  }

  private async show(model: Model): Promise<void> {
    this.parts = partsOf(model.scene, model.kind);
    await call('open', this.parts.map((part) => part.surface));
    await this.refresh();
    this.stage.frame(this.groups[0]);
    this.moveLight();
    element('name').textContent = model.name;
  }

  /** Arranges all parts anew, and shows them. */
  private async refresh(): Promise<void> {
    const turn = this.turn;
    const sources = ['left', 'right'].map((id) => element<HTMLSelectElement>(id).value as Source) as [Source, Source];
    const meshes: [Mesh[], Mesh[]] = [[], []];
    const mistakes = { green: false, w: false, v: false };
    for (const [at, part] of this.parts.entries()) {
      showProgress(`Computing tangents of ${part.name}`, at / this.parts.length);
      const arrangement = await call('arrange', at, sources);
      if (turn !== this.turn) return;
      const common = shared(part, arrangement);
      const indices = new BufferAttribute(arrangement.indices, 1);
      for (const side of [0, 1] as const) {
        const hasTangents = sources[side] !== 'derivatives';
        const geometry = geometryOf(common, indices, arrangement.tangents[side], hasTangents, mistakes);
        const mesh = new Mesh(geometry, materialOf(part, hasTangents, true, mistakes));
        mesh.matrixAutoUpdate = false;
        mesh.matrix.copy(part.place);
        meshes[side].push(mesh);
      }
    }
    this.stage.scene.remove(...this.groups);
    this.groups = meshes.map((side, at) => groupOf(side, LAYERS[at]));
    this.stage.scene.add(...this.groups);
    this.stage.draw();
    showDone(`${this.parts.length} parts`);
  }
}
