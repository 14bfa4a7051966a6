// The outline of a fault: the whole seam, drawn beside it and not over it.

import type { Matrix4 } from 'three';
import { Vector3 } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

/** The colour of outlines. */
export const OUTLINE_COLOR = '#4de1ff';

/** The width of outlines in pixels. */
const WIDTH = 2.5;

/** An outline in every copy of a part. `ends`: 6 floats per edge. */
export function outlineLines(ends: Float32Array, places: Matrix4[]): LineSegments2 {
  const out = new Float32Array(ends.length * places.length);
  const end = new Vector3();
  places.forEach((place, copy) => {
    for (let at = 0; at < ends.length; at += 3) end.fromArray(ends, at).applyMatrix4(place).toArray(out, copy * ends.length + at);
  });
  const material = new LineMaterial({ color: OUTLINE_COLOR, linewidth: WIDTH, toneMapped: false, transparent: true, opacity: 0.9 });
  const lines = new LineSegments2(new LineSegmentsGeometry().setPositions(out), material);
  lines.frustumCulled = false;
  return lines;
}
