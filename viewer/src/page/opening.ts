// The ways in which a model gets into the page.

import { fromDrop, fromList, type Bundle } from '../files/bundle';
import { element } from './elements';

/** The model that is shown when nothing was asked for. */
const SAMPLE = 'shield.glb';

/** Finds files: they may still have to be read. */
export type Find = () => Promise<Bundle>;

/** Connects buttons, drops and the address; opens the model that the address names, or the sample. */
export function connectOpening(open: (find: Find) => void): void {
  element('open-sample').addEventListener('click', () => open(sample));
  for (const id of ['files', 'folder']) {
    const input = element<HTMLInputElement>(id);
    element(`open-${id}`).addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      const bundle = fromList(input.files ?? []);
      // The same file can be chosen again.
      input.value = '';
      if (bundle.size) open(async () => bundle);
    });
  }
  document.addEventListener('dragover', (event) => event.preventDefault());
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    const bundle = event.dataTransfer && fromDrop(event.dataTransfer);
    if (bundle) open(() => bundle);
  });
  const named = new URLSearchParams(location.search).get('model');
  open(named === null ? sample : () => fetched('model', named));
}

function sample(): Promise<Bundle> {
  return fetched(SAMPLE, SAMPLE);
}

/** A file of this page's own server. */
async function fetched(address: string, name: string): Promise<Bundle> {
  const answer = await fetch(address).catch(() => {
    throw new Error(`${name} cannot be fetched: the server has ended.`);
  });
  if (!answer.ok) throw new Error(`${await answer.text()}.`);
  return new Map([[name, await answer.blob()]]);
}
