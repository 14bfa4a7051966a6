// The controls of a bake: every change of a slider bakes again, and the result is shown at once.

import type { BakerOptions, ShownBake } from '../bake/baker';
import { Baker, type BakedModels } from '../bake/client';
import { fromList, type FileBundle } from '../files/file-bundle';
import { nameLike, save } from './download';
import { element, isOn, numberOf } from './elements';
import { chosenKinds, connectFurtherMaps, showFurtherMaps } from './further-maps';

/** What the application does for the panel. */
export interface BakeHost {
  /** Opens a high model for the open model. */
  openHigh(bundle: FileBundle): void;
  /** Shows a baked map on the open model, or none. */
  show(bake: ShownBake | null): void;
}

/** The choices that ask for another bake. */
const OPTIONS = ['bake-material', 'bake-rays', 'bake-distance', 'bake-inwards', 'bake-size', 'bake-samples', 'bake-back-faces'];

export class BakePanel {
  private readonly baker = new Baker((done) => (element<HTMLProgressElement>('bake-progress').value = done));
  private models: BakedModels | null = null;
  private name = '';
  private diagonal = 0;
  private baked: ShownBake | null = null;
  /** Whether the choices changed since the running bake began. */
  private isWanted = false;
  private isRunning = false;
  /** The number of the current models and of the ends of bakes. Results of older ones are dropped. */
  private turn = 0;

  constructor(private readonly host: BakeHost) {
    const input = element<HTMLInputElement>('high');
    element('open-high').addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      const bundle = fromList(input.files ?? []);
      // Lets the same file be chosen again.
      input.value = '';
      if (bundle.size) host.openHigh(bundle);
    });
    for (const id of OPTIONS) element(id).addEventListener('input', () => this.changed());
    connectFurtherMaps(() => this.changed(), () => this.name);
    element('bake-misses').addEventListener('change', () => this.baked && this.show(this.baked));
    element('bake-cancel').addEventListener('click', () => this.cancel());
    element('bake-save').addEventListener('click', () => this.save());
  }

  /** Whether there is a pair of models. */
  get isOpen(): boolean {
    return this.models !== null;
  }

  /** Bakes a pair of models. `name`: the low one's; `diagonal`: of the box around it; `materials`: their names by their indices in the file. */
  open(models: BakedModels, name: string, diagonal: number, materials: ReadonlyMap<number, string>): void {
    this.close();
    offerMaterials(materials);
    Object.assign(this, { models, name, diagonal });
    element<HTMLButtonElement>('bake-save').disabled = true;
    element('bake-figure').hidden = true;
    showFurtherMaps(null);
    element('bake-result').textContent = '';
    element('bake-controls').hidden = false;
    this.changed();
  }

  /** Forgets the models. */
  close(): void {
    if (this.isRunning) this.cancel();
    Object.assign(this, { models: null, baked: null });
    element('bake-controls').hidden = true;
  }

  private changed(): void {
    const isCage = element<HTMLSelectElement>('bake-rays').value === 'cage';
    element('bake-inwards-label').hidden = isCage;
    element('bake-distance-name').textContent = isCage ? 'Cage offset' : 'Outwards';
    for (const [id, shown] of [['bake-distance', 'bake-distance-value'], ['bake-inwards', 'bake-inwards-value']]) {
      const text = `${Number((100 * shareOf(id)).toPrecision(2))} %`;
      element(id).ariaValueText = `${text} of the model's diagonal`;
      element(shown).textContent = text;
    }
    this.isWanted = true;
    if (this.models && !this.isRunning) void this.run(this.models);
  }

  /** Bakes until the choices do not change any more. */
  private async run(models: BakedModels): Promise<void> {
    const turn = ++this.turn;
    this.setRunning(true);
    while (this.isWanted) {
      this.isWanted = false;
      const outcome = await this.baker.bake(models, this.options()).catch((error: unknown) => (error instanceof Error ? error : new Error(String(error))));
      if (turn !== this.turn) return;
      if (outcome instanceof Error) this.fail(outcome);
      else this.show(outcome);
    }
    this.setRunning(false);
  }

  private cancel(): void {
    this.turn++;
    this.isWanted = false;
    this.baker.cancel();
    this.setRunning(false);
    element('bake-result').textContent = 'The bake was ended. Any change starts another one.';
  }

  private setRunning(isRunning: boolean): void {
    this.isRunning = isRunning;
    element('bake').ariaBusy = String(isRunning);
    element<HTMLProgressElement>('bake-progress').value = 0;
    // The button is about to disappear, which would lose the focus.
    if (!isRunning && document.activeElement === element('bake-cancel')) element('bake-rays').focus();
    element('bake-running').hidden = !isRunning;
  }

  private options(): BakerOptions {
    const side = numberOf('bake-size');
    const [outwards, inwards] = ['bake-distance', 'bake-inwards'].map((id) => shareOf(id) * this.diagonal);
    const isCage = element<HTMLSelectElement>('bake-rays').value === 'cage';
    const rays = isCage ? { cageOffset: outwards } : { distance: [outwards, inwards] as const };
    const chosen = element<HTMLSelectElement>('bake-material').value;
    const material = chosen === '' ? null : Number(chosen);
    return { material, maps: chosenKinds(), size: [side, side], samples: numberOf('bake-samples'), backFaces: isOn('bake-back-faces'), ...rays };
  }

  private fail(error: Error): void {
    this.baked = null;
    this.host.show(null);
    element<HTMLButtonElement>('bake-save').disabled = true;
    element('bake-figure').hidden = true;
    showFurtherMaps(null);
    element('bake-result').textContent = `There is no map: ${error.message}.`;
  }

  private show(bake: ShownBake): void {
    this.baked = bake;
    element<HTMLButtonElement>('bake-save').disabled = false;
    drawMap(bake, isOn('bake-misses'));
    showFurtherMaps(bake);
    element('bake-result').textContent = [sentence(bake), ...bake.warnings].join('. ');
    this.host.show(bake);
  }

  private save(): void {
    if (!this.baked) return;
    drawMap(this.baked, false);
    element<HTMLCanvasElement>('bake-map').toBlob((blob) => blob && save(nameLike(this.name, '.normal.png'), blob), 'image/png');
    drawMap(this.baked, isOn('bake-misses'));
  }
}

/** Offers each material of the low model, if there are several. */
function offerMaterials(materials: ReadonlyMap<number, string>): void {
  const select = element<HTMLSelectElement>('bake-material');
  select.replaceChildren(select.options[0], ...[...materials].map(([index, name]) => new Option(name, String(index))));
  select.value = '';
  element('bake-material-label').hidden = materials.size < 2;
}

/** The share of the model's diagonal that a slider chooses. Its scale is logarithmic, in percent. */
function shareOf(id: string): number {
  return 10 ** numberOf(id) / 100;
}

/** Draws the map and, where that is wished, the misses over it. */
function drawMap({ width, height, normals, misses }: ShownBake, hasMisses: boolean): void {
  element('bake-figure').hidden = false;
  const canvas = element<HTMLCanvasElement>('bake-map');
  Object.assign(canvas, { width, height });
  const context = canvas.getContext('2d')!;
  const shown = hasMisses ? normals.map((x, at) => (misses[at | 3] ? misses[at] : x)) : normals;
  context.putImageData(new ImageData(shown, width, height), 0, 0);
}

/** What the bake counted. */
function sentence({ report, seconds }: ShownBake): string {
  const { chartedTexels, missedTexels, backFacingTexels, overlappingTexels } = report;
  const share = (texels: number) => `${Number(((100 * texels) / Math.max(chartedTexels, 1)).toPrecision(2))} %`;
  const missed = missedTexels
    ? `Rays of ${share(missedTexels)} of the texels (${missedTexels.toLocaleString('en')}) hit nothing`
    : `Rays of all ${chartedTexels.toLocaleString('en')} texels hit the high model`;
  const behind = backFacingTexels ? `, for ${backFacingTexels.toLocaleString('en')} of them only triangles from behind` : '';
  const overlapping = overlappingTexels ? `. Several triangles share ${share(overlappingTexels)}` : '';
  return `${missed}${behind}${overlapping}. Baked in ${seconds.toPrecision(2)} s`;
}
