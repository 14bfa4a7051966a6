// The tabs of the panel.

import { element } from './elements';

const TABS = ['check', 'view', 'pose', 'bake', 'light'] as const;

export type Tab = (typeof TABS)[number];

/** Connects clicks and the keys of tabs (WAI-ARIA Authoring Practices, "Tabs"). */
export function connectTabs(): void {
  for (const tab of TABS) element(`tab-${tab}`).addEventListener('click', () => showTab(tab));
  element('tabs').addEventListener('keydown', (event) => {
    const steps: Record<string, number> = { ArrowRight: 1, ArrowLeft: -1, Home: -TABS.indexOf(shownTab()), End: TABS.length - 1 - TABS.indexOf(shownTab()) };
    const step = steps[event.key];
    if (step === undefined) return;
    event.preventDefault();
    const tab = TABS[(TABS.indexOf(shownTab()) + step + TABS.length) % TABS.length];
    showTab(tab);
    element(`tab-${tab}`).focus();
  });
}

/** Shows a tab in place of the one before. Names that are no tab are ignored. */
export function showTab(tab: string): void {
  if (!TABS.some((other) => other === tab)) return;
  for (const other of TABS) {
    const [button, isShown] = [element(`tab-${other}`), other === tab];
    button.ariaSelected = String(isShown);
    button.tabIndex = isShown ? 0 : -1;
    element(`panel-${other}`).hidden = !isShown;
  }
}

/** The tab that is shown. */
export function shownTab(): Tab {
  return TABS.find((tab) => !element(`panel-${tab}`).hidden) ?? 'check';
}
