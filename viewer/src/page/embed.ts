// The viewer inside another page, `?embed`: the picture with its slider, captions and sentence, without header and panel.

import { element } from './elements';

/** Leaves out header and panel where the address asks for it. */
export function connectEmbedding(): void {
  if (!new URLSearchParams(location.search).has('embed')) return;
  document.documentElement.classList.add('is-embedded');
  const link = element<HTMLAnchorElement>('whole-page');
  link.hidden = false;
  // The state in the address is that of the moment of the press.
  link.addEventListener('click', () => (link.href = wholePage()));
  link.href = wholePage();
  // The wheel scrolls the page around the picture; with Ctrl, as trackpads pinch, it zooms.
  element('view').addEventListener('wheel', (event) => event.ctrlKey || event.stopImmediatePropagation(), { capture: true });
}

/** The address of the same state with header and panel. */
function wholePage(): string {
  const address = new URL(location.href);
  address.searchParams.delete('embed');
  return address.href;
}
