// The viewport: camera, light, environment, and drawing, once for each side of the slider.

import {
  type Box3,
  type Camera,
  Color,
  DirectionalLight,
  NeutralToneMapping,
  type Intersection,
  Mesh,
  type Object3D,
  PerspectiveCamera,
  Raycaster,
  Scene,
  Sphere,
  Spherical,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { fly, type View } from './camera-flight';
import { LayoutCamera } from './layout-camera';
import type { Side } from './model-view';
import { studio } from './studio';

/** The vertical field of view in degrees. */
const FIELD_OF_VIEW = 35;

/** The side of the UV layout, relative to the shorter side of the picture; page.css places its frame likewise. */
const LAYOUT_SIZE = 0.5;
/** The distance of the UV layout from the right edge in pixels. */
const LAYOUT_RIGHT = 12;
/** The distance of the UV layout from the bottom edge in pixels. */
const LAYOUT_BOTTOM = 36;

/** The time in milliseconds without a move after which the camera rests. */
const REST = 250;

/** What lies under a place of the picture. */
export interface Picked {
  /** 0 for the left side, 1 for the right one. */
  side: 0 | 1;
  hit: Intersection<Mesh>;
}

export class Viewport {
  readonly camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 0.01, 100);
  readonly controls: OrbitControls;
  /** The position of the slider, from 0 to 1. */
  split = 0.5;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly light = new DirectionalLight(0xffffff, 2);
  private readonly layouts = new Scene();
  /** The part of the UV layout that is shown. */
  readonly layoutCamera = new LayoutCamera(() => this.draw());
  private readonly sphere = new Sphere(new Vector3(), 1);
  private sides: Side[] = [];
  private hasLayout = false;
  private coarse: Mesh | null = null;
  /** Whether the sides are those of the model, and not of the one before it. */
  private hasSides = true;
  private isMoving = false;
  private restTimer = 0;
  /** The requested animation frame, or 0. */
  private requestedFrame = 0;
  private stopFlight = () => {};

  /** Errors: the browser has no WebGL 2. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.toneMapping = NeutralToneMapping;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.moved());
    this.controls.addEventListener('start', () => this.stopFlight());
    this.scene.add(this.light, this.light.target);
    this.scene.environment = studio();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** The radius of the model. */
  get radius(): number {
    return this.sphere.radius;
  }

  /** Sets the coarse copy of a large model, or null. It is shown until there are sides, and while the camera moves. */
  setCoarse(copy: Mesh | null): void {
    this.coarse?.removeFromParent();
    this.coarse?.geometry.dispose();
    this.coarse = copy;
    if (copy) this.scene.add(copy);
    this.hasSides = !copy;
    this.draw();
  }

  /** Draws the coarse copy until the camera rests. */
  private moved(): void {
    if (this.coarse) {
      clearTimeout(this.restTimer);
      this.isMoving = true;
      this.restTimer = setTimeout(() => {
        this.isMoving = false;
        this.draw();
      }, REST);
    }
    this.draw();
  }

  /** Replaces both sides. */
  show(sides: Side[], hasLayout: boolean): void {
    this.hasSides = true;
    this.sides = sides;
    this.hasLayout = hasLayout;
    this.scene.add(...sides.map((side) => side.model));
    this.layouts.add(...sides.map((side) => side.layout));
    this.draw();
  }

  /** Adds an object that both sides show. */
  add(object: Object3D): void {
    this.scene.add(object);
  }

  /** Sets the colours behind the model and behind its layout. */
  background(color: string, layout: string): void {
    this.scene.background = new Color(color);
    this.layouts.background = new Color(layout);
    this.draw();
  }

  /** Sets the direction of the light in degrees: azimuth and elevation. */
  lightFrom(around: number, above: number): void {
    const [a, b] = [around, above].map((degrees) => (degrees * Math.PI) / 180);
    const direction = new Vector3(Math.sin(a) * Math.cos(b), Math.sin(b), Math.cos(a) * Math.cos(b));
    this.light.position.copy(this.sphere.center).addScaledVector(direction, 10 * this.sphere.radius);
    this.light.target.position.copy(this.sphere.center);
    this.draw();
  }

  /** Sets the intensity of the environment and of the light. */
  brightness(surroundings: number, light: number): void {
    this.scene.environmentIntensity = surroundings;
    this.light.intensity = light;
    this.draw();
  }

  /** Sets the bounding sphere of the model from its box. */
  setBounds(box: Box3): void {
    box.getBoundingSphere(this.sphere);
    if (!(this.sphere.radius > 0) || !Number.isFinite(this.sphere.radius)) this.sphere.set(new Vector3(), 1);
  }

  /** Shows the whole model, from the front and slightly above. */
  lookAtAll(): void {
    this.look(this.sphere.center, this.sphere.radius, new Vector3(0.35, 0.3, 1));
  }

  /** Looks at a point from a direction, so that a sphere around it is in view. */
  look(at: Vector3, radius: number, from: Vector3, isFlight = false): void {
    const distance = radius / Math.sin(((FIELD_OF_VIEW / 2) * Math.PI) / 180) / Math.min(1, this.camera.aspect);
    this.camera.near = Math.min(this.sphere.radius, radius) / 100;
    this.camera.far = this.sphere.radius * 20 + distance;
    const to = { eye: at.clone().addScaledVector(from.clone().normalize(), distance), target: at.clone() };
    const move = ({ eye, target }: View) => {
      this.camera.position.copy(eye);
      this.controls.target.copy(target);
      this.controls.update();
      this.draw();
    };
    this.stopFlight();
    if (isFlight) this.stopFlight = fly({ eye: this.camera.position.clone(), target: this.controls.target.clone() }, to, move);
    else move(to);
  }

  /** Orbits around the model by degrees, and moves closer by a factor. */
  orbit(around: number, above: number, nearer = 1): void {
    this.stopFlight();
    const offset = this.camera.position.clone().sub(this.controls.target);
    const { radius, phi, theta } = new Spherical().setFromVector3(offset);
    const turned = new Spherical(radius / nearer, phi - (above * Math.PI) / 180, theta + (around * Math.PI) / 180).makeSafe();
    this.camera.position.setFromSpherical(turned).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  /** The first surface under a place of the canvas, in CSS pixels; null where there is none. */
  pick(x: number, y: number): Picked | null {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const side = x < this.split * width ? 0 : 1;
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
    const meshes = this.sides[side]?.model.children.filter((object) => object instanceof Mesh && object.userData.part !== undefined) ?? [];
    const [hit] = caster.intersectObjects<Mesh>(meshes as Mesh[], false);
    return hit ? { side, hit } : null;
  }

  /** The position of the camera and the point that it looks at, 6 numbers. */
  view(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }

  /** Sets what {@link view} returns. */
  setView(view: number[]): void {
    this.stopFlight();
    this.camera.position.fromArray(view);
    this.controls.target.fromArray(view, 3);
    this.camera.near = this.sphere.radius / 1000;
    this.camera.far = this.sphere.radius * 20 + this.camera.position.distanceTo(this.sphere.center);
    this.controls.update();
    this.draw();
  }

  /** Looks from a camera of the file to where the model is. */
  lookFrom(camera: Camera): void {
    camera.updateWorldMatrix(true, false);
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    const ahead = new Vector3(0, 0, -1).transformDirection(camera.matrixWorld);
    const distance = Math.max(ahead.dot(this.sphere.center.clone().sub(eye)), 0.1 * this.sphere.radius);
    this.setView([...eye.toArray(), ...eye.clone().addScaledVector(ahead, distance).toArray()]);
  }

  /** Requests a frame. Several calls before the next frame draw once. */
  draw(): void {
    this.requestedFrame ||= requestAnimationFrame(() => this.drawNow());
  }

  /** The picture as a file. */
  async picture(): Promise<Blob> {
    this.isMoving = false;
    // The drawing buffer is valid until this task ends.
    this.drawNow();
    const blob = await new Promise<Blob | null>((resolve) => this.canvas.toBlob(resolve, 'image/png'));
    if (!blob) throw new Error('The browser cannot save a picture of this size; make the window smaller.');
    return blob;
  }

  private drawNow(): void {
    cancelAnimationFrame(this.requestedFrame);
    this.requestedFrame = 0;
    const { renderer, canvas, camera } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    this.drawSplit(0, 0, width, height, this.scene, camera);
    if (!this.hasLayout || this.isCoarse()) return;
    const size = Math.round(LAYOUT_SIZE * Math.min(width, height));
    this.drawSplit(width - size - LAYOUT_RIGHT, LAYOUT_BOTTOM, size, size, this.layouts, this.layoutCamera.camera);
  }

  private isCoarse(): boolean {
    return this.coarse !== null && (this.isMoving || !this.hasSides);
  }

  /** Draws a rectangle of the canvas: the left side left of the slider and the right side right of it. */
  private drawSplit(left: number, bottom: number, width: number, height: number, scene: Scene, camera: Camera): void {
    const { renderer } = this;
    const isCoarse = this.isCoarse();
    if (this.coarse) this.coarse.visible = isCoarse;
    const middle = isCoarse ? width : Math.round(width * this.split);
    renderer.setViewport(left, bottom, width, height);
    renderer.setScissorTest(true);
    for (const [at, [from, to]] of [[0, middle], [middle, width]].entries()) {
      if (from === to) continue;
      this.sides.forEach((side, other) => (side.model.visible = side.layout.visible = at === other && !isCoarse));
      renderer.setScissor(left + from, bottom, to - from, height);
      renderer.render(scene, camera);
    }
    renderer.setScissorTest(false);
  }
}
