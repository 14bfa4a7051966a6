// What is being done, and what went wrong.

import { element } from './elements';

/** Shows work, and how much of it is done. */
export function showProgress(what: string, done: number): void {
  element('status').textContent = what;
  const bar = element<HTMLProgressElement>('progress');
  bar.hidden = false;
  bar.value = done;
}

/** Shows that nothing is being done any more. */
export function showDone(what: string): void {
  element('status').textContent = what;
  element('progress').hidden = true;
}

/** Shows what went wrong, as a sentence; '' for nothing. */
export function showError(sentence: string): void {
  element('error').textContent = sentence;
}
