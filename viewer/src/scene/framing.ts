// Where the camera must be to see a whole box, as `darboux render` computes it (crates/darboux-render/src/camera.rs).

import { type Box3, Vector3 } from 'three';

/** The fraction of the picture that stays empty around the box. */
const MARGIN = 0.04;
/** The iterations that centre the box. */
const CENTRING_STEPS = 4;

/** The position of a camera and the point that it looks at. */
export interface Framing {
  eye: Vector3;
  target: Vector3;
}

/** Sees a box from a direction, with equal margins at opposite edges. `from`: towards the camera; `fieldOfView`: vertical, in degrees. */
export function framing(box: Box3, from: Vector3, fieldOfView: number, aspect: number): Framing {
  const centre = box.getCenter(new Vector3());
  const towards = from.clone().normalize();
  const right = new Vector3(0, 1, 0).cross(towards);
  if (right.lengthSq() < 1e-12) right.set(1, 0, 0);
  right.normalize();
  const up = towards.clone().cross(right);
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((bits) => {
    const corner = new Vector3(...[0, 1, 2].map((axis) => ((bits >> axis) & 1 ? box.max : box.min).getComponent(axis)) as [number, number, number]).sub(centre);
    return [corner.dot(right), corner.dot(up), corner.dot(towards)];
  });
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
