// The ways in which a model gets into the page.

import { fromDrop, fromList, type Bundle } from '../files/file-bundle';
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
  open(named === null ? sample : () => served(named));
}

async function sample(): Promise<Bundle> {
  return new Map([[SAMPLE, await (await fetched(SAMPLE, SAMPLE)).blob()]]);
}

/** The model that this page's own server was started with, and what it refers to. */
async function served(model: string): Promise<Bundle> {
  const names: string[] = await (await fetched('model', model)).json();
  const files = names.map(async (name, at) => [name, await (await fetched(`model/${at}`, name)).blob()] as const);
  return new Map(await Promise.all(files));
}

/** What this page's own server has at an address. */
async function fetched(address: string, name: string): Promise<Response> {
  const answer = await fetch(address).catch(() => {
    throw new Error(`${name} cannot be fetched: the server has ended.`);
  });
  if (!answer.ok) throw new Error(`${await answer.text()}.`);
  return answer;
}
