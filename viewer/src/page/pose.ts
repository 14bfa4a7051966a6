// The pose of a model: its animation clips, its morph targets, and the cameras of its file.

import { AnimationMixer, type Camera, Mesh, type Object3D } from 'three';

import type { Model } from '../files/model';
import { element } from './elements';

/** What the application does after a change. */
export interface PoseHost {
  /** The model moved: its surfaces must be read again. Resolves when they are shown. */
  posed(): Promise<void>;
  /** Shows the model as a camera of the file does. */
  look(camera: Camera): void;
}

/** Offers the clips, morph targets and cameras of a new model; nothing is shown where it has none. */
export function offerPoses({ scene, animations, cameras }: Model, host: PoseHost): void {
  const morphs = morphsOf(scene);
  const mixer = new AnimationMixer(scene);
  const [clip, time] = [element<HTMLSelectElement>('clip'), element<HTMLInputElement>('clip-time')];
  element('pose').hidden = !animations.length && !morphs.length && !cameras.length;
  element('no-pose').hidden = !element('pose').hidden;
  element('clips').hidden = !animations.length;
  clip.replaceChildren(new Option('As in the file', ''), ...animations.map(({ name }, at) => new Option(name || `Clip ${at}`, String(at))));
  const chosen = () => animations[clip.value === '' ? -1 : Number(clip.value)];
  const pose = () => {
    mixer.stopAllAction();
    const now = chosen();
    if (now) {
      mixer.clipAction(now).play();
      mixer.setTime(time.valueAsNumber * now.duration * (1 - 1e-6));
      time.ariaValueText = `${(time.valueAsNumber * now.duration).toFixed(2)} seconds`;
    }
    return host.posed();
  };
  const play = element('clip-play') as HTMLButtonElement;
  stop();
  clip.onchange = () => {
    time.disabled = play.disabled = !chosen();
    if (!chosen()) stop();
    void pose();
  };
  time.oninput = () => {
    stop();
    void pose();
  };
  play.onclick = () => (playing ? stop() : start(() => chosen().duration, pose));
  time.value = '0';
  time.disabled = play.disabled = true;
  offerMorphs(morphs, host);
  offerCameras(cameras, host);
}

/** The run of the clip that plays; null while none does. */
let playing: object | null = null;

/** Plays the chosen clip: moves the slider of the time as time passes, from the end on to the beginning, one pose after the other. */
async function start(duration: () => number, pose: () => Promise<void>): Promise<void> {
  const run = (playing = {});
  const [time, button] = [element<HTMLInputElement>('clip-time'), element('clip-play')];
  [button.ariaPressed, button.textContent] = ['true', 'Pause'];
  let before = performance.now();
  while (playing === run) {
    const now = await new Promise<number>(requestAnimationFrame);
    if (playing !== run) return;
    time.valueAsNumber = (time.valueAsNumber + Math.max(0, now - before) / 1000 / (duration() || 1)) % 1;
    before = now;
    await pose();
  }
}

/** Stops the clip where it is. */
function stop(): void {
  playing = null;
  const button = element('clip-play');
  [button.ariaPressed, button.textContent] = ['false', 'Play'];
}

function offerCameras(cameras: Camera[], host: PoseHost): void {
  const select = element<HTMLSelectElement>('camera');
  element('cameras').hidden = !cameras.length;
  select.replaceChildren(new Option('Free', ''), ...cameras.map(({ name }, at) => new Option(name || `Camera ${at}`, String(at))));
  select.onchange = () => select.value !== '' && host.look(cameras[Number(select.value)]);
}

/** A morph target of one or of several meshes with the same name. */
interface Morph {
  name: string;
  meshes: { mesh: Mesh; target: number }[];
}

function morphsOf(scene: Object3D): Morph[] {
  const found = new Map<string, Morph>();
  scene.traverse((object) => {
    if (!(object instanceof Mesh) || !object.morphTargetInfluences) return;
    const names = Object.entries(object.morphTargetDictionary ?? {});
    for (const target of object.morphTargetInfluences.keys()) {
      const name = names.find(([, at]) => at === target)?.[0] ?? String(target);
      const key = `${object.parent?.type === 'Group' ? object.parent.name : object.name}: ${name}`;
      const morph = found.get(key) ?? { name: key, meshes: [] };
      morph.meshes.push({ mesh: object, target });
      found.set(key, morph);
    }
  });
  return [...found.values()];
}

/** Lists the morph targets, with a search and a button that sets all back. */
function offerMorphs(morphs: Morph[], host: PoseHost): void {
  const stored = morphs.map(({ meshes }) => meshes[0].mesh.morphTargetInfluences![meshes[0].target]);
  const labels = morphs.map((morph) => slider(morph, () => void host.posed()));
  element('morphs').replaceChildren(...labels);
  element('morph-controls').hidden = !morphs.length;
  const search = element<HTMLInputElement>('morph-search');
  search.value = '';
  search.oninput = () => {
    const wanted = search.value.trim().toLowerCase();
    morphs.forEach(({ name }, at) => (labels[at].hidden = !name.toLowerCase().includes(wanted)));
  };
  element('morph-reset').onclick = () => {
    morphs.forEach(({ meshes }, at) => {
      for (const { mesh, target } of meshes) mesh.morphTargetInfluences![target] = stored[at];
      labels[at].querySelector('input')!.valueAsNumber = stored[at];
    });
    void host.posed();
  };
}

function slider({ name, meshes }: Morph, changed: () => void): HTMLElement {
  const label = document.createElement('label');
  const input = document.createElement('input');
  Object.assign(input, { type: 'range', min: '0', max: '1', step: '0.01', value: String(meshes[0].mesh.morphTargetInfluences![meshes[0].target]) });
  input.addEventListener('input', () => {
    for (const { mesh, target } of meshes) mesh.morphTargetInfluences![target] = input.valueAsNumber;
    changed();
  });
  label.append(`${name} `, input);
  return label;
}
