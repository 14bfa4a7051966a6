// The ground below the model: the background, darkened by the shadow of the model. It is drawn before the model and is not seen from below.

import { BufferAttribute, BufferGeometry, Color, DataTexture, LinearFilter, Mesh, RedFormat, ShaderMaterial } from 'three';

import type { GroundShadow } from './ground-shadow';

/** The corners of a square that faces up, along x and then along z, and its triangles. */
const CORNERS = Float32Array.from([-1, 0, -1, 1, 0, -1, -1, 0, 1, 1, 0, 1]);
const TRIANGLES = [0, 2, 1, 1, 2, 3];

export class Ground {
  readonly object: Mesh<BufferGeometry, ShaderMaterial>;
  private shown: GroundShadow | null = null;

  constructor() {
    const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(CORNERS, 3)).setIndex(TRIANGLES);
    const material = new ShaderMaterial({
      uniforms: { shadow: { value: null }, background: { value: new Color() } },
      depthTest: false,
      depthWrite: false,
      vertexShader: `
        varying vec2 place;
        void main() {
          place = 0.5 + 0.5 * position.xz;
          gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
          // The near and far planes are set for the model and would cut the ground.
          gl_Position.z = 0.0;
        }`,
      fragmentShader: `
        uniform sampler2D shadow;
        uniform vec3 background;
        varying vec2 place;
        void main() {
          gl_FragColor = vec4(background * (1.0 - texture2D(shadow, place).r), 1.0);
          #include <colorspace_fragment>
        }`,
    });
    this.object = new Mesh(geometry, material);
    this.object.frustumCulled = false;
    this.object.visible = false;
    this.object.renderOrder = -1;
  }

  /** Shows a shadow, or no ground. */
  show(shadow: GroundShadow | null): void {
    this.object.visible = shadow !== null;
    if (!shadow || shadow === this.shown) return;
    this.shown = shadow;
    const { uniforms } = this.object.material;
    const texture = new DataTexture(shadow.texels, shadow.side, shadow.side, RedFormat);
    Object.assign(texture, { magFilter: LinearFilter, minFilter: LinearFilter, needsUpdate: true });
    uniforms.shadow.value?.dispose();
    uniforms.shadow.value = texture;
    this.object.position.fromArray(shadow.middle);
    this.object.scale.set(shadow.halfSide, 1, shadow.halfSide);
  }

  /** Sets the colour behind the model. */
  background(color: Color): void {
    this.object.material.uniforms.background.value.copy(color);
  }
}
