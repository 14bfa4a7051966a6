// Dark and light: as the system has it, until the button is pressed.

import { element } from './elements';

/** Sets the page's colours, now and whenever they change; `changed` is told those behind the model and behind its layout. */
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
