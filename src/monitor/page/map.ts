import * as THREE from 'three';
import {CpuPoints} from './cpu_points';
import {type Edge, edgesOf} from './edges';
import {GlPoints} from './gl_points';
import {type Hit, hitAt} from './hit';
import {colourOf, type FleetNode, isNumber, sigmasOf, type State} from './model';
import {MapCamera} from './map_camera';
import {kModes, type ColourMode, pointStyle} from './point_material';
import {tonesOf} from './ramp';
import type {Picture} from './legend';
import {drawsOnCpu, type Effort, kStill_ms, drawnShare, Pace} from './pace';
import {type Picked, type Place, placeOf, pointAt} from './picking';
import {Shading} from './shading';
import {matrixOf} from './submap';
import {Submaps} from './submaps';
import {Lines, stepsOf} from './lines';

export type Layer = 'points' | 'paths' | 'nodes' | 'used' | 'unused' | 'rejected';

const kGrowth = 1.3; // of the view, for a fleet that has left it
const kSigmas_m: [number, number] = [0, 0.5]; // at least on the ramp, so that a centimetre is not its whole span

/** WebGL on the canvas. */
function webGl(canvas: HTMLCanvasElement, antialias: boolean): THREE.WebGLRenderer {
  return new THREE.WebGLRenderer({canvas, antialias, alpha: true, preserveDrawingBuffer: true});
}

/**
 * The map: submaps at their poses, trajectories, nodes and registrations. Draws when something changed, and only then.
 */
export class FleetMap {
  readonly layers: Record<Layer, boolean> = {
    points: true,
    paths: true,
    nodes: true,
    used: true,
    unused: true,
    rejected: true,
  };
  onPicture: (picture: Picture) => void = () => {};
  edges: Edge[] = [];
  until = Infinity;
  readonly eye: MapCamera;
  private state?: State;
  private nodes = new Map<string, {node: FleetNode; p: THREE.Vector3}>();
  private renderer: THREE.WebGLRenderer;
  private shading = new Shading();
  private points: CpuPoints | GlPoints;
  private marks = new THREE.Scene();
  private style = pointStyle();
  private mode: ColourMode = 'robot';
  readonly submaps: Submaps;
  private lines: Lines;
  private scheduled = false;
  private selected?: Hit;
  private pace: Pace;
  private ratio = 0; // device pixels per pixel, now
  private moved = -Infinity; // when the view did, ms
  private still?: ReturnType<typeof setTimeout>;
  private resting?: ReturnType<typeof setTimeout>; // until a picture of what has arrived
  private ramp?: {key: string; range: [number, number]};

  constructor(
    private canvas: HTMLCanvasElement,
    makeRenderer = webGl,
  ) {
    const onCpu = drawsOnCpu();
    this.renderer = makeRenderer(canvas, !onCpu);
    this.renderer.autoClear = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.submaps = new Submaps(this.style, () => this.drawArrived());
    this.points = onCpu ? new CpuPoints(this.submaps.pool, this.style) : new GlPoints(this.submaps.pool, this.renderer);
    const full = {shaded: true, detailed: true, ratio: Math.min(2, window.devicePixelRatio), share: 1};
    this.pace = new Pace(full, drawnShare(), onCpu);
    this.lines = new Lines(this.marks);
    this.eye = new MapCamera(canvas, () => this.move());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  /** The view has moved. When it stands still it is drawn with all effort. */
  private move(): void {
    this.moved = performance.now();
    this.draw();
    clearTimeout(this.still);
    this.still = setTimeout(() => this.draw(), kStill_ms + 20);
  }

  show(state: State): void {
    this.state = state;
    this.nodes.clear();
    const wanted = new Set<string>();
    const sigmas = sigmasOf(state.nodes);
    for (const node of state.nodes) {
      if (!node.T?.every(isNumber)) continue;
      const T = matrixOf(node.T);
      this.nodes.set(node.id, {node, p: new THREE.Vector3().setFromMatrixPosition(T)});
      if (!node.submap) continue;
      wanted.add(node.submap);
      const submap = this.submaps.all.get(node.submap) ?? this.submaps.add(node.submap, node.robot, node.t);
      submap.colour = colourOf(state, node.robot);
      submap.place(T);
      submap.sigma_m = sigmas.get(node.id);
      submap.floating = node.floating;
    }
    this.submaps.keepOnly(wanted);
    this.ramp = undefined;
    this.edges = edgesOf(state);
    this.setLines();
    if (!this.eye.fitted && this.nodes.size > 0) this.fit();
    else if (this.eye.follows && !this.eye.holds(this.places())) this.eye.fit(this.places(), kGrowth);
    this.drawArrived();
  }

  /** Lines and nodes anew: after the time, a layer or the selection changed. */
  remark(): void {
    this.setLines();
    this.draw();
  }

  private setLines(): void {
    if (!this.state) return;
    const place = (id: string) => this.nodes.get(id)?.p;
    this.lines.show({
      state: this.state,
      nodes: [...this.nodes.values()].filter(({node}) => node.t <= this.until),
      place,
      edges: this.edges.filter((edge) => this.layers[edge.kind] && this.isThere(edge.a) && this.isThere(edge.b)),
      paths: this.layers.paths,
      dots: this.layers.nodes,
      selected: this.selected,
    });
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

  /** Points are darker on a light map and lighter on a dark one. */
  setDark(dark: boolean): void {
    [this.style.lowTone.value, this.style.highTone.value] = tonesOf(dark);
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

  /** Shows all nodes. */
  fit(): void {
    this.eye.fit(this.places());
  }

  private places(): THREE.Vector3[] {
    return [...this.nodes.values()].map(({p}) => p);
  }


  project(p: THREE.Vector3): Place | undefined {
    return placeOf(p, this.eye.camera, this.canvas);
  }

  /** The node, else the edge, else the step of a trajectory at a pixel. */
  hitAt(x: number, y: number, reach: number): Hit | undefined {
    const there = [...this.nodes.values()].filter(({node}) => this.isThere(node.id));
    const pixels = new Map(there.map(({node, p}) => [node.id, this.project(p)]));
    const shown = this.edges.filter((edge) => this.layers[edge.kind]);
    const steps = this.layers.paths ? stepsOf(there).map(([a, b]): [string, string] => [a.node.id, b.node.id]) : [];
    return hitAt({x, y}, pixels, this.layers.nodes, shown, reach, steps);
  }

  /** As hitAt(), else the point and the node that it was seen from; looks at all points, which takes its time. */
  pick(x: number, y: number, reach: number): Hit | undefined {
    const hit = this.hitAt(x, y, reach);
    const at = hit || !this.layers.points ? undefined : this.pointAt(x, y, reach);
    const of = at && [...this.nodes.values()].find(({node}) => node.submap === at.submap.hash);
    return of && at ? {node: of.node.id, point: at.p} : hit;
  }

  pointAt(x: number, y: number, reach: number): Picked | undefined {
    return pointAt(this.submaps.all.values(), this.eye.camera, this.canvas, x, y, reach);
  }

  private resize(): void {
    const box = this.canvas.parentElement!.getBoundingClientRect();
    const width = Math.max(1, Math.round(box.width)),
      height = Math.max(1, Math.round(box.height));
    this.renderer.setSize(width, height);
    this.ratio = 0;
    this.eye.resize(width / height);
    this.lines.resize(width, height);
    if (this.eye.fitted) this.draw();
  }

  private setRatio(ratio: number): void {
    if (ratio === this.ratio) return;
    this.ratio = ratio;
    this.renderer.setPixelRatio(ratio);
  }

  draw(): void {
    clearTimeout(this.resting);
    this.resting = undefined;
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      this.scheduled = false;
      this.render();
    });
  }

  /** States and points arrive all the time: their pictures leave time to the rest of the page. */
  private drawArrived(): void {
    if (this.scheduled || this.resting) return;
    const now = performance.now(),
      rest = now - this.moved < kStill_ms ? 0 : this.pace.rest(now);
    if (rest > 0) this.resting = setTimeout(() => this.draw(), rest);
    else this.draw();
  }

  private render(): void {
    const now = performance.now(),
      moving = now - this.moved < kStill_ms;
    const effort = this.pace.effort(now, moving);
    this.setRatio(effort.ratio);
    const {camera, planar} = this.eye;
    camera.updateMatrixWorld();
    const pixelAtOne = this.eye.pixelAtOne();
    this.style.pixelsPerMetre.value = 1 / pixelAtOne;
    this.style.planar.value = planar ? 1 : 0;
    this.style.ratio.value = effort.ratio;
    const heights = this.submaps.heights();
    if (heights) [this.style.low.value, this.style.high.value] = heights;
    const range = this.putOnRamp();
    this.submaps.prepare(camera, planar, this.until, moving, effort.share);
    this.drawScene(camera, effort, pixelAtOne / effort.ratio);
    if (!moving) this.pace.drewStill(now, performance.now());
    let total = 0;
    for (const submap of this.submaps.all.values()) total += Math.max(0, submap.total);
    this.onPicture({
      drawn: this.layers.points ? this.submaps.drawn : 0,
      total,
      loading: this.submaps.loading,
      moving,
      coarse: !effort.detailed,
      metresPerPixel: this.eye.metresPerPixel(),
      planar,
      heights: [this.style.low.value, this.style.high.value],
      range,
    });
  }

  /** Anew when what they show has changed. */
  private putOnRamp(): [number, number] {
    const key = `${this.mode} ${this.until}`;
    if (this.ramp?.key !== key)
      this.ramp = {
        key,
        range:
          this.mode === 'age'
            ? this.submaps.putOnRamp((one) => one.t, this.until)
            : this.submaps.putOnRamp((one) => one.sigma_m, this.until, kSigmas_m),
      };
    return this.ramp.range;
  }

  private drawScene(
    camera: THREE.PerspectiveCamera | THREE.OrthographicCamera,
    effort: Effort,
    pixelAtOne: number,
  ): void {
    const size = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    const view = {camera, width: size.x, height: size.y};
    if (this.points instanceof GlPoints && this.submaps.listed) this.submaps.pool.end();
    this.submaps.listed = false;
    const picture = this.layers.points ? this.points.render(view, effort.shaded) : undefined;
    const byHand = picture && !effort.detailed && this.points instanceof CpuPoints ? this.points : undefined;
    byHand?.stroke(this.lines.strokes);
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.clear();
    if (picture) this.shading.draw(this.renderer, picture, view, pixelAtOne, effort.shaded);
    if (byHand) return;
    this.lines.detailed = effort.detailed;
    this.renderer.render(this.marks, camera);
  }
}
