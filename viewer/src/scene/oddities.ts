// What keeps a model, or a part of it, from being seen.

import { counted } from '../plural';
import type { GivenSurface } from '../surface/surface';

/** Larger or smaller coordinates exceed what a graphics card computes with. */
const [LARGEST, SMALLEST] = [1e15, 1e-15];

/** Sentences, without a full stop, about what is not shown. */
export function oddities(surfaces: GivenSurface[]): string[] {
  const all = surfaces.reduce((sum, { indices }) => sum + indices.length / 3, 0);
  const lost = surfaces.reduce((sum, surface) => sum + countInfinite(surface), 0);
  const said: string[] = [];
  if (lost === all) said.push('nothing is shown, because every triangle has a position that is NaN or infinite; export the model again');
  else if (lost) said.push(`${counted(lost, 'triangle is', 'triangles are')} not shown, because positions are NaN or infinite`);
  const size = Math.max(...surfaces.map(({ positions }) => largest(positions)));
  if (size > LARGEST) said.push(`coordinates reach ${size.toExponential(1)}, which is too large to be drawn; scale the model`);
  else if (size < SMALLEST && lost < all) said.push('all positions are nearly the same, so that there is nothing to see; scale the model');
  return said;
}

/** The triangles with a position that is not finite. */
function countInfinite({ positions, indices }: GivenSurface): number {
  const isLost = (vertex: number) => !Number.isFinite(positions[vertex * 3] + positions[vertex * 3 + 1] + positions[vertex * 3 + 2]);
  let count = 0;
  for (let corner = 0; corner < indices.length; corner += 3) {
    if (isLost(indices[corner]) || isLost(indices[corner + 1]) || isLost(indices[corner + 2])) count++;
  }
  return count;
}

/** The largest finite coordinate, without its sign. */
function largest(positions: Float32Array): number {
  let found = 0;
  for (const x of positions) if (Number.isFinite(x)) found = Math.max(found, Math.abs(x));
  return found;
}
