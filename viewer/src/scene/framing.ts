// Where the camera must be to see a whole box, as `darboux render` computes it (crates/darboux-render/src/camera.rs), or a part of it.

import { type Box3, Vector3 } from 'three';

/** The fraction of the picture that stays empty around the box. */
const MARGIN = 0.04;
/** The iterations that centre the box. */
const CENTRING_STEPS = 4;

/** The factor by which the camera goes back at a time until enough of a box is in the picture. */
const STEP_BACK = 1.05;

/** The position of a camera and the point that it looks at. */
export interface Framing {
  eye: Vector3;
  target: Vector3;
}

/** Sees a box from a direction, with equal margins at opposite edges. `from`: towards the camera; `fieldOfView`: vertical, in degrees. */
export function framing(box: Box3, from: Vector3, fieldOfView: number, aspect: number): Framing {
  const centre = box.getCenter(new Vector3());
  const { right, up, towards } = axesOf(from);
  const corners = cornersFrom(box, centre).map((corner) => [right, up, towards].map((axis) => corner.dot(axis)));
  const tangent = Math.tan((fieldOfView * Math.PI) / 360);
  const slopes = [tangent * aspect, tangent].map((slope) => slope * (1 - MARGIN));
  // For each axis, two planes through the eye touch the corners where x + slope z and slope z - x are largest.
  const touch = (slopes: number[]) => slopes.map((slope, axis) => {
    const most = (sign: number) => Math.max(...corners.map((corner) => sign * corner[axis] + slope * corner[2]));
    return [(most(1) + most(-1)) / 2, (most(1) - most(-1)) / 2];
  });
  let touched = touch(slopes);
  const distance = Math.max(touched[0][0] / slopes[0], touched[1][0] / slopes[1], 1e-9);
  for (let step = 0; step < CENTRING_STEPS; step++) touched = touch(touched.map(([halfSum]) => halfSum / distance));
  const target = centre.addScaledVector(right, touched[0][1]).addScaledVector(up, touched[1][1]);
  return { eye: target.clone().addScaledVector(towards, distance), target };
}

/**
 * The view in the same direction from as far away as is needed to have a share of a box in the picture. The box counts as the rectangle around it, as if it
 * were seen from afar. `share`: below 1.
 */
export function withInSight({ eye, target }: Framing, box: Box3, share: number, fieldOfView: number, aspect: number): Framing {
  const { right, up, towards } = axesOf(eye.clone().sub(target));
  const corners = cornersFrom(box, target);
  const extents = [right, up].map((axis) => corners.map((corner) => corner.dot(axis))).map((along) => [Math.min(...along), Math.max(...along)]);
  const slope = Math.tan((fieldOfView * Math.PI) / 360);
  const inSight = (distance: number) => {
    const seen = [slope * aspect * distance, slope * distance];
    const parts = extents.map(([least, most], axis) => (most > least ? (Math.min(most, seen[axis]) - Math.max(least, -seen[axis])) / (most - least) : 1));
    return Math.max(0, parts[0]) * Math.max(0, parts[1]);
  };
  let distance = eye.distanceTo(target);
  // An eye in the target itself would stay there.
  while (distance > 0 && inSight(distance) < share) distance *= STEP_BACK;
  return { eye: target.clone().addScaledVector(towards, distance), target };
}

/** The directions of a picture that is seen from a direction. */
function axesOf(from: Vector3): { right: Vector3; up: Vector3; towards: Vector3 } {
  const towards = from.clone().normalize();
  const right = new Vector3(0, 1, 0).cross(towards);
  if (right.lengthSq() < 1e-12) right.set(1, 0, 0);
  right.normalize();
  return { right, up: towards.clone().cross(right), towards };
}

/** The corners of a box, relative to a point. */
function cornersFrom({ min, max }: Box3, from: Vector3): Vector3[] {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => new Vector3(bits & 1 ? max.x : min.x, bits & 2 ? max.y : min.y, bits & 4 ? max.z : min.z).sub(from));
}
