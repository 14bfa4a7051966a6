// The page's elements.

/** The element with an id, which index.html has. */
export function element<E extends HTMLElement>(id: string): E {
  return document.getElementById(id) as E;
}
