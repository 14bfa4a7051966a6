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
