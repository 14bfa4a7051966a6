// Checks the open model, lists the findings, and repairs it.

import type { Finding } from 'darboux/check';

import type { Checked } from '../check/checker';
import { checker } from '../check/client';
import { call } from '../worker/surfaces';
import type { Model } from '../files/model';
import { nameLike, save } from './download';
import { element } from './elements';
import { setBusy, showChecking, showCheckFailed, showFindings, type Visit } from './findings-panel';
import { verticesIn, type Cost } from './first-sight';
import { connectMaps, showMaps, visitMap, type ShownMap } from './map-panel';

/** What the application does for an examination. */
export interface Host {
  /** Leads to a place of a finding on a mesh. */
  visit: Visit;
  /** Shows the worst of the findings of the check. */
  checked(checked: Checked): Promise<void>;
  /** Shows the repaired file beside the open one. */
  showRepaired(file: Uint8Array<ArrayBuffer>): Promise<void>;
  /** Runs a task, and shows its error. */
  attempt(work: () => Promise<void>): Promise<void>;
}

interface Repaired extends Checked {
  file: Uint8Array<ArrayBuffer> | null;
}

export class Examination {
  private model: Model | null = null;
  private maps: ShownMap[] = [];
  private repaired: Uint8Array<ArrayBuffer> | null = null;
  /** What happened to the open model, before any repair. */
  private diagnosis = '';
  private readonly repairs = new WeakMap<Model, Promise<Repaired>>();

  constructor(private readonly host: Host) {
    connectMaps();
    element('repair').addEventListener('click', () => host.attempt(() => this.repair()));
    element('make-normals').addEventListener('click', () => host.attempt(() => this.makeNormals()));
    element('save-repaired').addEventListener('click', () => this.save());
  }

  /** Announces that a model will be checked, in place of the findings on the model before. */
  announce(model: Model): void {
    [this.model, this.maps, this.repaired] = [model, [], null];
    showChecking();
    showMaps([]);
  }

  /** Says why the announced model is not checked. */
  fail(error: unknown): void {
    showCheckFailed(error instanceof Error ? error.message : String(error));
    setBusy(false);
  }

  /** Checks the announced model. An error of the check is shown in place of the findings: the model stays usable. */
  async examine(model: Model): Promise<void> {
    try {
      const file = model.bytes;
      const checked = inWordsOf(model, await checker('check', file));
      if (this.model !== model) return;
      this.diagnosis = checked.diagnosis;
      showFindings({ ...checked, diagnosis: withImporterNote(model, checked) }, this.visit);
      await this.host.checked(checked);
      if (this.model !== model) return;
      const maps = await checker('judgeMaps', file);
      if (this.model !== model) return;
      this.maps = maps.map((map) => ({ ...map, isRepaired: false }));
      showMaps(this.maps);
      setBusy(false);
    } catch (error) {
      if (this.model === model) this.fail(error);
    }
  }

  /** What a repair of the open model adds to its file; null where nothing is repaired or another model is open. */
  async costOfRepair(): Promise<Cost | null> {
    const { model } = this;
    if (!model) return null;
    const before = model.bytes;
    const { file } = await this.repairOnce(model);
    return file && { vertices: verticesIn(file) - verticesIn(before), bytes: file.byteLength - before.byteLength };
  }

  /** The repaired file and what became of the findings, computed once for a model. */
  private async repairOnce(model: Model): Promise<Repaired> {
    const found = this.repairs.get(model) ?? checker('repair', model.bytes).then((repaired) => inWordsOf(model, repaired));
    this.repairs.set(model, found);
    return found;
  }

  /** Repairs the model and shows what became of each finding. */
  async repair(): Promise<void> {
    const model = this.model!;
    setBusy(true);
    try {
      const repaired = await this.repairOnce(model);
      if (this.model !== model) return;
      if (repaired.file) await this.show(repaired.file, repaired.findings);
      // What was wrong stays said: faults of maps are repaired before anybody has read it.
      showFindings(repaired, this.visit, this.diagnosis);
    } finally {
      if (this.model === model) setBusy(false);
    }
  }

  private async show(file: Uint8Array<ArrayBuffer>, findings: Finding[]): Promise<void> {
    this.repaired = file;
    await this.host.showRepaired(file);
    const changed = new Set(findings.filter(({ repaired }) => repaired).map(({ image }) => image));
    const after = (await checker('judgeMaps', file)).filter(({ image }) => changed.has(image));
    const isSame = (map: ShownMap) => (other: { image: number }) => other.image === map.image;
    showMaps(this.maps.flatMap((map) => [map, ...after.filter(isSame(map)).map((one) => ({ ...one, isRepaired: true }))]));
  }

  /** Makes smooth normals where the file has none, which a repair leaves: flat shading may be wanted. */
  private async makeNormals(): Promise<void> {
    const { model } = this;
    if (!model) return;
    setBusy(true);
    try {
      const { bytes } = await call('makeNormals', model.name, model.bytes);
      if (this.model !== model) return;
      this.repaired = bytes;
      await this.host.showRepaired(bytes);
      element('make-normals').hidden = element('repair').hidden = true;
      element('save-repaired').hidden = false;
    } finally {
      if (this.model === model) setBusy(false);
    }
  }

  private save(): void {
    if (!this.repaired) return;
    save(nameLike(this.model!.name, '.repaired.glb'), new Blob([this.repaired], { type: 'model/gltf-binary' }));
  }

  /** Leads to a place on a mesh, or to a map. */
  private readonly visit: Visit = async (finding, n) => {
    if (finding.mesh === null && finding.image !== null) {
      const text = visitMap(finding.image) ? `The normal map, image ${finding.image}` : `Image ${finding.image} is not shown`;
      return { text, count: 1 };
    }
    return this.host.visit(finding, n);
  };
}

/** Names places as the file of another format than glTF does. */
function inWordsOf<T extends Checked>({ source }: Model, checked: T): T {
  if (!source) return checked;
  const places = new Map(source.places.map(({ mesh, primitive, place }) => [`meshes[${mesh}].primitives[${primitive}]`, place]));
  const findings = checked.findings.map((finding) => ({ ...finding, source: places.get(`meshes[${finding.mesh}].primitives[${finding.primitive}]`) }));
  const diagnosis = checked.diagnosis.replaceAll(/meshes\[\d+\]\.primitives\[\d+\]/g, (path) => (places.has(path) ? `${places.get(path)}, ${path}` : path));
  return { ...checked, findings, diagnosis };
}

/** The diagnosis, and what importers of the format make of the mistakes, where there are any. */
function withImporterNote({ source }: Model, { diagnosis, findings }: Checked): string {
  const isMistake = ({ severity }: Finding) => severity === 'error' || severity === 'warning';
  const note = source?.importer_note;
  return note && findings.some(isMistake) ? `${diagnosis} ${note}` : diagnosis;
}
