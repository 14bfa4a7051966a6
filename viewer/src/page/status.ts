// The status line, the progress bar and the error message.

import { element } from './elements';

/** Shows a task and its progress from 0 to 1, or null where that is unknown. */
export function showProgress(task: string, fraction: number | null): void {
  setStatus(task);
  const bar = element<HTMLProgressElement>('progress');
  bar.hidden = false;
  if (fraction === null) bar.removeAttribute('value');
  else bar.value = fraction;
}

/** Shows a text and hides the progress bar. */
export function showDone(text: string): void {
  setStatus(text);
  element('progress').hidden = true;
}

/** Sets the status line. Screen readers do not repeat an unchanged text. */
function setStatus(text: string): void {
  const status = element('status');
  if (status.textContent !== text) status.textContent = text;
}

/** Shows an error of any type. */
export function showError(error: unknown): void {
  element('error').textContent = error instanceof Error ? error.message : String(error);
  showDone('');
}

/** Clears the error. */
export function clearError(): void {
  element('error').textContent = '';
}
