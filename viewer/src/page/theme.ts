// Dark and light colours: those of the system until the button is pressed.

import { element } from './elements';

/** Sets the page's colours now and on every change. `changed` gets the background colours of the model and of the UV layout. */
export function connectTheme(changed: (model: string, layout: string) => void): void {
  const light = matchMedia('(prefers-color-scheme: light)');
  const button = element('theme');
  const set = (isLight: boolean) => {
    document.documentElement.dataset.theme = isLight ? 'light' : 'dark';
    button.ariaPressed = String(isLight);
    const style = getComputedStyle(document.documentElement);
    changed(style.getPropertyValue('--stage').trim(), style.getPropertyValue('--chart').trim());
  };
  light.addEventListener('change', () => set(light.matches));
  button.addEventListener('click', () => set(button.ariaPressed !== 'true'));
  set(light.matches);
}
