// Marks the place that a finding leads to: a point, the outline of a triangle, or the box of a part.

import { Box3, Box3Helper, BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineLoop, type Matrix4, Points, PointsMaterial, type Vector3 } from 'three';

const LOOK = { color: 0xff4dd8, depthTest: false, transparent: true, toneMapped: false };

export class PlaceMarker {
  readonly object = new Group();
  private readonly point = new Points(buffer(new Float32Array(3)), new PointsMaterial({ ...LOOK, size: 12, sizeAttenuation: false, opacity: 0.8 }));
  private readonly outline = new LineLoop(buffer(new Float32Array(9)), new LineBasicMaterial(LOOK));

  private readonly box = new Box3Helper(new Box3(), LOOK.color);

  constructor() {
    for (const object of [this.point, this.outline]) object.frustumCulled = false;
    this.outline.matrixAutoUpdate = false;
    this.object.add(this.point, this.outline, this.box);
    this.hide();
  }

  /** Marks a point of the scene and, if they are given, the corners of a triangle, which `place` transforms to the scene. */
  showAt(point: Vector3, corners: Float32Array | null = null, place: Matrix4 | null = null): void {
    this.point.position.copy(point);
    [this.point.visible, this.outline.visible, this.box.visible] = [true, corners !== null, false];
    if (corners) (this.outline.geometry.getAttribute('position') as BufferAttribute).copyArray(corners).needsUpdate = true;
    if (place) this.outline.matrix.copy(place);
    this.object.visible = true;
  }

  /** Marks a box of the scene. */
  showBox(box: Box3): void {
    [this.point.visible, this.outline.visible, this.box.visible] = [false, false, true];
    this.box.box.copy(box);
    this.object.visible = true;
  }

  hide(): void {
    this.object.visible = false;
  }
}

function buffer(positions: Float32Array): BufferGeometry {
  return new BufferGeometry().setAttribute('position', new BufferAttribute(positions, 3));
}
