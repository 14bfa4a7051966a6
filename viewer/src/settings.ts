// The settings that the controls choose and the scene draws by.

import type { Shown } from './surface/sources';

/**
 * What the colours of the surface show. `bumps` is the shaded surface with a pattern of bumps where the file has no normal map; `plain` is a grey matt
 * surface with the file's normal maps, on which light and shadow are seen better than on dark or colourful textures.
 */
export const PAINTS = ['shaded', 'bumps', 'plain', 'tangent', 'bitangent', 'normal', 'sign', 'angle'] as const;

export type Paint = (typeof PAINTS)[number];

/** Whether the surface is lit, in place of showing frames as colours. */
export function isLit(paint: Paint): boolean {
  return paint === 'shaded' || paint === 'bumps' || paint === 'plain';
}

/** Common mistakes with normal maps, applied to the right side on request. */
export interface Mistakes {
  /** Negates the green channel of the normal map. */
  green: boolean;
  /** Negates the sign of the tangents. */
  w: boolean;
  /** Replaces v by 1 - v. */
  v: boolean;
}

/** Vectors that can be drawn as lines. */
export const VECTORS = ['tangent', 'bitangent', 'normal'] as const;

export type VectorName = (typeof VECTORS)[number];

export interface Settings {
  /** What the left and the right side show. */
  sources: readonly [Shown, Shown];
  paint: Paint;
  vectors: Record<VectorName, boolean>;
  /** The length of lines, relative to the model's radius. */
  length: number;
  /** Whether mirrored edges are drawn. */
  seams: boolean;
  /** Whether the outline of the model's fault is drawn. */
  outline: boolean;
  /** Whether lit models stand on the ground. */
  ground: boolean;
  /** Whether the edges of triangles are drawn. */
  wireframe: boolean;
  /** The numbers of the parts that are not shown. */
  hidden: Set<number>;
  /** Whether the UV layout is drawn. */
  layout: boolean;
  mistakes: Mistakes;
}
