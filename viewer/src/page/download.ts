// Files that the page gives.

/** Offers a file for download. */
export function save(name: string, content: Blob): void {
  const link = document.createElement('a');
  link.download = name;
  link.href = URL.createObjectURL(content);
  link.click();
  // The download has its own hold on the file once this task has ended.
  setTimeout(() => URL.revokeObjectURL(link.href));
}

/** The name of a file made of another: without folders, with another ending. */
export function nameLike(path: string, ending: string): string {
  return path.replace(/^.*\//, '').replace(/\.[^.]*$/, '') + ending;
}
