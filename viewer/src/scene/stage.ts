// Where the model stands: camera, light, environment, and the picture, drawn once for each side of the slider.

import {
  Box3,
  Color,
  DirectionalLight,
  type Object3D,
  PerspectiveCamera,
  PMREMGenerator,
  Scene,
  Sphere,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { RoomEnvironment } from 'three/addons/environments/RoomEnvironment.js';

/** Objects of the left and the right side are in these layers; the light is in both. */
export const LAYERS = [1, 2] as const;

const FIELD = 35;

export class Stage {
  readonly camera = new PerspectiveCamera(FIELD, 1, 0.01, 100);
  readonly controls: OrbitControls;
  readonly light = new DirectionalLight(0xffffff, 2.5);
  readonly scene = new Scene();
  readonly renderer: WebGLRenderer;
  /** The place of the slider, from 0 to 1. */
  split = 0.5;
  /** What is drawn in a rectangle of its own, beside the model. */
  inset: ((renderer: WebGLRenderer, width: number, height: number) => void) | null = null;
  private readonly sphere = new Sphere(new Vector3(), 1);
  private wanted = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: false });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.light.layers.enableAll();
    this.scene.add(this.light, this.light.target);
    const generator = new PMREMGenerator(this.renderer);
    this.scene.environment = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    generator.dispose();
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Sets the colour behind the model. */
  background(color: string): void {
    this.scene.background = new Color(color);
    this.draw();
  }

  /** Moves the light: degrees around the model, and above the horizon. */
  lightFrom(around: number, above: number): void {
    const [a, b] = [around, above].map((degrees) => (degrees * Math.PI) / 180);
    const away = new Vector3(Math.sin(a) * Math.cos(b), Math.sin(b), Math.cos(a) * Math.cos(b));
    this.light.position.copy(this.sphere.center).addScaledVector(away, 10 * this.sphere.radius);
    this.light.target.position.copy(this.sphere.center);
    this.draw();
  }

  /** Looks at all of an object, from the front and a little from above. */
  frame(object: Object3D): void {
    new Box3().setFromObject(object).getBoundingSphere(this.sphere);
    if (!(this.sphere.radius > 0) || !Number.isFinite(this.sphere.radius)) this.sphere.set(new Vector3(), 1);
    this.look(this.sphere.center, this.sphere.radius, new Vector3(0.35, 0.3, 1));
  }

  /** Looks at a place so that a radius around it is in view. */
  look(at: Vector3, radius: number, from: Vector3): void {
    const distance = radius / Math.sin(((FIELD / 2) * Math.PI) / 180) / Math.min(1, this.camera.aspect);
    this.camera.position.copy(at).addScaledVector(from.clone().normalize(), distance);
    this.camera.near = this.sphere.radius / 1000;
    this.camera.far = this.sphere.radius * 100;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(at);
    this.controls.update();
    this.draw();
  }

  /** Draws soon: once, however often it is called before. */
  draw(): void {
    this.wanted ||= requestAnimationFrame(() => this.drawNow());
  }

  /** Draws now. */
  drawNow(): void {
    cancelAnimationFrame(this.wanted);
    this.wanted = 0;
    const { renderer, canvas, camera } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!width || !height) return;
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    renderer.setScissorTest(true);
    const middle = Math.round(width * this.split);
    renderer.setViewport(0, 0, width, height);
    this.drawSide(LAYERS[0], 0, middle, height);
    this.drawSide(LAYERS[1], middle, width - middle, height);
    renderer.setScissorTest(false);
  }

  private drawSide(layer: number, left: number, width: number, height: number): void {
    if (width <= 0) return;
    this.camera.layers.set(layer);
    this.renderer.setScissor(left, 0, width, height);
    this.renderer.render(this.scene, this.camera);
  }
}
