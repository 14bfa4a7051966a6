// The files of one model: the model itself and the files that it refers to, by path.

/** Files by path, with / as separator. */
export type FileBundle = Map<string, Blob>;

/** The limit on files. A folder with more was dropped by mistake. */
const MAX_FILES = 5000;

/** The files of an input element. */
export function fromList(files: Iterable<File>): FileBundle {
  return new Map([...files].map((file) => [file.webkitRelativePath || file.name, file]));
}

/** The files of a drop. Folders are read recursively. */
export async function fromDrop(data: DataTransfer): Promise<FileBundle> {
  // Entries are read before the first await, because the list is emptied when the event ends.
  const entries = [...data.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.length) return fromList(data.files);
  const bundle: FileBundle = new Map();
  for (const entry of entries) await collect(entry, bundle);
  return bundle;
}

async function collect(entry: FileSystemEntry, bundle: FileBundle): Promise<void> {
  if (bundle.size > MAX_FILES) throw new Error(`The folder has more than ${MAX_FILES.toLocaleString('en')} files; drop the model's own folder.`);
  if (entry.isDirectory) {
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    for (;;) {
      const batch = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
      if (!batch.length) return;
      for (const inner of batch) await collect(inner, bundle);
    }
  }
  const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
  bundle.set(entry.fullPath.replace(/^\//, ''), file);
}

/** Names of files that hold a model. */
const MODEL_NAME = /\.(glb|gltf|vrm|obj|ply|stl|fbx)$/i;

/** Names of models in the order in which they are preferred. An FBX often lies beside the same model in another format; USD is not read, and the page says what to do. */
export const MODEL_NAMES = [/\.(glb|gltf|vrm|obj|ply|stl)$/i, /\.fbx$/i, /\.usd[acz]?$/i];

/** Names of high-poly models, such as crate_high.glb. */
const HIGH_NAME = /(^|[^a-z])(high|highpoly|hp)([^a-z]|$)/i;

/** A low model, and the high one for its bake, if there is one. */
export interface Pair {
  low: FileBundle;
  high: FileBundle | null;
}

/**
 * Takes a high model out of a bundle that holds two models side by side: the one that is named so, or else the larger one where the bundle holds nothing
 * else. Other bundles hold one model.
 */
export function pairOf(bundle: FileBundle): Pair {
  const models = [...bundle.keys()].filter((path) => MODEL_NAME.test(path));
  const stem = (path: string) => path.replace(/\.[^./]*$/, '');
  // Of one name, they are one model in two formats.
  if (models.length !== 2 || stem(models[0]) === stem(models[1])) return { low: bundle, high: null };
  const named = models.filter((path) => HIGH_NAME.test(path.replace(/^.*\//, '')));
  const size = (path: string) => bundle.get(path)!.size;
  const larger = bundle.size === 2 ? models.sort((a, b) => size(b) - size(a))[0] : undefined;
  const high = named.length === 1 ? named[0] : larger;
  if (high === undefined) return { low: bundle, high: null };
  const without = (model: string) => new Map([...bundle].filter(([path]) => path !== model));
  return { low: without(high), high: without(models.find((path) => path !== high)!) };
}

/** The path of a URI that is relative to the file `base`; null for other URIs. */
export function resolvePath(uri: string, base: string): string | null {
  if (/^[a-z][a-z0-9+.-]+:/i.test(uri) || uri.startsWith('/')) return null;
  const parts = base.split('/').slice(0, -1);
  for (const part of percentDecoded(uri).replaceAll('\\', '/').split('/')) {
    if (part === '..') parts.pop();
    else if (part !== '.' && part !== '') parts.push(part);
  }
  return parts.join('/');
}

/** The decoded URI, or the URI itself where an escape is invalid. */
function percentDecoded(uri: string): string {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}
