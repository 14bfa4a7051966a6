// Icons of severities. Their shapes differ, so that colour is not needed: an octagon, a triangle, a circle.

import type { Finding } from 'darboux/check';

const SHAPES: Record<Finding['severity'], [string, string]> = {
  error: ['M5 1h6l4 4v6l-4 4H5l-4-4V5z', 'M5.5 5.5l5 5m0-5l-5 5'],
  warning: ['M8 1.5l7 13H1z', 'M8 6v4m0 1.6v1.4'],
  info: ['M8 1a7 7 0 1 1 0 14A7 7 0 0 1 8 1z', 'M8 7.2v4.6m0-7.4v1.4'],
  'not-checked': ['M8 1a7 7 0 1 1 0 14A7 7 0 0 1 8 1z', 'M4.8 8h6.4'],
};

const SVG = 'http://www.w3.org/2000/svg';

/** The icon of a severity. The text beside it says the same. */
export function severityIcon(severity: Finding['severity']): SVGElement {
  const icon = document.createElementNS(SVG, 'svg');
  icon.setAttribute('viewBox', '0 0 16 16');
  icon.setAttribute('aria-hidden', 'true');
  for (const [at, name] of ['shape', 'mark'].entries()) {
    const path = document.createElementNS(SVG, 'path');
    path.setAttribute('d', SHAPES[severity][at]);
    path.setAttribute('class', name);
    icon.append(path);
  }
  return icon;
}
