// Files that come together: a model and what it refers to.

/** Files by their path, with / between parts. */
export type Bundle = Map<string, Blob>;

/** More files than any model has: a home folder, dropped by mistake. */
const MOST_FILES = 5000;

/** The files of an input element. */
export function fromList(files: Iterable<File>): Bundle {
  return new Map([...files].map((file) => [file.webkitRelativePath || file.name, file]));
}

/** What was dropped, folders with all that lies below them. */
export async function fromDrop(data: DataTransfer): Promise<Bundle> {
  // Entries must be taken before anything is awaited: the list is emptied when the event ends.
  const entries = [...data.items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
  if (!entries.length) return fromList(data.files);
  const bundle: Bundle = new Map();
  for (const entry of entries) await collect(entry, bundle);
  return bundle;
}

async function collect(entry: FileSystemEntry, bundle: Bundle): Promise<void> {
  if (bundle.size > MOST_FILES) throw new Error(`There are more than ${MOST_FILES.toLocaleString('en')} files in that folder; drop the model's own.`);
  if (entry.isDirectory) {
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    for (;;) {
      const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
      if (!some.length) return;
      for (const inner of some) await collect(inner, bundle);
    }
  }
  const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
  bundle.set(entry.fullPath.replace(/^\//, ''), file);
}

/** The path that `uri` means, seen from the file at `base`; null for what is no relative path. */
export function located(uri: string, base: string): string | null {
  if (/^[a-z][a-z0-9+.-]+:/i.test(uri) || uri.startsWith('/')) return null;
  const parts = base.split('/').slice(0, -1);
  for (const part of decoded(uri).replaceAll('\\', '/').split('/')) {
    if (part === '..') parts.pop();
    else if (part !== '.' && part !== '') parts.push(part);
  }
  return parts.join('/');
}

function decoded(uri: string): string {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}
