// What is being done, and what went wrong.

import { element } from './elements';

/** Shows work, and how much of it is done, from 0 to 1; null where that is not known. */
export function showProgress(what: string, done: number | null): void {
  element('status').textContent = what;
  const bar = element<HTMLProgressElement>('progress');
  bar.hidden = false;
  if (done === null) bar.removeAttribute('value');
  else bar.value = done;
}

/** Shows that work has ended. */
export function showDone(what: string): void {
  element('status').textContent = what;
  element('progress').hidden = true;
}

/** Shows what went wrong; takes errors of all kinds. */
export function showError(error: unknown): void {
  element('error').textContent = error instanceof Error ? error.message : String(error);
  showDone('');
}

/** Takes the last error away. */
export function clearError(): void {
  element('error').textContent = '';
}
