import * as THREE from 'three';
import {MapControls} from 'three/examples/jsm/controls/MapControls.js';

const kFov = 50; // degrees
const kFar = 20_000; // m
const kNearest = 60; // m, of the picture's height when it goes to a place
const kBorder = 20; // m
const kCovered_px = [30, 100]; // at each side, above and below: tools, legend, slider
const kFitSteps = 8;
const kLoose = 1.03; // nothing touches the border
const kMostCovered = 0.2; // of the picture, at each side
const kStep = 0.15; // of the picture's height

type Camera = THREE.PerspectiveCamera | THREE.OrthographicCamera;

/** The eye of the map, in 3D or above the plan: it looks at a target, and turns and moves as the pointer drags. */
export class MapCamera {
  planar = false;
  fitted = false; // it has looked at the fleet
  follows = true; // nobody has moved it since it looked at the fleet
  private perspective = new THREE.PerspectiveCamera(kFov, 1, 0.5, kFar);
  private plan = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.5, kFar);
  private controls: {perspective: MapControls; plan: MapControls};

  /** `moved` is called after each change of the view. */
  constructor(
    private canvas: HTMLCanvasElement,
    private moved: () => void,
  ) {
    for (const camera of [this.perspective, this.plan]) camera.up.set(0, 0, 1);
    this.plan.up.set(0, 1, 0);
    this.controls = {perspective: this.control(this.perspective), plan: this.control(this.plan)};
    this.controls.plan.enableRotate = false;
    this.controls.plan.screenSpacePanning = true;
    this.controls.plan.enabled = false;
    this.controls.perspective.maxPolarAngle = 0.49 * Math.PI;
  }

  private control(camera: THREE.Camera): MapControls {
    const controls = new MapControls(camera, this.canvas);
    controls.zoomToCursor = true;
    controls.enableDamping = false;
    controls.addEventListener('change', () => this.moved());
    controls.addEventListener('start', () => (this.follows = false));
    return controls;
  }

  get camera(): Camera {
    return this.planar ? this.plan : this.perspective;
  }
  private get control_(): MapControls {
    return this.planar ? this.controls.plan : this.controls.perspective;
  }
  get target(): THREE.Vector3 {
    return this.control_.target;
  }

  /** `aspect`: width of the picture by its height. */
  resize(aspect: number): void {
    this.perspective.aspect = aspect;
    this.perspective.updateProjectionMatrix();
    Object.assign(this.plan, {left: -aspect, right: aspect, top: 1, bottom: -1});
    this.plan.updateProjectionMatrix();
  }

  /** Size of a pixel at the target, m. */
  metresPerPixel(): number {
    if (this.planar) return this.pixelAtOne();
    return this.perspective.position.distanceTo(this.controls.perspective.target) * this.pixelAtOne();
  }

  /** Size of a pixel at 1 m from the eye, above the plan at any distance, m. */
  pixelAtOne(): number {
    const height = Math.max(1, this.canvas.clientHeight);
    if (this.planar) return (this.plan.top - this.plan.bottom) / this.plan.zoom / height;
    return (2 * Math.tan((kFov * Math.PI) / 360)) / height;
  }

  private span(): number {
    return this.metresPerPixel() * this.canvas.clientHeight;
  }

  /** The target and the scale stay. */
  setPlanar(planar: boolean): void {
    if (planar === this.planar) return;
    const target = this.target.clone();
    const span = this.span();
    this.control_.enabled = false;
    this.planar = planar;
    this.control_.enabled = true;
    this.aim(target, span);
  }

  /** Looks at `target` so that the picture is `span` metres high there. */
  private aim(target: THREE.Vector3, span: number): void {
    if (this.planar) {
      this.plan.position.copy(target).add(new THREE.Vector3(0, 0, kFar / 2));
      this.plan.zoom = 2 / span;
      this.plan.updateProjectionMatrix();
      this.controls.plan.target.copy(target);
    } else {
      const distance = span / (2 * Math.tan((kFov * Math.PI) / 360));
      const away = this.perspective.position.clone().sub(this.controls.perspective.target);
      const direction = away.length() > 1 ? away.normalize() : new THREE.Vector3(-0.45, -0.75, 0.62).normalize();
      this.perspective.position.copy(target).addScaledVector(direction, distance);
      this.controls.perspective.target.copy(target);
    }
    this.control_.update();
    this.moved();
  }

  /** Shows all of these places, with `room` times what they take, and follows until somebody moves the view. */
  fit(places: THREE.Vector3[], room = 1): void {
    const box = new THREE.Box3().setFromPoints(places);
    if (box.isEmpty()) return;
    this.fitted = this.follows = true;
    const size = box.getSize(new THREE.Vector3()),
      aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
    const [free_x, free_y] = this.free();
    const span = Math.max(size.y / free_y, size.x / aspect / free_x) + kBorder;
    const middle = box.getCenter(new THREE.Vector3());
    this.aim(middle, span);
    if (!this.planar) for (let k = 0; k < kFitSteps; ++k) this.frame(places, aspect);
    if (room > 1) this.aim(this.target.clone(), room * this.span());
  }

  /** Moves and zooms the view in 3D, where near places look larger than on the plan, so that they fill the picture. */
  private frame(places: THREE.Vector3[], aspect: number): void {
    const span = this.span();
    const [low, high] = this.bounds(places);
    if (!Number.isFinite(high[0])) return this.aim(this.target.clone(), 2 * span); // one is behind the eye
    const half = Math.max(high[0] - low[0], high[1] - low[1]) / 2;
    const [free_x, free_y] = this.free();
    const right = (((low[0] + high[0]) / 2) * free_x * span * aspect) / 2,
      up = (((low[1] + high[1]) / 2) * free_y * span) / 2;
    const [x_axis, ahead] = [new THREE.Vector3(), this.perspective.getWorldDirection(new THREE.Vector3())];
    x_axis.setFromMatrixColumn(this.perspective.matrixWorld, 0);
    const tilt = Math.max(0.3, Math.abs(ahead.z)); // the ground is seen from so far above
    const target = this.target.clone().addScaledVector(x_axis, right);
    this.aim(target.addScaledVector(ahead.setZ(0).normalize(), up / tilt), Math.max(kBorder, span * half * kLoose));
  }

  /** Whether all of these places are in the picture, and nothing lies over them. */
  holds(places: THREE.Vector3[]): boolean {
    const [low, high] = this.bounds(places);
    return Math.min(...low) >= -1 && Math.max(...high) <= 1;
  }

  /**
   * Lowest and highest x and y of places in the picture, as shares of the way from the middle to where something lies
   * over the map; infinite where one is behind the eye.
   */
  private bounds(places: THREE.Vector3[]): [[number, number], [number, number]] {
    this.camera.updateMatrixWorld();
    const [free_x, free_y] = this.free();
    const low: [number, number] = [Infinity, Infinity],
      high: [number, number] = [-Infinity, -Infinity];
    for (const place of places) {
      const p = place.clone().project(this.camera);
      const seen = p.z > 1 ? [Infinity, Infinity] : [p.x / free_x, p.y / free_y];
      for (const k of [0, 1]) {
        low[k] = Math.min(low[k], seen[k]);
        high[k] = Math.max(high[k], seen[k]);
      }
    }
    return [low, high];
  }

  /** Share of the picture's width and height over which nothing lies. */
  private free(): [number, number] {
    const {clientWidth, clientHeight} = this.canvas;
    const [x, y] = [clientWidth, clientHeight].map(
      (length, k) => 1 - 2 * Math.min(kMostCovered, kCovered_px[k] / Math.max(1, length)),
    );
    return [x, y];
  }

  /** Brings a place into the middle, and near enough to see it. */
  goTo(p: THREE.Vector3): void {
    this.follows = false;
    this.aim(p, Math.min(this.span(), kNearest));
  }

  pan(right: number, up: number): void {
    this.follows = false;
    const step = kStep * this.span();
    const forward = new THREE.Vector3(0, 1, 0);
    if (!this.planar) this.perspective.getWorldDirection(forward).setZ(0).normalize();
    const move = forward
      .clone()
      .multiplyScalar(up * step)
      .add(new THREE.Vector3(forward.y, -forward.x, 0).multiplyScalar(right * step));
    this.camera.position.add(move);
    this.target.add(move);
    this.control_.update();
    this.moved();
  }

  /** Turns the view around its target, and tilts it, rad; above the plan north stays up. */
  turn(left: number, up: number): void {
    if (this.planar) return;
    this.follows = false;
    const {target, maxPolarAngle} = this.controls.perspective;
    const away = this.perspective.position.clone().sub(target);
    const angles = new THREE.Spherical().setFromVector3(new THREE.Vector3(away.x, away.z, -away.y)); // y is up there
    angles.theta += left;
    angles.phi = Math.min(maxPolarAngle, Math.max(0.02, angles.phi - up));
    const turned = new THREE.Vector3().setFromSpherical(angles);
    this.perspective.position.copy(target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.control_.update();
    this.moved();
  }

  zoom(factor: number): void {
    this.follows = false;
    this.aim(this.target.clone(), this.span() / factor);
  }
}
