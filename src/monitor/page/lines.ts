import * as THREE from 'three';
import type {Stroke} from './cpu_lines';
import {kEdgeColours} from './colours';
import type {Edge} from './edges';
import type {Hit} from './hit';
import {colourOf, type FleetNode, type State} from './model';
import {WideLines} from './wide_lines';

export interface Marks {
  state: State;
  nodes: {node: FleetNode; p: THREE.Vector3}[];
  place: (id: string) => THREE.Vector3 | undefined;
  edges: Edge[];
  paths: boolean;
  dots: boolean;
  selected?: Hit;
}

const kSelected = '#ffffff';
const kDark = '#10161d';

/** Dashes of an edge, and the share of it that they cover: no trajectory is dashed, whatever its colour. */
const kDashes = {used: [5, 0.8], unused: [5, 0.5], rejected: [9, 0.35]} as const;

const rgb = (colour: string) => new THREE.Color().setStyle(colour, THREE.LinearSRGBColorSpace);

/** The bytes of an opaque pixel as they lie in memory. */
const pixelOf = ({r, g, b}: THREE.Color) =>
  new Uint32Array(new Uint8ClampedArray([255 * r, 255 * g, 255 * b, 255]).buffer)[0];

const kDotVertex = /* glsl */ `
attribute vec3 tint;
attribute float size;
uniform float ratio;
varying vec3 vColour;
varying float vSize;

void main() {
  vColour = tint;
  vSize = size;
  gl_PointSize = size * ratio;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const kDotFragment = /* glsl */ `
varying vec3 vColour;
varying float vSize;

void main() {
  float r = vSize * length(gl_PointCoord - 0.5);
  float edge = 0.5 * vSize;
  vec3 colour = mix(vColour, vec3(1.0), smoothstep(edge - 2.4, edge - 1.4, r));
  gl_FragColor = vec4(colour, 1.0 - smoothstep(edge - 0.8, edge, r));
}`;

/** The nodes of each robot and session from one to the next in time. */
export function stepsOf<T extends {node: FleetNode}>(nodes: readonly T[]): [T, T][] {
  const key = ({node}: T) => `${node.robot} ${node.session}`;
  const sorted = [...nodes].sort((a, b) => a.node.t - b.node.t);
  const last = new Map<string, T>();
  const steps: [T, T][] = [];
  for (const one of sorted) {
    const before = last.get(key(one));
    if (before) steps.push([before, one]);
    last.set(key(one), one);
  }
  return steps;
}

/** Pieces of segments from end to end, `share` of each. */
export function dashed(ends: readonly number[], [dashes, share]: readonly [number, number]): number[] {
  const pieces: number[] = [];
  const period = 1 / (dashes - 1 + share); // a dash is at both ends
  for (let k = 0; k < ends.length; k += 6) {
    const at = (s: number) => [0, 1, 2].map((i) => ends[k + i] + s * (ends[k + 3 + i] - ends[k + i]));
    for (let n = 0; n < dashes; ++n) pieces.push(...at(n * period), ...at((n + share) * period));
  }
  return pieces;
}

/** Trajectories, edges and nodes, in front of all points. */
export class Lines {
  readonly strokes: Stroke[] = []; // the same without edges and nodes, for drawStrokes()
  private lines: WideLines[] = [];
  private edges: WideLines[] = []; // wider ones below others
  private dots?: THREE.Points;
  private size = new THREE.Vector2(1, 1);

  constructor(private scene: THREE.Scene) {}

  resize(width: number, height: number): void {
    this.size.set(width, height);
  }

  /** Without details there are no nodes, and lines have no edges. */
  set detailed(on: boolean) {
    for (const edge of this.edges) edge.object.visible = on;
    if (this.dots) this.dots.visible = on;
  }

  show(marks: Marks): void {
    this.clear();
    if (marks.paths) for (const robot of marks.state.robots) this.path(marks, robot.id);
    for (const kind of ['rejected', 'unused', 'used'] as const) {
      const positions = marks.edges
        .filter((edge) => edge.kind === kind)
        .flatMap((edge) => [...marks.place(edge.a)!.toArray(), ...marks.place(edge.b)!.toArray()]);
      this.edge(positions, kDark, 4.5, 0.55);
      this.segments(dashed(positions, kDashes[kind]), kEdgeColours[kind], 2.5, 1);
    }
    const selected = marks.selected;
    if (selected && 'edge' in selected) {
      const a = marks.place(selected.edge.a),
        b = marks.place(selected.edge.b);
      if (a && b) {
        this.segments([...a.toArray(), ...b.toArray()], kDark, 9, 1);
        this.segments([...a.toArray(), ...b.toArray()], kSelected, 6, 1);
        this.segments([...a.toArray(), ...b.toArray()], kEdgeColours[selected.edge.kind], 3, 1);
      }
    }
    if (marks.dots) this.points(marks);
  }

  private clear(): void {
    for (const line of this.lines) {
      this.scene.remove(line.object);
      line.dispose();
    }
    this.lines = [];
    this.edges = [];
    this.strokes.length = 0;
    if (this.dots) {
      this.scene.remove(this.dots);
      this.dots.geometry.dispose();
      (this.dots.material as THREE.Material).dispose();
      this.dots = undefined;
    }
  }

  /** From node to node of one session. */
  private path(marks: Marks, robot: string): void {
    const own = marks.nodes.filter(({node}) => node.robot === robot);
    const positions = stepsOf(own).flatMap(([a, b]) => [...a.p.toArray(), ...b.p.toArray()]);
    this.edge(positions, '#ffffff', 5, 0.7);
    this.segments(positions, colourOf(marks.state, robot), 3, 1);
  }

  /** Below lines that are added next. */
  private edge(positions: number[], colour: string, width: number, opacity: number): void {
    this.segments(positions, colour, width, opacity);
    if (positions.length > 0) this.edges.push(this.lines.at(-1)!);
  }

  private segments(positions: number[], colour: string, width: number, opacity: number): void {
    if (positions.length === 0) return;
    const line = new WideLines(positions, rgb(colour), width, opacity, this.size);
    line.object.renderOrder = this.lines.length;
    this.lines.push(line);
    this.scene.add(line.object);
    if (opacity === 1) this.strokes.push({ends: positions, colour: pixelOf(rgb(colour)), width});
  }

  private points(marks: Marks): void {
    const positions: number[] = [],
      colours: number[] = [],
      sizes: number[] = [];
    const highlighted = new Set<string>();
    const selected = marks.selected;
    if (selected && 'node' in selected) highlighted.add(selected.node);
    if (selected && 'edge' in selected) highlighted.add(selected.edge.a).add(selected.edge.b);
    for (const {node, p} of marks.nodes) {
      positions.push(...p.toArray());
      colours.push(...rgb(colourOf(marks.state, node.robot)).toArray());
      sizes.push(highlighted.has(node.id) ? 16 : 8);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3));
    geometry.setAttribute('tint', new THREE.Float32BufferAttribute(colours, 3));
    geometry.setAttribute('size', new THREE.Float32BufferAttribute(sizes, 1));
    const material = new THREE.ShaderMaterial({
      transparent: true,
      depthTest: false,
      depthWrite: false,
      uniforms: {ratio: {value: Math.min(2, window.devicePixelRatio)}},
      vertexShader: kDotVertex,
      fragmentShader: kDotFragment,
    });
    this.dots = new THREE.Points(geometry, material);
    this.dots.frustumCulled = false;
    this.dots.renderOrder = 1000;
    this.scene.add(this.dots);
  }
}
