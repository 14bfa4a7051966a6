// Marks the place that the report leads to.

import { BufferAttribute, BufferGeometry, Points, PointsMaterial, type Vector3 } from 'three';

export class PlaceMarker {
  readonly object = new Points(
    new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(3), 3)),
    new PointsMaterial({ color: 0xff4dd8, size: 12, sizeAttenuation: false, depthTest: false, transparent: true, opacity: 0.8, toneMapped: false }),
  );

  constructor() {
    this.object.frustumCulled = false;
    this.hide();
  }

  showAt(place: Vector3): void {
    this.object.position.copy(place);
    this.object.visible = true;
  }

  hide(): void {
    this.object.visible = false;
  }
}
