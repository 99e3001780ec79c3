import * as THREE from 'three';
import {MapControls} from 'three/examples/jsm/controls/MapControls.js';
import {CpuPoints} from './cpu_points';
import {type Edge, edgesOf} from './edges';
import {GlPoints} from './gl_points';
import {colourOf, type FleetNode, type State} from './model';
import {pointStyle} from './point_material';
import {drawsOnCpu, type Effort, kStill_ms, Pace} from './pace';
import {pointAt} from './picking';
import {Shading} from './shading';
import {matrixOf} from './submap';
import {Submaps} from './submaps';
import {Lines} from './lines';

export type ColourMode = 'robot' | 'height' | 'intensity' | 'age' | 'sigma';
export type Layer = 'points' | 'paths' | 'nodes' | 'used' | 'unused' | 'rejected';

export type Hit = {node: string} | {edge: Edge};

/** State of the map after each picture. */
export interface Picture {
  drawn: number;
  total: number;
  loading: boolean;
  moving: boolean;  // the view; what people read may wait until it stands still
  metresPerPixel: number;
  planar: boolean;
  heights: [number, number];
  range: [number, number];  // of the submaps' ages, s, or sigmas, m
}

const kModes: Record<ColourMode, number> = {robot: 0, height: 1, intensity: 2, age: 3, sigma: 3};  // of PointStyle
const kFov = 50;
const kFar = 20_000;

/** The map: submaps at their poses, trajectories, nodes and registrations. Draws when something changed, and only then. */
export class FleetMap {
  readonly layers: Record<Layer, boolean> = {points: true, paths: true, nodes: true, used: true, unused: true, rejected: true};
  onPicture: (picture: Picture) => void = () => {};
  edges: Edge[] = [];
  until = Infinity;
  planar = false;
  private state?: State;
  private nodes = new Map<string, {node: FleetNode; p: THREE.Vector3}>();
  private renderer: THREE.WebGLRenderer;
  private shading = new Shading();
  private points: CpuPoints | GlPoints;
  private marks = new THREE.Scene();
  private perspective = new THREE.PerspectiveCamera(kFov, 1, 0.5, kFar);
  private plan = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.5, kFar);
  private controls: {perspective: MapControls; plan: MapControls};
  private style = pointStyle();
  private mode: ColourMode = 'robot';
  readonly submaps: Submaps;
  private lines: Lines;
  private scheduled = false;
  private selected?: Hit;
  private fitted = false;
  private pace: Pace;
  private ratio = 0;  // device pixels per pixel, now
  private moved = -Infinity;  // when the view did, ms
  private still?: ReturnType<typeof setTimeout>;
  private ramp?: {key: string; range: [number, number]};

  constructor(private canvas: HTMLCanvasElement) {
    const onCpu = drawsOnCpu();
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: !onCpu, alpha: true, preserveDrawingBuffer: true});
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.submaps = new Submaps(this.style, () => this.draw());
    this.points = onCpu ? new CpuPoints(this.submaps.pool, this.style) : new GlPoints(this.submaps.pool, this.renderer);
    this.pace = new Pace({shaded: true, detailed: true, ratio: Math.min(2, window.devicePixelRatio), share: 1});
    this.lines = new Lines(this.marks);
    for (const camera of [this.perspective, this.plan]) camera.up.set(0, 0, 1);
    this.plan.up.set(0, 1, 0);
    this.controls = {perspective: this.control(this.perspective), plan: this.control(this.plan)};
    this.controls.plan.enableRotate = false;
    this.controls.plan.screenSpacePanning = true;
    this.controls.plan.enabled = false;
    this.controls.perspective.maxPolarAngle = 0.49 * Math.PI;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  private control(camera: THREE.Camera): MapControls {
    const controls = new MapControls(camera, this.canvas);
    controls.zoomToCursor = true;
    controls.enableDamping = false;
    controls.addEventListener('change', () => {
      this.moved = performance.now();
      this.draw();
      clearTimeout(this.still);
      this.still = setTimeout(() => this.draw(), kStill_ms + 20);  // with all effort, when it stands still
    });
    return controls;
  }

  get camera(): THREE.PerspectiveCamera | THREE.OrthographicCamera {
    return this.planar ? this.plan : this.perspective;
  }
  private get control_(): MapControls {
    return this.planar ? this.controls.plan : this.controls.perspective;
  }

  show(state: State): void {
    this.state = state;
    this.nodes.clear();
    const wanted = new Set<string>();
    for (const node of state.nodes) {
      if (!node.T) continue;
      const T = matrixOf(node.T);
      this.nodes.set(node.id, {node, p: new THREE.Vector3().setFromMatrixPosition(T)});
      if (!node.submap) continue;
      wanted.add(node.submap);
      const submap = this.submaps.all.get(node.submap) ?? this.submaps.add(node.submap, node.robot, node.t, colourOf(state, node.robot));
      submap.place(T);
      submap.sigma_m = node.sigma_m;
    }
    this.submaps.keepOnly(wanted);
    this.ramp = undefined;
    this.edges = edgesOf(state);
    this.remark();
    if (!this.fitted && this.nodes.size > 0) this.fit();
    this.draw();
  }

  /** Lines and nodes anew: after a state, the time, a layer or the selection changed. */
  remark(): void {
    if (!this.state) return;
    const place = (id: string) => this.nodes.get(id)?.p;
    this.lines.show({
      state: this.state, nodes: [...this.nodes.values()].filter(({node}) => node.t <= this.until), place,
      edges: this.edges.filter((edge) => this.layers[edge.kind] && this.isThere(edge.a) && this.isThere(edge.b)),
      paths: this.layers.paths, dots: this.layers.nodes, selected: this.selected,
    });
    this.draw();
  }

  private isThere(id: string): boolean {
    const known = this.nodes.get(id);
    return known !== undefined && known.node.t <= this.until;
  }

  set budget(points: number) {
    this.submaps.budget = points;
    this.submaps.refresh();
    this.draw();
  }

  setColour(mode: ColourMode): void {
    this.mode = mode;
    this.style.mode.value = kModes[mode];
    this.draw();
  }

  /** Hides all submaps but these; undefined shows all. Two that are compared are told apart by their colours. */
  showOnly(hashes: ReadonlySet<string> | undefined): void {
    this.submaps.only = hashes;
    this.submaps.refresh();
    this.style.mode.value = hashes ? 0 : kModes[this.mode];
    this.draw();
  }

  select(hit: Hit | undefined): void {
    this.selected = hit;
    this.remark();
  }

  place(id: string): THREE.Vector3 | undefined {
    return this.nodes.get(id)?.p;
  }

  setPlanar(planar: boolean): void {
    if (planar === this.planar) return;
    const target = this.control_.target.clone();
    const span = this.metresPerPixel() * this.canvas.clientHeight;
    this.control_.enabled = false;
    this.planar = planar;
    this.control_.enabled = true;
    this.aim_(target, span);
  }

  /** Looks at `target` so that the picture is `span` metres high there. */
  private aim_(target: THREE.Vector3, span: number): void {
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
    this.draw();
  }

  fit(): void {
    const box = new THREE.Box3();
    for (const {p} of this.nodes.values()) box.expandByPoint(p);
    if (box.isEmpty()) return;
    this.fitted = true;
    const size = box.getSize(new THREE.Vector3()), aspect = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
    const span = Math.max(size.y, size.x / aspect) + 20;
    this.aim_(box.getCenter(new THREE.Vector3()), this.planar ? span : 1.12 * span);
  }

  /** Brings a place into the middle, and near enough to see it. */
  goTo(p: THREE.Vector3): void {
    this.aim_(p, Math.min(this.metresPerPixel() * this.canvas.clientHeight, 60));
  }

  pan(right: number, up: number): void {
    const step = 0.15 * this.metresPerPixel() * this.canvas.clientHeight;
    const forward = new THREE.Vector3(0, 1, 0);
    if (!this.planar) this.perspective.getWorldDirection(forward).setZ(0).normalize();
    const move = forward.clone().multiplyScalar(up * step).add(new THREE.Vector3(forward.y, -forward.x, 0).multiplyScalar(right * step));
    this.camera.position.add(move);
    this.control_.target.add(move);
    this.control_.update();
    this.draw();
  }

  zoom(factor: number): void {
    this.aim_(this.control_.target.clone(), (this.metresPerPixel() * this.canvas.clientHeight) / factor);
  }

  /** Size of a pixel at the target of the view. */
  metresPerPixel(): number {
    const height = Math.max(1, this.canvas.clientHeight);
    if (this.planar) return (this.plan.top - this.plan.bottom) / this.plan.zoom / height;
    const distance = this.perspective.position.distanceTo(this.controls.perspective.target);
    return (2 * distance * Math.tan((kFov * Math.PI) / 360)) / height;
  }

  /** In pixels of the canvas; nothing behind the camera. */
  project(p: THREE.Vector3): {x: number; y: number; depth: number} | undefined {
    const q = p.clone().project(this.camera);
    if (q.z < -1 || q.z > 1) return undefined;
    return {x: ((q.x + 1) / 2) * this.canvas.clientWidth, y: ((1 - q.y) / 2) * this.canvas.clientHeight, depth: q.z};
  }

  /** The node, else the edge, at a pixel. */
  hitAt(x: number, y: number, reach: number): Hit | undefined {
    let best: Hit | undefined, least = reach;
    if (this.layers.nodes) {
      for (const {node, p} of this.nodes.values()) {
        if (node.t > this.until) continue;
        const q = this.project(p);
        const d = q ? Math.hypot(q.x - x, q.y - y) : Infinity;
        if (d < least) [least, best] = [d, {node: node.id}];
      }
    }
    if (best) return best;
    for (const edge of this.edges) {
      if (!this.layers[edge.kind] || !this.isThere(edge.a) || !this.isThere(edge.b)) continue;
      const a = this.project(this.nodes.get(edge.a)!.p), b = this.project(this.nodes.get(edge.b)!.p);
      if (!a || !b) continue;
      const length2 = (b.x - a.x) ** 2 + (b.y - a.y) ** 2;
      const s = length2 > 0 ? Math.min(1, Math.max(0, ((x - a.x) * (b.x - a.x) + (y - a.y) * (b.y - a.y)) / length2)) : 0;
      const d = Math.hypot(a.x + s * (b.x - a.x) - x, a.y + s * (b.y - a.y) - y);
      if (d < least) [least, best] = [d, {edge}];
    }
    return best;
  }

  pointAt(x: number, y: number, reach: number): THREE.Vector3 | undefined {
    return pointAt(this.submaps.all.values(), this.camera, this.canvas, x, y, reach);
  }

  private resize(): void {
    const box = this.canvas.parentElement!.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width)), height = Math.max(1, Math.round(box.height));
    const span = this.fitted ? this.metresPerPixel() * this.canvas.clientHeight : 0;
    this.renderer.setSize(width, height);
    this.ratio = 0;
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    Object.assign(this.plan, {left: -width / height, right: width / height, top: 1, bottom: -1});
    this.plan.updateProjectionMatrix();
    this.lines.resize(width, height);
    if (span > 0) this.draw();
  }

  private setRatio(ratio: number): void {
    if (ratio === this.ratio) return;
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
  }

  draw(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.render();
    });
  }

  private render(): void {
    const now = performance.now(), moving = now - this.moved < kStill_ms;
    const effort = this.pace.effort(now, moving);
    this.setRatio(effort.ratio);
    const camera = this.camera, height = Math.max(1, this.canvas.clientHeight);
    camera.updateMatrixWorld();
    const pixelAtOne = this.planar ? this.metresPerPixel() : (2 * Math.tan((kFov * Math.PI) / 360)) / height;
    this.style.pixelsPerMetre.value = 1 / pixelAtOne;
    this.style.planar.value = this.planar ? 1 : 0;
    this.style.ratio.value = effort.ratio;
    const heights = this.submaps.heights();
    if (heights) [this.style.low.value, this.style.high.value] = heights;
    const range = this.putOnRamp();
    this.submaps.prepare(camera, this.planar, this.until, moving, effort.share);
    this.drawScene(camera, effort, pixelAtOne / effort.ratio);
    let total = 0;
    for (const submap of this.submaps.all.values()) total += Math.max(0, submap.total);
    this.onPicture({
      drawn: this.layers.points ? this.submaps.drawn : 0, total, loading: this.submaps.loading, moving, metresPerPixel: this.metresPerPixel(), planar: this.planar,
      heights: [this.style.low.value, this.style.high.value], range,
    });
  }

  /** Anew when what they show has changed. */
  private putOnRamp(): [number, number] {
    const key = `${this.mode} ${this.until}`;
    if (this.ramp?.key !== key) this.ramp = {key, range: this.submaps.putOnRamp((one) => (this.mode === 'age' ? one.t : one.sigma_m), this.until)};
    return this.ramp.range;
  }

  private drawScene(camera: THREE.PerspectiveCamera | THREE.OrthographicCamera, effort: Effort, pixelAtOne: number): void {
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    const view = {camera, width: size.x, height: size.y};
    if (this.points instanceof GlPoints && this.submaps.listed) this.submaps.pool.end();
    this.submaps.listed = false;
    const picture = this.layers.points ? this.points.render(view, effort.shaded) : undefined;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    if (picture) this.shading.draw(this.renderer, picture, view, pixelAtOne, effort.shaded);
    this.lines.detailed = effort.detailed;
    this.renderer.render(this.marks, camera);
  }
}
