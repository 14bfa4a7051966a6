// What the controls say.

import type { Source } from './surface/sources';

/** What the surface is painted with. */
export const PAINTS = ['shaded', 'tangent', 'bitangent', 'normal', 'sign', 'angle'] as const;

export type Paint = (typeof PAINTS)[number];

/** Mistakes that circulate, made on the right side. */
export interface Mistakes {
  green: boolean;
  w: boolean;
  v: boolean;
}

/** Vectors that can be drawn as lines. */
export const VECTORS = ['tangent', 'bitangent', 'normal'] as const;

export type VectorName = (typeof VECTORS)[number];

export interface Settings {
  sources: readonly [Source, Source];
  paint: Paint;
  vectors: Record<VectorName, boolean>;
  /** Of lines, as a part of the model's radius. */
  length: number;
  seams: boolean;
  layout: boolean;
  pattern: boolean;
  mistakes: Mistakes;
}
