import * as THREE from 'three';
import {shape} from './dom';
import {type Geo, toEnu} from './geodesy';
import {linksAt, linksOf, type RobotLink} from './links';
import {distanceToSegment} from './hit';
import type {FleetMap} from './map';
import {colourOf, endOf, type FleetNode, isNumber, type Live, type RadioHistory, type State} from './model';
import type {Place} from './picking';
import {matrixOf} from './submap';

const kLabel_px = 62; // half of the longest label
const kLine_px = 15;
const kOtherClock_s = 600; // a robot that drives makes a node more often
const kCorners = 32; // of an ellipse
const k95 = 2.4477; // sigmas of two dimensions that hold 95 %

interface Mark {
  robot: string;
  colour: string;
  p: THREE.Vector3;
  ahead: THREE.Vector3; // a place in front of it
  ellipse: THREE.Vector3[]; // where it is with 95 %, around p; empty: not known
  stamp_s: number; // of its last node
  T_map_enu?: THREE.Matrix4; // what alignments corrected at its last node, which holds for its EKF, too
}

/**
 * Each robot's place on the map with its heading and name: at its last node, or where its last status has it. Links: of
 * a running robot that shows the page its own at present, of a run the logged ones of all robots at the time shown.
 */
export class RobotMarks {
  shown = true;
  /** Those of the links that are drawn. */
  readonly qualities = new Set<RobotLink['quality']>();
  private lines: {link: RobotLink; a: Place; b: Place}[] = [];
  private marks: Mark[] = [];
  private origin?: Geo; // of ENU
  private live?: Live;
  private history?: RadioHistory;
  private heardAt = 0;
  private drawn = '';
  private until = Infinity; // s; Infinity: the present, or the mission's end
  private end = 0; // s, of the last node

  constructor(
    private map: FleetMap,
    private overlay: SVGSVGElement,
  ) {}

  /** Each robot at its last node until `until`, s. */
  show(state: State, until: number): void {
    this.until = until;
    this.origin = state.origin;
    this.end = endOf(state);
    this.history = state.radio ?? undefined;
    const last = new Map<string, FleetNode>();
    for (const node of state.nodes)
      if (node.T?.every(isNumber) && node.t <= until && node.t >= (last.get(node.robot)?.t ?? -Infinity))
        last.set(node.robot, node);
    this.marks = [...last].map(([robot, node]) => {
      const [x, y, z, ...q] = node.T!;
      const p = new THREE.Vector3(x, y, z);
      const ahead = new THREE.Vector3(1, 0, 0)
        .applyQuaternion(new THREE.Quaternion(...q))
        .setZ(0)
        .normalize();
      const one = state.robots.find(({id}) => id === robot);
      const C = one?.last_node === node.id ? one.covariance_m2 : undefined;
      const covariance = C?.every(isNumber) ? C : undefined;
      return {
        robot,
        colour: colourOf(state, robot),
        p,
        ahead: ahead.add(p),
        stamp_s: state.begin_s + (node.stamp_s ?? node.t),
        ellipse: covariance ? ellipseOf(covariance).map(([dx, dy]) => new THREE.Vector3(dx, dy, 0)) : [],
        T_map_enu: node.gps?.every(isNumber) ? matrixOf(node.T!).multiply(matrixOf(node.gps).invert()) : undefined,
      };
    });
    this.draw();
  }

  showLive(live: Live): void {
    this.live = live;
    this.heardAt = performance.now();
    this.draw();
  }

  /** After each picture of the map. */
  draw(): void {
    this.qualities.clear();
    this.lines = [];
    if (!this.shown) return this.replace([]);
    const marks = this.marks.map((mark) => this.atPresent(mark));
    const places = new Map(marks.map((mark) => [mark.robot, this.map.project(mark.p)]));
    const links = this.links();
    const lines: SVGElement[] = [],
      words: SVGElement[] = [],
      taken: Box[] = [],
      names = new Map<string, Box>();
    for (const [robot, place] of places)
      if (place) names.set(robot, freeBox(boxOf(robot, place.x + 12 + 3.5 * robot.length, place.y - 10), taken));
    for (const link of links) {
      const {from, to, quality, text} = link;
      const one = places.get(from),
        other = places.get(to);
      if (!one || !other) continue;
      this.qualities.add(quality);
      this.lines.push({link, a: one, b: other});
      const line = {x1: one.x, y1: one.y, x2: other.x, y2: other.y};
      lines.push(shape('line', {...line, class: 'link-border'}), shape('line', {...line, class: `link ${quality}`}));
      const box = boxOf(text, this.within((one.x + other.x) / 2), (one.y + other.y) / 2 - 5);
      if (Math.hypot(other.x - one.x, other.y - one.y) < kLabel_px || taken.some((there) => overlap(there, box)))
        continue;
      taken.push(box);
      words.push(label(text, box.x, box.y, 'link'));
    }
    const silent = new Set(links.filter((one) => one.quality === 'silent').map((one) => one.to));
    const robots = marks.flatMap((mark) => {
      const place = places.get(mark.robot);
      return place ? this.markOf(mark, place, names.get(mark.robot)!.y, silent.has(mark.robot)) : [];
    });
    this.replace([...lines, ...words, ...robots]);
  }

  /**
   * Moved to where the robot's last status has it, while the present is shown. A status may be older than a node, and
   * nodes of a recording have the time of another day.
   */
  private atPresent(mark: Mark): Mark {
    const place = this.until === Infinity && this.live?.robots.find(({id}) => id === mark.robot)?.place;
    if (!place || !mark.T_map_enu || !this.origin) return mark;
    const [latitude_deg, longitude_deg, altitude_m, heading, stamp_s] = place;
    if (stamp_s < mark.stamp_s || stamp_s > mark.stamp_s + kOtherClock_s) return mark;
    const enu = new THREE.Vector3(...toEnu(this.origin, {latitude_deg, longitude_deg, altitude_m}));
    const p = enu.clone().applyMatrix4(mark.T_map_enu).setZ(mark.p.z); // the height of an EKF's place is its worst
    const ahead = enu.add(new THREE.Vector3(Math.cos(heading), Math.sin(heading), 0)).applyMatrix4(mark.T_map_enu);
    return {...mark, p, ahead: ahead.setZ(p.z)};
  }

  /** The link that is drawn within `reach` pixels of a place. */
  linkAt(x: number, y: number, reach: number): RobotLink | undefined {
    let nearest = reach,
      found: RobotLink | undefined;
    for (const {link, a, b} of this.lines) {
      const distance = distanceToSegment({x, y}, a, b);
      if (distance < nearest) [nearest, found] = [distance, link];
    }
    return found;
  }

  private links(): RobotLink[] {
    if (this.live) return this.until === Infinity ? linksOf(this.live, (performance.now() - this.heardAt) / 1000) : [];
    return this.history ? linksAt(this.history, Math.min(this.until, this.end)) : [];
  }

  /** Shapes that are drawn anew over the canvas make the browser compose the whole map again. */
  private replace(shapes: SVGElement[]): void {
    const drawn = shapes.map((one) => one.outerHTML).join('');
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    this.overlay.replaceChildren(...shapes);
  }

  /** A place for the middle of a label that the map's sides do not cut. */
  private within(x: number): number {
    const width = this.overlay.clientWidth;
    return width > 2 * kLabel_px ? Math.min(width - kLabel_px, Math.max(kLabel_px, x)) : x;
  }

  private markOf(mark: Mark, {x, y}: Place, nameY: number, silent: boolean): SVGElement[] {
    const {robot, colour, p, ahead, ellipse} = mark;
    const shapes: SVGElement[] = [];
    const corners = ellipse.map((corner) => this.map.project(corner.clone().add(p)));
    if (corners.length > 0 && corners.every((one) => one !== undefined)) {
      const points = corners.map((one) => `${one!.x.toFixed(1)},${one!.y.toFixed(1)}`).join(' ');
      shapes.push(shape('polygon', {points, class: 'ellipse', style: `fill:${colour}`}));
    }
    const front = this.map.project(p.clone().lerp(ahead, 0.5));
    const angle = front ? (Math.atan2(front.y - y, front.x - x) * 180) / Math.PI : 0;
    const fill = silent ? '#ffffff' : colour,
      stroke = silent ? colour : '#ffffff';
    shapes.push(
      shape('path', {
        d: 'M 13 0 L -8 8.5 L -4 0 L -8 -8.5 Z',
        transform: `translate(${x.toFixed(1)} ${y.toFixed(1)}) rotate(${angle.toFixed(1)})`,
        class: 'robot-mark',
        'data-mark': robot,
        style: `fill:${fill};stroke:${stroke}`,
      }),
      label(silent ? `${robot} (lost)` : robot, x + 12, nameY, 'robot-name', colour),
    );
    return shapes;
  }
}

/** The contour of 95 % around the mean of a covariance [xx, xy, yy]. */
export function ellipseOf([xx, xy, yy]: [number, number, number]): [number, number][] {
  const mean = (xx + yy) / 2,
    spread = Math.hypot((xx - yy) / 2, xy),
    angle = 0.5 * Math.atan2(2 * xy, xx - yy);
  const [a, b] = [mean + spread, mean - spread].map((variance) => k95 * Math.sqrt(Math.max(0, variance)));
  return Array.from({length: kCorners}, (_, k) => {
    const turn = (2 * Math.PI * k) / kCorners,
      along = a * Math.cos(turn),
      across = b * Math.sin(turn);
    return [along * Math.cos(angle) - across * Math.sin(angle), along * Math.sin(angle) + across * Math.cos(angle)];
  });
}

/** The middle of a label's foot, and half of its width, pixels. */
interface Box {
  x: number;
  y: number;
  half: number;
}

const boxOf = (text: string, x: number, y: number): Box => ({x, y, half: 3.5 * text.length});
const overlap = (a: Box, b: Box) => Math.abs(a.x - b.x) < a.half + b.half && Math.abs(a.y - b.y) < kLine_px;

/** Above the labels that are there already, which it then is, too. */
function freeBox(box: Box, taken: Box[]): Box {
  let y = box.y;
  while (taken.some((one) => overlap(one, {...box, y}))) y -= 1;
  taken.push({...box, y});
  return {...box, y};
}

function label(text: string, x: number, y: number, kind: string, colour = ''): SVGElement {
  const style = colour && `fill:color-mix(in srgb, ${colour} 70%, #10161d)`; // dark enough to be read
  return shape('text', {x: x.toFixed(1), y: y.toFixed(1), class: kind, style}, text);
}
