// Opens models from buttons, drops and the page's address.

import { fromDrop, fromList, pairOf, resolvePath, type FileBundle, type Pair } from '../files/file-bundle';
import { element } from './elements';

/** The model that the page opens without an address. */
const SAMPLE = 'shield.glb';

/** Finds the files of a model, and of a high model for its bake. */
export type FindFiles = () => Promise<Pair>;

/** Connects buttons and drops, and opens the model that the address names, or the sample. */
export function connectOpening(open: (find: FindFiles) => void): void {
  element('open-sample').addEventListener('click', () => open(sample));
  for (const id of ['files', 'folder']) {
    const input = element<HTMLInputElement>(id);
    element(`open-${id}`).addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      const bundle = fromList(input.files ?? []);
      // Lets the same file be chosen again.
      input.value = '';
      if (bundle.size) open(async () => pairOf(bundle));
    });
  }
  const showTarget = (isShown: boolean) => (element('drop-target').hidden = !isShown);
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    showTarget(true);
  });
  // Without a related target, the pointer left the page.
  document.addEventListener('dragleave', (event) => event.relatedTarget === null && showTarget(false));
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    showTarget(false);
    const bundle = event.dataTransfer && fromDrop(event.dataTransfer);
    if (bundle) open(async () => pairOf(await bundle));
  });
  const query = new URLSearchParams(location.search);
  const [named, file, high] = ['model', 'file', 'high'].map((name) => query.get(name));
  if (named !== null) open(() => pair(() => served('model', named), high && (() => served('high', high))));
  else open(file === null ? sample : () => pair(() => fromFolder(file), high && (() => fromFolder(high))));
}

async function pair(low: () => Promise<FileBundle>, high: '' | null | (() => Promise<FileBundle>)): Promise<Pair> {
  return { low: await low(), high: high ? await high() : null };
}

/** A model below the page's folder or beside it, with the files that a glTF refers to. Errors: it is on another machine. */
async function fromFolder(path: string): Promise<FileBundle> {
  if (new URL(path, location.href).origin !== location.origin) throw new Error(`${path} is on another machine; only files beside this page are opened.`);
  const model = await (await fetched(path, path)).blob();
  // Names of files begin in the topmost folder of all of them.
  const name = path.replace(/^(\.*\/)+/, '');
  const bundle: FileBundle = new Map([[name, model]]);
  const references: string[] = /\.gltf$/i.test(path) ? urisOf(await model.text()) : [];
  for (const uri of references) {
    const beside = resolvePath(uri, path);
    if (beside !== null) bundle.set(resolvePath(uri, name)!, await (await fetched(beside, beside)).blob());
  }
  return bundle;
}

/** The files that the text of a glTF refers to; none where it is no JSON, which gets a better sentence later. */
function urisOf(text: string): string[] {
  return Array.from(text.matchAll(/"uri"\s*:\s*"([^"]*)"/g), ([, uri]) => uri).filter((uri) => !uri.startsWith('data:'));
}

async function sample(): Promise<Pair> {
  return { low: new Map([[SAMPLE, await (await fetched(SAMPLE, SAMPLE)).blob()]]), high: null };
}

/** A model that `darboux view` serves below an address, with the files that it refers to. */
async function served(address: string, model: string): Promise<FileBundle> {
  const names: string[] = await (await fetched(address, model)).json();
  const files = names.map(async (name, at) => [name, await (await fetched(`${address}/${at}`, name)).blob()] as const);
  return new Map(await Promise.all(files));
}

/** The response of the page's server. Errors: the server has ended, or answers with a sentence. */
async function fetched(address: string, name: string): Promise<Response> {
  const response = await fetch(address).catch(() => {
    throw new Error(`${name} cannot be read because the server has ended; start darboux view again.`);
  });
  if (!response.ok) throw new Error(`${await response.text()}.`);
  return response;
}
