// Downloads of files that the page makes.

/** Downloads a file. */
export function save(name: string, content: Blob): void {
  const link = document.createElement('a');
  link.download = name;
  link.href = URL.createObjectURL(content);
  link.click();
  // The download keeps the file alive once this task has ended.
  setTimeout(() => URL.revokeObjectURL(link.href));
}

/** The name of a derived file: without folders, with another extension. */
export function nameLike(path: string, ending: string): string {
  return path.replace(/^.*\//, '').replace(/\.[^.]*$/, '') + ending;
}
