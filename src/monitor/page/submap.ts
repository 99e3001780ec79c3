import * as THREE from 'three';
import {kStranger} from './colours';
import type {PoseValues} from './model';
import {rgbOf} from './point_material';
import {kBlock, type PointPool} from './point_pool';

const kHeader = 36;
const kHash = 32;

/** One part of a submap as the program sends it (src/monitor/point_levels.hpp). */
export interface Part {
  centre: [number, number, number];
  scale: number;
  total: number;
  from: number;
  values: Int16Array;
}

/** The part at `at` of a buffer, and where it ends. */
function partAt(buffer: ArrayBuffer, at: number): {part: Part; end: number} {
  const damaged = () => new Error('a submap came damaged');
  if (buffer.byteLength < at + kHeader) throw damaged();
  const view = new DataView(buffer, at);
  const magic = String.fromCharCode(...new Uint8Array(buffer, at, 4));
  const end = at + kHeader + 8 * view.getUint32(28, true);
  if (magic !== 'FMP1' || buffer.byteLength < end) throw damaged();
  const part = {
    centre: [view.getFloat32(4, true), view.getFloat32(8, true), view.getFloat32(12, true)] as [number, number, number],
    scale: view.getFloat32(16, true),
    total: view.getUint32(20, true),
    from: view.getUint32(24, true),
    values: new Int16Array(buffer, at + kHeader, (end - at - kHeader) / 2),
  };
  return {part, end};
}

export function parsePart(buffer: ArrayBuffer): Part {
  const {part, end} = partAt(buffer, 0);
  if (end !== buffer.byteLength) throw new Error('a submap came damaged');
  return part;
}

/** The first parts of several submaps, each after its hash. */
export function parseParts(buffer: ArrayBuffer): Map<string, Part> {
  const parts = new Map<string, Part>();
  for (let at = 0; at < buffer.byteLength;) {
    const hash = String.fromCharCode(...new Uint8Array(buffer, at, Math.min(kHash, buffer.byteLength - at)));
    const {part, end} = partAt(buffer, at + kHash);
    parts.set(hash, part);
    at = end;
  }
  return parts;
}

export function matrixOf([x, y, z, qx, qy, qz, qw]: PoseValues): THREE.Matrix4 {
  return new THREE.Matrix4().compose(
    new THREE.Vector3(x, y, z),
    new THREE.Quaternion(qx, qy, qz, qw),
    new THREE.Vector3(1, 1, 1),
  );
}

/** A submap on the map. Its points never change; a correction moves the matrix of its blocks alone. */
export class Submap {
  readonly centre = new THREE.Vector3(); // in the world, of the bounding sphere
  radius = 30;
  total = -1; // points it has; -1: nobody has asked yet
  loaded = 0; // points that are here
  wanted = 0; // points that the budget leaves it
  asked = false;
  failed = false; // the last time that it was asked for
  failures = 0; // since it came last
  sigma_m: number | undefined; // of its node in ENU, horizontal
  floating: number | undefined; // of its node
  visible = true;
  private blocks: number[] = [];
  private T = new THREE.Matrix4();
  private moved?: THREE.Matrix4;
  private local = new THREE.Matrix4();
  private matrix = new THREE.Matrix4();
  private tinted?: string;
  private share_ = 0;
  private stale = true; // its blocks do not show its pose and style yet

  constructor(
    readonly hash: string,
    readonly robot: string,
    readonly t: number,
    private pool: PointPool,
    private colour_ = kStranger,
  ) {}

  /** Its robot's. */
  set colour(colour: string) {
    this.stale ||= colour !== this.colour_;
    this.colour_ = colour;
  }

  place(T_enu_node: THREE.Matrix4): void {
    this.T.copy(T_enu_node);
    this.update();
  }

  /** Draws it elsewhere until it is moved back by undefined. */
  move(T_enu_node: THREE.Matrix4 | undefined): void {
    this.moved = T_enu_node;
    this.update();
  }

  /** Draws it in another colour than its robot's; undefined ends that. */
  tint(colour: string | undefined): void {
    this.tinted = colour;
    this.stale = true;
  }

  /** Its place on the ramp of colours, 0 to 1. */
  set share(value: number) {
    const share = Math.min(1, Math.max(0, value));
    this.stale ||= share !== this.share_;
    this.share_ = share;
  }

  get drawn(): number {
    return Math.min(this.wanted, this.loaded);
  }

  add(part: Part): void {
    this.total = part.total;
    if (part.from !== this.loaded) return;
    const steps = part.scale * 32767;
    this.radius = steps * Math.sqrt(3);
    this.local.makeTranslation(...part.centre).scale(new THREE.Vector3(steps, steps, steps));
    for (let taken = 0; 4 * taken < part.values.length;) {
      const from = this.loaded % kBlock;
      if (from === 0) this.blocks.push(this.pool.take());
      const points = Math.min(kBlock - from, part.values.length / 4 - taken);
      this.pool.fill(this.blocks.at(-1)!, from, part.values.subarray(4 * taken, 4 * (taken + points)));
      taken += points;
      this.loaded += points;
    }
    this.update();
  }

  /** Keeps so many points at most, so that memory stays bounded. */
  trim(points: number): void {
    const blocks = Math.ceil(points / kBlock);
    while (this.blocks.length > blocks) this.pool.give(this.blocks.pop()!);
    this.loaded = Math.min(this.loaded, kBlock * blocks);
  }

  /** Brings its pose and style to the pool, if they have changed. */
  dress(): void {
    if (!this.stale) return;
    this.stale = false;
    const colour = rgbOf(this.tinted ?? this.colour_);
    for (const block of this.blocks) this.pool.dress(block, this.matrix, colour, this.share_);
  }

  /** Draws such a share of its points; returns how many these are. */
  draw(share: number): number {
    const points = Math.ceil(share * this.drawn);
    for (let k = 0, left = points; left > 0; ++k, left -= kBlock)
      this.pool.draw(this.blocks[k], Math.min(kBlock, left));
    return points;
  }

  /** World coordinates of point k. */
  point(k: number, out: THREE.Vector3): THREE.Vector3 {
    return this.pool.step(this.blocks[Math.floor(k / kBlock)], k % kBlock, out).applyMatrix4(this.matrix);
  }

  private update(): void {
    this.matrix.multiplyMatrices(this.moved ?? this.T, this.local);
    this.centre.setFromMatrixPosition(this.matrix);
    this.stale = true;
  }
}
