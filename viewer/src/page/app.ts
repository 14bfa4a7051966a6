// The application: opens models, computes tangents, and draws them by the settings.

import type { Finding } from 'darboux/check';
import { Box3, Matrix3, Vector3 } from 'three';

import type { Checked } from '../check/checker';
import { openGltf } from '../files/gltf';
import { Ktx2Textures } from '../files/ktx2';
import { openModel, withTangents, type Model } from '../files/model';
import type { FileBundle } from '../files/file-bundle';
import { oddities } from '../scene/oddities';
import { BakedMap } from '../scene/baked-map';
import type { View } from '../scene/camera-flight';
import { PlaceMarker } from '../scene/place-marker';
import { coarseCopy } from '../scene/coarse';
import { boundsOfCopies, partsOf, placesOf, uvSquare, type Part } from '../scene/model-parts';
import { dispose, empty, ModelView, type Side, type Values } from '../scene/model-view';
import { type Picked, Viewport } from '../scene/viewport';
import type { Comparison } from '../surface/comparison';
import { isOtherModel, SOURCE_NAMES, type Shown, type Source } from '../surface/sources';
import { call } from '../worker/surfaces';
import { chooseBaked, choosePaint, chooseRepaired, connectControls, offerSources, settings } from './controls';
import { BakePanel } from './bake-panel';
import { element, isOn, numberOf } from './elements';
import { connectEmbedding } from './embed';
import { Examination } from './examination';
import { placeOf } from './findings-panel';
import { facing, FirstScreen, trianglesOf } from './first-screen';
import { connectKeys, connectLightDrag } from './keyboard';
import { legendOf, showLegend } from './legend';
import { captionsOf, showCaptions } from './captions';
import { recordClip } from './clip';
import { drawLabelled } from './labelled-picture';
import { showTab, connectTabs } from './tabs';
import { hasView, readControls, readView, resetControls, writeLink } from './link';
import { connectSheet, connectSplit } from './layout';
import { connectLayoutFrame, showLayoutFrame } from './layout-frame';
import { connectOpening, type FindFiles } from './opening';
import { listParts } from './parts-list';
import { offerPoses } from './pose';
import { nameLike, save } from './download';
import { clearError, showDone, showError, showProgress } from './status';
import { connectTheme } from './theme';
import { ValuesPanel } from './values-panel';
import type { ShownBake } from '../bake/baker';
import { isLit, type Settings } from '../settings';
import { counted } from '../plural';
import type { Place } from '../surface/places';

/** The most triangles that are searched while the pointer moves over the model. */
const QUICK_TRIANGLES = 200_000;

/** The most triangles that are shown only once their tangents are computed. */
const PREVIEW_TRIANGLES = 200_000;

/** The time in milliseconds after the last change until the address is written. */
const LINK_DELAY = 300;

/** The radius around a place of a finding that is in view, relative to the model's radius. */
const CLOSE_UP = 0.12;

const CONTEXT_LOST = 'The connection to the graphics card was lost, perhaps because of too little memory; reload the page and open a smaller model.';

export class App {
  private readonly viewport = new Viewport(element('view'));
  private readonly view = new ModelView();
  /** The repaired model. */
  private readonly repairedView = new ModelView();
  /** The high model of a bake. */
  private readonly highView = new ModelView();
  private bakedMap: BakedMap | null = null;
  private sides: [Side, Side] = [empty(), empty()];
  private readonly examination = new Examination({
    visit: (finding, n) => this.visitFinding(finding, n),
    checked: (checked) => this.showFirst(checked),
    showRepaired: (file) => this.showRepaired(file),
    attempt: (work) => this.attempt(work),
  });
  private readonly firstScreen = new FirstScreen(this.viewport, {
    parts: () => this.parts,
    comparisons: () => this.comparisons,
    costOfRepair: () => this.examination.costOfRepair(),
    repair: () => this.examination.repair(),
    visit: (finding) => this.visitFinding(finding, 0, true),
    build: () => this.build(),
    split: (percent) => this.setSplit(percent),
    showAngles: () => this.showAngles(),
  });
  private readonly bakePanel = new BakePanel({
    openHigh: (bundle) => this.attempt(() => this.openHigh(bundle)),
    show: (bake) => this.showBake(bake),
  });
  private readonly marker = new PlaceMarker();
  private readonly values = new ValuesPanel({
    viewport: this.viewport,
    valuesAt: (picked) => this.valuesAt(picked),
    mark: (picked) => this.mark(picked),
    isQuick: () => trianglesOf(this.parts) <= QUICK_TRIANGLES,
  });
  private model: Model | null = null;
  /** The textures in KTX 2 of the model that was opened last, which may not be shown yet. */
  private textures: Ktx2Textures | null = null;
  private parts: Part[] = [];
  /** Whether the state in the address was applied to the first model. */
  private isLinkRead = false;
  /** Whether the address says what the open model's first screen is. */
  private isLinked = false;
  private comparisons: Comparison[] = [];
  private linkTimer = 0;
  /** Whether the model moved while its surfaces were read. */
  private isMoved = false;
  private isPosing = false;
  /** The number of the current opening. Results of older openings are dropped. */
  private opening = 0;
  /** The number of the current opening of a high model. Results of older ones are dropped. */
  private openingHigh = 0;
  /** The number of the current comparison. Results of older comparisons are dropped. */
  private comparing = 0;

  start(): void {
    connectEmbedding();
    this.viewport.add(this.marker.object);
    element('view').addEventListener('webglcontextlost', () => showError(new Error(CONTEXT_LOST)));
    connectTheme((model, layout) => this.viewport.background(model, layout));
    connectKeys(this.viewport);
    connectLightDrag();
    connectControls({ sources: () => this.attempt(() => this.compare()), look: () => this.build(), light: () => this.light() });
    this.viewport.controls.addEventListener('change', () => this.changed());
    element('reset').addEventListener('click', () => this.attempt(() => this.reset()));
    connectSplit(() => this.moveSplit());
    connectSheet();
    connectTabs();
    connectLayoutFrame(this.viewport.layoutCamera);
    element('save-clip').addEventListener('click', () => this.attempt(() => this.saveClip()));
    element('copy-link').addEventListener('click', () => this.attempt(() => this.copyLink()));
    element('save-picture').addEventListener('click', () => this.attempt(() => this.savePicture()));
    element('save-model').addEventListener('click', () => this.attempt(() => this.saveModel()));
    connectOpening((find) => this.attempt(() => this.open(find)));
  }

  private moveSplit(): void {
    const input = element<HTMLInputElement>('split');
    this.viewport.split = input.valueAsNumber / 100;
    element('divider').style.insetInlineStart = `${input.value}%`;
    const [left, right] = settings().sources.map((source) => SOURCE_NAMES[source]);
    input.ariaValueText = `${Math.round(input.valueAsNumber)} percent: ${left} on the left, ${right} on the right`;
    this.viewport.draw();
    this.changed();
  }

  /** Writes the state into the address, once a model is open and nothing changes any more. */
  private changed(): void {
    clearTimeout(this.linkTimer);
    if (this.isLinkRead) this.linkTimer = setTimeout(() => writeLink(this.viewport), LINK_DELAY);
  }

  /** Sets all controls and the camera back. */
  private async reset(): Promise<void> {
    this.values.free();
    resetControls();
    offerSources(this.hasTangents());
    listParts(this.parts.map(({ name }) => name), () => this.build());
    if (this.bakePanel.isOpen) chooseBaked();
    await this.compare();
    this.viewport.lookAtAll();
    this.viewport.layoutCamera.reset();
    this.light();
  }

  /** The values at a corner, and what its side shows. The repaired model has other vertices than the open one, so that there is no angle. */
  private valuesAt({ hit, side }: Picked): { values: Values; shown: Shown } {
    const { sources } = settings();
    const values = this.viewOf(sources[side]).valuesAt(hit, side);
    return { values: sources.some(isOtherModel) ? { ...values, angle: null } : values, shown: sources[side] };
  }

  /** Marks the corner whose values are pinned, at the place that was hit. */
  private mark(picked: Picked | null): void {
    if (picked) this.marker.showAt(picked.hit.point);
    else this.marker.hide();
    this.viewport.draw();
  }

  private hasTangents(): boolean {
    return this.parts.some((part) => part.surface.tangents);
  }

  private viewOf(shown: Shown): ModelView {
    if (shown === 'repaired') return this.repairedView;
    return shown === 'high' ? this.highView : this.view;
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
    element('broken').hidden = true;
    this.textures?.stop();
    const textures = (this.textures = new Ktx2Textures(this.viewport.mostTexels));
    try {
      showProgress('Searching for a model', null);
      const { low, high } = await find();
      const model = await openModel(low, textures, (task, fraction) => isOutdated() || showProgress(task, fraction));
      const parts = partsOf(model.scene);
      if (isOutdated()) return;
      // Stops the comparison of the model before.
      this.comparing++;
      const isPreviewed = trianglesOf(parts) > PREVIEW_TRIANGLES;
      const box = parts.reduce((all, part) => all.union(boundsOfCopies(part, part.surface.positions)), new Box3());
      this.viewport.offerCoarse(() => coarseCopy(parts, box));
      if (isPreviewed) await this.preview(box);
      await call('open', 'given', parts.map((part) => part.surface));
      if (isOutdated()) return;
      this.setModel(model, parts);
      await this.present(model, isPreviewed, isOutdated, high);
    } catch (error) {
      if (isOutdated()) return;
      element('broken').textContent = error instanceof Error ? error.message : String(error);
      element('broken').hidden = false;
      throw error;
    }
  }

  /** Shows the open model, then what costs time: the findings of the check. */
  private async present(model: Model, isPreviewed: boolean, isOutdated: () => boolean, high: FileBundle | null): Promise<void> {
    try {
      await this.compare();
      if (isOutdated()) return;
      if (!isPreviewed) this.viewport.lookAtAll();
      this.isLinked = !this.isLinkRead && hasView();
      if (!this.isLinkRead) readView(this.viewport);
      this.isLinkRead = true;
      this.light();
      await nextPicture();
    } catch (error) {
      if (!isOutdated()) this.examination.fail(error);
      throw error;
    }
    // A high model that cannot be opened does not keep the low one from being checked.
    if (high) await this.attempt(() => this.openHigh(high));
    if (!isOutdated()) await this.examination.examine(model);
  }

  /** Shows a coarse copy of a large model while its tangents are computed. */
  private async preview(box: Box3): Promise<void> {
    this.viewport.setBounds(box);
    this.viewport.showCoarse();
    this.viewport.lookAtAll();
    this.light();
    showCaptions({ sides: ['Coarse preview', ''], mistake: '', chip: '' });
    await nextPicture();
  }

  /** Replaces the model. */
  private setModel(model: Model, parts: Part[]): void {
    [this.model, this.parts] = [model, parts];
    this.firstScreen.clear();
    model.warnings.push(...oddities(parts.map((part) => part.surface)));
    this.viewport.layoutCamera.setWhole(uvSquare(parts));
    this.marker.hide();
    this.bakePanel.close();
    this.showBake(null);
    offerSources(this.hasTangents());
    listParts(parts.map(({ name }) => name), () => this.build());
    offerPoses(model, { posed: () => this.attempt(() => this.pose()), look: (camera) => this.viewport.lookFrom(camera) });
    if (!this.isLinkRead) readControls();
    this.values.free();
    element('name').textContent = model.name;
    this.examination.announce(model);
  }

  /** Reads the surfaces again after the model moved; while it moves, one after the other. */
  private async pose(): Promise<void> {
    this.isMoved = true;
    if (this.isPosing) return;
    this.isPosing = true;
    try {
      while (this.isMoved && this.model) {
        this.isMoved = false;
        this.parts = partsOf(this.model.scene);
        await call('open', 'given', this.parts.map((part) => part.surface));
        await this.compare();
      }
    } finally {
      this.isPosing = false;
    }
  }

  /** Computes the tangents of both sides. */
  private async compare(): Promise<void> {
    const turn = ++this.comparing;
    const { sources } = settings();
    const comparisons: Comparison[] = [];
    for (const [at, part] of this.parts.entries()) {
      // A clip that plays would be announced without end.
      if (!this.isPosing) showProgress(`Computing tangents of ${part.name}`, this.fraction(at));
      comparisons.push(await call('compare', 'given', at, ownSources(sources, part.surface.tangents !== null)));
      if (turn !== this.comparing) return;
    }
    this.comparisons = comparisons;
    this.view.setParts(this.parts, comparisons);
    this.viewport.setBounds(this.view.bounds());
    this.moveSplit();
    this.build();
    showDone(this.summary());
  }

  /** The size of the model and the warnings about its file, in one line. */
  private summary(): string {
    const size = `${counted(trianglesOf(this.parts), 'triangle', 'triangles')} in ${counted(this.parts.length, 'part', 'parts')}`;
    return [size, ...(this.model?.warnings ?? [])].join('; ');
  }

  /** The progress after some parts; null for a single part. */
  private fraction(parts: number): number | null {
    return this.parts.length > 1 ? parts / this.parts.length : null;
  }

  /** Rebuilds the drawing by the settings. */
  private build(): void {
    const now = settings();
    this.sides.forEach(dispose);
    this.sides = [this.sideOf(0, now), this.sideOf(1, now)];
    this.changed();
    this.viewport.show(this.sides, now.layout);
    this.standOnGround(now);
    showLayoutFrame(now.layout);
    showLegend(legendOf(now, this.firstScreen.hasFault()));
    this.firstScreen.drawOutline(now);
    showCaptions(captionsOf(now, this.parts));
  }

  /** Shows the ground below a lit model, or says beside its switch that the model has too many triangles for it. */
  private standOnGround({ ground, paint, hidden }: Settings): void {
    const shadow = ground && isLit(paint) ? this.view.groundShadow(hidden) : null;
    element('no-ground').hidden = shadow !== 'too many samples';
    this.viewport.standOn(typeof shadow === 'string' ? null : shadow);
  }

  private sideOf(at: 0 | 1, now: Settings): Side {
    const shown = now.sources[at];
    // The parts, test bumps and the layout are those of the open model.
    const own = shown === 'high' ? { ...now, paint: now.paint === 'bumps' ? 'shaded' as const : now.paint, layout: false, hidden: new Set<number>() } : now;
    return this.viewOf(shown).side(at, own, this.viewport.radius, shown === 'baked' ? this.bakedMap : null);
  }

  /** Opens a high model and bakes its detail onto the open one. */
  private async openHigh(bundle: FileBundle): Promise<void> {
    const { model, opening } = this;
    const turn = ++this.openingHigh;
    showProgress('Opening the high model', null);
    if (!model) throw new Error('There is no low model to bake onto; open it first.');
    const high = await openModel(bundle, model.textures, showProgress);
    const parts = partsOf(high.scene);
    await call('open', 'high', parts.map((part) => part.surface));
    const comparisons = await Promise.all(parts.map((_, at) => call('compare', 'high', at, ['file', 'file'])));
    const models = { low: model.bytes, high: [high.bytes] };
    if (opening !== this.opening || turn !== this.openingHigh) return;
    this.highView.setParts(parts, comparisons);
    chooseBaked();
    await this.compare();
    this.bakePanel.open(models, model.name, this.view.bounds().getSize(new Vector3()).length(), materialsOf(this.parts));
  }

  /** Shows a baked map, or none, in place of the one before. */
  private showBake(bake: ShownBake | null): void {
    const before = this.bakedMap;
    this.bakedMap = bake && new BakedMap(bake, isOn('bake-misses'));
    if (settings().sources.includes('baked')) this.build();
    before?.dispose();
  }

  /** Opens the repaired file and shows it on the right. */
  private async showRepaired(file: Uint8Array<ArrayBuffer>): Promise<void> {
    const { textures } = this.model!;
    const turn = this.opening;
    showProgress('Opening the repaired model', null);
    const { scene } = await openGltf('the repaired model', file, new Map(), textures);
    const parts = partsOf(scene);
    await call('open', 'repaired', parts.map((part) => part.surface));
    const comparisons = await Promise.all(parts.map((_, at) => call('compare', 'repaired', at, ['file', 'file'])));
    if (turn !== this.opening) return;
    this.repairedView.setParts(parts, comparisons);
    chooseRepaired(this.hasTangents());
    await this.compare();
  }

  /** Shows the worst fault of a model that has just been checked, unless a link or a bake decides what is shown. */
  private async showFirst(checked: Checked): Promise<void> {
    if (isOn('first-sight') && !this.isLinked && !this.bakePanel.isOpen) await this.firstScreen.show(checked);
  }

  private showAngles(): void {
    showTab('view');
    if (choosePaint('angle')) this.build();
  }

  private setSplit(percent: number): void {
    element<HTMLInputElement>('split').valueAsNumber = percent;
    this.moveSplit();
  }

  private light(): void {
    this.viewport.lightFrom(numberOf('light-around'), numberOf('light-above'));
    this.viewport.surround(element<HTMLSelectElement>('surroundings-name').value);
    this.viewport.brightness(numberOf('surroundings'), numberOf('light'), numberOf('exposure'));
  }

  /** Moves the camera to the n-th place of a finding, or to its whole part. `isFirst`: far enough away to recognise the model, which nobody has seen yet. */
  private async visitFinding(finding: Finding, n: number, isFirst = false): Promise<{ text: string; count: number }> {
    const { mesh, primitive, material, first, firstAre } = finding;
    const title = `${placeOf(finding)}: ${finding.text}`;
    const isHere = ({ origin }: Part) => (mesh === null ? origin?.material === material : origin?.mesh === mesh && origin.primitive === primitive);
    const part = this.parts.findIndex(isHere);
    if (part < 0) return { text: `${title}, which the scene does not show`, count: 1 };
    const places = await call('places', part, firstAre, first);
    const turn = places.length ? n % places.length : 0;
    const at = places.length ? this.visitPlace(part, places[turn], isFirst) : this.visitPart(part, isFirst);
    const number = places.length ? `, ${firstAre === 'triangles' ? 'triangle' : 'vertex'} ${first[turn]}, place ${turn + 1} of ${places.length}` : '';
    return { text: `${title}${number}, at (${rounded(at)})`, count: places.length };
  }

  private visitPlace(part: number, { position, normal, corners }: Place, isFirst: boolean): number[] {
    const [matrix] = placesOf(this.parts[part]);
    const at = new Vector3(...position).applyMatrix4(matrix);
    const direction = new Vector3(...normal).applyMatrix3(new Matrix3().getNormalMatrix(matrix));
    const size = corners ? new Box3().setFromArray(corners).applyMatrix4(matrix).getSize(new Vector3()).length() : 0;
    this.marker.showAt(at, corners, matrix);
    const near = this.viewport.viewOfSphere(at, Math.min(this.viewport.radius, Math.max(CLOSE_UP * this.viewport.radius, size)), facing(direction));
    this.flyTo(near, isFirst);
    return at.toArray();
  }

  /** Shows the whole of a part, and marks its box. */
  private visitPart(part: number, isFirst: boolean): number[] {
    const box = this.view.boundsOfPart(part);
    this.marker.showBox(box);
    this.flyTo(this.viewport.viewOfBox(box), isFirst);
    return box.getCenter(new Vector3()).toArray();
  }

  private flyTo(view: View, isFirst: boolean): void {
    this.viewport.moveTo(isFirst ? this.viewport.recognised(view) : view, true);
  }

  private async savePicture(): Promise<void> {
    const picture = this.labelledPicture();
    const blob = await new Promise<Blob | null>((resolve) => picture.toBlob(resolve, 'image/png'));
    if (!blob) throw new Error('The browser cannot save a picture of this size; make the window smaller.');
    save(nameLike(this.model?.name ?? 'picture', '.png'), blob);
  }

  /** The picture with what says what it shows. */
  private labelledPicture(): HTMLCanvasElement {
    const out = document.createElement('canvas');
    this.drawLabelled(out);
    return out;
  }

  private drawLabelled(out: HTMLCanvasElement): void {
    const now = settings();
    drawLabelled(out, this.viewport.picture(), captionsOf(now, this.parts), legendOf(now, this.firstScreen.hasFault()), this.viewport.split, devicePixelRatio);
  }

  private async saveClip(): Promise<void> {
    const { split } = this.viewport;
    showProgress('Recording four seconds', null);
    const clip = await recordClip((percent, canvas) => {
      this.viewport.split = percent / 100;
      this.drawLabelled(canvas);
    }).finally(() => (this.viewport.split = split));
    this.moveSplit();
    save(nameLike(this.model?.name ?? 'clip', clip.type.includes('mp4') ? '.mp4' : '.webm'), clip);
    showDone(this.summary());
  }

  private async copyLink(): Promise<void> {
    writeLink(this.viewport);
    await navigator.clipboard.writeText(location.href).catch(() => {
      throw new Error("The browser does not let the page copy; copy the page's address instead.");
    });
    showDone('The link is copied. It carries what is shown, not the model.');
  }

  private async saveModel(): Promise<void> {
    if (!this.model) throw new Error('There is no model to save.');
    showProgress('Writing tangents', null);
    const { bytes, description } = await withTangents(this.model);
    const { written, skipped } = description.totals;
    if (!written) throw new Error(`No part of ${this.model.name} can have tangents, so nothing is saved; tangents need texture coordinates and normals.`);
    save(nameLike(this.model.name, '.tangents.glb'), new Blob([bytes], { type: 'model/gltf-binary' }));
    const lines = [`Tangents written to ${counted(written, 'primitive', 'primitives')}, ${skipped} skipped`, ...description.warnings];
    showDone(lines.join('. '));
  }
}

/**
 * The sources of the open model's comparison: a side that shows another model takes that of the other side, and the baked map is shown with the tangents
 * that it is baked for.
 */
function ownSources([left, right]: readonly [Shown, Shown], hasTangents: boolean): [Source, Source] {
  const source = (shown: Shown): Source | null => {
    if (isOtherModel(shown)) return null;
    return shown === 'baked' ? (hasTangents ? 'file' : 'mikktspace') : shown;
  };
  const [a, b] = [source(left), source(right)];
  return [a ?? b ?? 'file', b ?? a ?? 'file'];
}

/** Coordinates as text. Single precision has about seven decimal digits. */
function rounded(at: number[]): string {
  return at.map((x) => Number(x.toPrecision(7))).join(', ');
}

/** Resolves when what was asked for is on screen. */
async function nextPicture(): Promise<void> {
  for (let frame = 0; frame < 2; frame++) await new Promise(requestAnimationFrame);
}

/** The names of materials by their indices in the file. */
function materialsOf(parts: Part[]): Map<number, string> {
  const named = new Map<number, string>();
  for (const { origin, material } of parts) if (origin && origin.material !== null) named.set(origin.material, material.name || `Material ${origin.material}`);
  return named;
}
