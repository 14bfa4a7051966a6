// Access to the elements of index.html.

/** The element with an id. */
export function element<E extends HTMLElement>(id: string): E {
  return document.getElementById(id) as E;
}

/** The value of a number input. */
export function numberOf(id: string): number {
  return Number(element<HTMLInputElement>(id).value);
}

/** Whether a checkbox is checked. */
export function isOn(id: string): boolean {
  return element<HTMLInputElement>(id).checked;
}
