// The viewport: camera, light, environment, and drawing, once for each side of the slider.

import {
  Box3,
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
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { fly, type View } from './camera-flight';
import { framing, withInSight } from './framing';
import { Ground } from './ground';
import type { GroundShadow } from './ground-shadow';
import { LayoutCamera } from './layout-camera';
import type { Side } from './model-view';
import { seenDifference, type SeenDifference } from './seen-difference';
import { ENVIRONMENTS, studio } from './studio';

/** The vertical field of view in degrees. */
const FIELD_OF_VIEW = 35;

/** Where the camera is at first: in front, slightly right of the middle and above. */
const HOME = new Vector3(0.35, 0.3, 1);

/** The directions from which a whole model is seen: from where the camera is at first, around, from above and from below. */
const AROUND = [HOME, ...[45, 90, 135, 180, 225, 270, 315].map((degrees) => turned(HOME, degrees)), ...[0, 90, 180, 270].map((degrees) => turned(new Vector3(0.35, 1.4, 1), degrees)), ...[0, 180].map((degrees) => turned(new Vector3(0.35, -0.7, 1), degrees))];

/** The side of the UV layout, relative to the shorter side of the picture; page.css places its frame likewise. */
const LAYOUT_SIZE = 0.5;
/** The distance of the UV layout from the right edge in pixels. */
const LAYOUT_RIGHT = 12;
/** The distance of the UV layout from the bottom edge in pixels. */
const LAYOUT_BOTTOM = 36;

/** The time in milliseconds without a move after which the camera rests. */
const REST = 250;

/** A picture that takes longer than this, in milliseconds, is too slow for a moving camera. */
const SLOW = 45;

/** The height in pixels of the pictures that are compared for where both sides differ. */
const COMPARED_HEIGHT = 150;

/** The least part of the model that is in sight where a person shall recognise it. */
const RECOGNISED = 1 / 3;

/** The least share of the canvas's height that is framed, whatever lies over the picture. */
const LEAST_FREE = 0.3;

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
  private readonly ground = new Ground();
  /** The part of the UV layout that is shown. */
  readonly layoutCamera = new LayoutCamera(() => this.draw());
  private readonly sphere = new Sphere(new Vector3(), 1);
  private sides: Side[] = [];
  private hasLayout = false;
  private coarse: Mesh | null = null;
  private makeCoarse: (() => Mesh) | null = null;
  /** Whether the last picture of both sides took too long for a moving camera. */
  private isSlow = false;
  private isMeasured = false;
  /** Whether the sides were drawn once, so that their shaders are compiled. */
  private isWarm = false;
  private readonly box = new Box3();
  private environment = '';
  /** Whether the sides are those of the model, and not of the one before it. */
  private hasSides = true;
  private isMoving = false;
  private restTimer = 0;
  /** The requested animation frame, or 0. */
  private requestedFrame = 0;
  private stopFlight = () => {};
  /** The heights in CSS pixels of what lies over the picture at its top and at its bottom. */
  private bands = { top: 0, bottom: 0 };

  /** Errors: the browser has no WebGL 2. */
  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.toneMapping = NeutralToneMapping;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.moved());
    this.controls.addEventListener('start', () => this.stopFlight());
    this.scene.add(this.light, this.light.target, this.ground.object);
    this.surround(ENVIRONMENTS[0].name);
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** The radius of the model. */
  get radius(): number {
    return this.sphere.radius;
  }

  /** The most texels along a side of a texture. */
  get mostTexels(): number {
    return this.renderer.capabilities.maxTextureSize;
  }

  /** Takes a function that makes the coarse copy of a model. The copy is shown while the camera moves, if pictures of the model take long. */
  offerCoarse(make: (() => Mesh) | null): void {
    this.coarse?.removeFromParent();
    this.coarse?.geometry.dispose();
    [this.coarse, this.makeCoarse, this.isSlow] = [null, make, false];
    this.hasSides = true;
  }

  /** Shows the coarse copy until there are sides. */
  showCoarse(): void {
    this.useCoarse();
    this.hasSides = false;
    // That of the model before.
    this.ground.show(null);
    this.draw();
  }

  private useCoarse(): void {
    if (this.coarse || !this.makeCoarse) return;
    this.coarse = this.makeCoarse();
    this.scene.add(this.coarse);
  }

  /** Draws the coarse copy until the camera rests, if the model is drawn slowly. */
  private moved(): void {
    if (this.isSlow) this.useCoarse();
    if (this.coarse && (this.isSlow || !this.hasSides)) {
      clearTimeout(this.restTimer);
      this.setMoving(true);
      this.restTimer = setTimeout(() => {
        this.setMoving(false);
        this.draw();
      }, REST);
    }
    this.draw();
  }

  /** Says whether the camera moves, to screen readers and tests, too: the canvas is busy while it shows the coarse copy. */
  private setMoving(isMoving: boolean): void {
    this.isMoving = isMoving;
    this.canvas.ariaBusy = String(isMoving);
  }

  /** Replaces both sides. */
  show(sides: Side[], hasLayout: boolean): void {
    this.hasSides = true;
    this.isMeasured = false;
    this.sides = sides;
    this.hasLayout = hasLayout;
    this.scene.add(...sides.map((side) => side.model));
    this.layouts.add(...sides.map((side) => side.layout));
    this.draw();
  }

  /** Shows the ground with a shadow, or no ground. */
  standOn(shadow: GroundShadow | null): void {
    this.ground.show(shadow);
    this.draw();
  }

  /** Adds an object that both sides show. */
  add(object: Object3D): void {
    this.scene.add(object);
  }

  /** Sets the colours behind the model and behind its layout. */
  background(color: string, layout: string): void {
    this.scene.background = new Color(color);
    this.ground.background(this.scene.background);
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

  /** Sets the intensity of the environment and of the light, and the exposure in steps of twice the light. */
  brightness(surroundings: number, light: number, exposure: number): void {
    this.scene.environmentIntensity = surroundings;
    this.light.intensity = light;
    this.renderer.toneMappingExposure = 2 ** exposure;
    this.draw();
  }

  /** Chooses an environment by its name. */
  surround(name: string): void {
    if (name === this.environment) return;
    this.environment = name;
    this.scene.environment?.dispose();
    this.scene.environment = studio(name);
    this.draw();
  }

  /** Sets the bounding sphere of the model from its box. */
  setBounds(box: Box3): void {
    box.getBoundingSphere(this.sphere);
    if (!(this.sphere.radius > 0) || !Number.isFinite(this.sphere.radius)) this.sphere.set(new Vector3(), 1);
    this.box.copy(box.isEmpty() ? new Box3().setFromCenterAndSize(this.sphere.center, new Vector3(1, 1, 1)) : box);
  }

  /** Shows the whole model, from the front and slightly above. */
  lookAtAll(): void {
    this.moveTo(this.viewOfBox(this.box), false);
  }

  /** The views of the whole model from all around, the first one as {@link lookAtAll}. */
  viewsAround(): View[] {
    return AROUND.map((from) => this.viewOfBox(this.box, from));
  }

  /** The view of a box from a direction, so that it fills the picture. */
  viewOfBox(box: Box3, from = HOME): View {
    const { fieldOfView, aspect } = this.free();
    return framing(box, from, fieldOfView, aspect);
  }

  /** The view of a sphere from a direction. The bands may cover its edges. */
  viewOfSphere(at: Vector3, radius: number, from: Vector3): View {
    const distance = radius / Math.sin(((FIELD_OF_VIEW / 2) * Math.PI) / 180) / Math.min(1, this.camera.aspect);
    return { eye: at.clone().addScaledVector(from.clone().normalize(), distance), target: at.clone() };
  }

  /** A view in the same direction in which about a third of the box around the model is in sight. */
  recognised(view: View): View {
    const { fieldOfView, aspect } = this.free();
    return withInSight(view, this.box, RECOGNISED, fieldOfView, aspect);
  }

  /** Keeps what the camera looks at out of bands at the top and at the bottom of the canvas, in CSS pixels. */
  keepFree(top: number, bottom: number): void {
    this.bands = { top, bottom };
    this.draw();
  }

  /** The vertical field of view in degrees and the aspect of the picture between the bands. */
  private free(): { fieldOfView: number; aspect: number } {
    const height = this.canvas.clientHeight || 1;
    const share = Math.max(LEAST_FREE, 1 - (this.bands.top + this.bands.bottom) / height);
    const slope = share * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    return { fieldOfView: (Math.atan(slope) * 360) / Math.PI, aspect: this.camera.aspect / share };
  }

  /** Moves the camera. */
  moveTo(to: View, isFlight: boolean): void {
    this.setDepths(to);
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

  private setDepths({ eye, target }: View): void {
    const distance = eye.distanceTo(target);
    this.camera.near = Math.min(this.sphere.radius, distance / 3) / 100;
    this.camera.far = this.sphere.radius * 20 + distance;
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

  /** Draws the picture at once. Its pixels are valid until the running task ends. */
  picture(): HTMLCanvasElement {
    this.setMoving(false);
    this.drawNow();
    return this.canvas;
  }

  /** How much both sides differ visibly from a view, in small pictures. */
  differenceFrom(view: View): SeenDifference {
    const { camera, split, renderer, canvas } = this;
    const [eye, turn, near, far] = [camera.position.clone(), camera.quaternion.clone(), camera.near, camera.far];
    const hasGround = this.ground.object.visible;
    this.ground.object.visible = false;
    this.setDepths(view);
    camera.position.copy(view.eye);
    camera.lookAt(view.target);
    this.prepare();
    const height = Math.min(COMPARED_HEIGHT, canvas.clientHeight);
    const width = Math.min(canvas.clientWidth, Math.round(height * camera.aspect));
    const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true })!;
    const ratio = renderer.getPixelRatio();
    const [left, right] = [1, 0].map((at) => {
      this.split = at;
      this.drawSplit(0, 0, width, height, this.scene, camera);
      context.drawImage(canvas, 0, canvas.height - height * ratio, width * ratio, height * ratio, 0, 0, width, height);
      return context.getImageData(0, 0, width, height);
    });
    this.split = split;
    this.ground.object.visible = hasGround;
    camera.position.copy(eye);
    camera.quaternion.copy(turn);
    [camera.near, camera.far] = [near, far];
    this.drawNow();
    const { r, g, b } = (this.scene.background as Color).getRGB({ r: 0, g: 0, b: 0 }, SRGBColorSpace);
    return seenDifference(left, right, [r, g, b].map((channel) => 255 * channel));
  }

  /** The point of the model at a place of the picture from a view, from 0 to 1 from the left and from the top; null where there is none. */
  pointAt(view: View, [x, y]: [number, number]): Vector3 | null {
    const { camera } = this;
    const [eye, turn] = [camera.position.clone(), camera.quaternion.clone()];
    camera.position.copy(view.eye);
    camera.lookAt(view.target);
    camera.updateMatrixWorld();
    const picked = this.pick(x * this.canvas.clientWidth, y * this.canvas.clientHeight);
    camera.position.copy(eye);
    camera.quaternion.copy(turn);
    camera.updateMatrixWorld();
    return picked?.hit.point ?? null;
  }

  /** Sets the sizes of the canvas and of the camera's picture. */
  private prepare(): void {
    const { renderer, canvas, camera } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    // Setting a size allocates the picture anew.
    if (renderer.getPixelRatio() !== devicePixelRatio) renderer.setPixelRatio(devicePixelRatio);
    const size = renderer.getSize(new Vector2());
    if (size.x !== width || size.y !== height) renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.setViewOffset(width, height, 0, (this.bands.bottom - this.bands.top) / 2, width, height);
  }

  private drawNow(): void {
    cancelAnimationFrame(this.requestedFrame);
    this.requestedFrame = 0;
    const { canvas, camera } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    this.prepare();
    const start = performance.now();
    this.drawSplit(0, 0, width, height, this.scene, camera);
    this.measure(start);
    if (!this.hasLayout || this.isCoarse()) return;
    const size = Math.round(LAYOUT_SIZE * Math.min(width, height));
    this.drawSplit(width - size - LAYOUT_RIGHT, LAYOUT_BOTTOM, size, size, this.layouts, this.layoutCamera.camera);
  }

  /** Measures the first picture after its shaders are compiled: one that is drawn again. Reading a pixel waits for its end. */
  private measure(start: number): void {
    if (this.isCoarse() || !this.sides.length || this.isMeasured) return;
    if (!this.isWarm) {
      this.isWarm = true;
      // The first picture is on screen before it is drawn again.
      setTimeout(() => this.draw(), REST);
      return;
    }
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.isSlow = performance.now() - start > SLOW;
    [this.isMeasured, this.isWarm] = [true, false];
  }

  private isCoarse(): boolean {
    return this.coarse !== null && ((this.isMoving && this.isSlow) || !this.hasSides);
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

/** A direction turned around the vertical axis. */
function turned(direction: Vector3, degrees: number): Vector3 {
  return direction.clone().applyAxisAngle(new Vector3(0, 1, 0), (degrees * Math.PI) / 180);
}
