// The page's elements, which index.html has.

/** The element with an id. */
export function element<E extends HTMLElement>(id: string): E {
  return document.getElementById(id) as E;
}

/** The number that an input has. */
export function numberOf(id: string): number {
  return Number(element<HTMLInputElement>(id).value);
}

/** Whether a checkbox is on. */
export function isOn(id: string): boolean {
  return element<HTMLInputElement>(id).checked;
}
