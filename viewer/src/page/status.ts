// What is being done, and what went wrong.

import { element } from './elements';

/** Shows work, and how much of it is done, from 0 to 1; null where that is not known. */
export function showProgress(what: string, done: number | null): void {
  say(what);
  const bar = element<HTMLProgressElement>('progress');
  bar.hidden = false;
  if (done === null) bar.removeAttribute('value');
  else bar.value = done;
}

/** Shows that work has ended. */
export function showDone(what: string): void {
  say(what);
  element('progress').hidden = true;
}

/** What is said again is not read aloud again. */
function say(what: string): void {
  const status = element('status');
  if (status.textContent !== what) status.textContent = what;
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
