import * as THREE from 'three';
import {isNumber} from './model';
import type {PointStyle} from './point_material';
import {kBlock, PointPool} from './point_pool';
import {type Part, parsePart, parseParts, Submap} from './submap';

const kCoarse = 1024; // points of a submap that come with those of others, at most
const kMin = 64; // likewise, at least
const kTogether = 64; // submaps of one request
const kCoarseAtOnce = 3; // requests
const kFineAtOnce = 6;
const kFineStep = 4096; // points
const kAllocate_ms = 100; // while the view moves
const kAgain_ms = 2000; // after a request that nobody answered, or that failed first
const kMaxAgain_ms = 60_000; // after one that failed again and again

/** All submaps: asks for those that are worth it, and divides the budget of points among them. */
export class Submaps {
  readonly all = new Map<string, Submap>();
  readonly pool: PointPool;
  budget = 1_000_000;
  only: ReadonlySet<string> | undefined; // the hashes of those that are shown; undefined: all
  drawn = 0;
  listed = false; // what is drawn has changed since this was set to false
  private running = 0;
  private moving = false;
  private visible: {submap: Submap; weight: number}[] = []; // nearest first
  private allocated = -Infinity;
  private share = 1;
  private stale = true;
  private heights_?: [number, number];
  private heightsOf = 0; // points loaded when they were taken
  private loaded = 0;

  constructor(
    style: PointStyle,
    private changed: () => void,
  ) {
    this.pool = new PointPool(style);
  }

  add(hash: string, robot: string, t: number): Submap {
    const submap = new Submap(hash, robot, t, this.pool);
    this.all.set(hash, submap);
    return submap;
  }

  keepOnly(hashes: ReadonlySet<string>): void {
    for (const [hash, submap] of this.all) {
      if (hashes.has(hash)) continue;
      submap.trim(0);
      this.all.delete(hash);
    }
    this.refresh();
  }

  /** Something other than the view has changed: the next picture divides the budget anew. */
  refresh(): void {
    this.stale = true;
  }

  /**
   * Prepares a picture of so large a share of the budget. While the view moves the budget is divided from time to time
   * only.
   */
  prepare(camera: THREE.Camera, planar: boolean, until: number, moving: boolean, share: number): void {
    this.moving = moving;
    const now = performance.now();
    const due = this.stale || !moving || now - this.allocated > kAllocate_ms;
    if (due) {
      this.allocate(camera, planar, until);
      this.allocated = now;
      this.stale = false;
    }
    if (due || share !== this.share) this.list(share);
    for (const submap of this.all.values()) submap.dress();
  }

  private allocate(camera: THREE.Camera, planar: boolean, until: number): void {
    const frustum = new THREE.Frustum().setFromProjectionMatrix(
      new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse),
    );
    const eye = new THREE.Vector3().setFromMatrixPosition(camera.matrixWorld);
    const sphere = new THREE.Sphere();
    this.visible = [];
    for (const submap of this.all.values()) {
      submap.visible = submap.t <= until && (this.only?.has(submap.hash) ?? true);
      submap.wanted = 0;
      if (!submap.visible || !frustum.intersectsSphere(sphere.set(submap.centre, submap.radius))) continue;
      const distance = planar ? 1 : Math.max(5, eye.distanceTo(submap.centre) - 0.5 * submap.radius);
      this.visible.push({submap, weight: 1 / (distance * distance)});
    }
    divide(this.visible, this.budget);
    this.visible.sort((a, b) => b.weight - a.weight);
    this.trim();
    this.fetchMore();
  }

  /** Names the points that are drawn: of each submap the first ones. */
  private list(share: number): void {
    this.share = share;
    this.pool.begin();
    this.drawn = 0;
    for (const {submap} of this.visible) this.drawn += submap.draw(share);
    this.listed = true;
  }

  /** Puts each submap on the ramp of colours by a value of it; returns the values at the ramp's ends. */
  putOnRamp(
    value: (submap: Submap) => number | undefined,
    until: number,
    atLeast: [number, number] = [Infinity, -Infinity],
  ): [number, number] {
    const shown = [...this.all.values()].filter((one) => one.t <= until);
    const values: number[] = [];
    for (const submap of shown) {
      const one = value(submap);
      if (isNumber(one)) values.push(one);
    }
    if (values.length === 0) return isNumber(atLeast[0]) ? atLeast : [0, 0];
    values.sort((a, b) => a - b);
    const low = Math.min(atLeast[0], values[0]),
      high = Math.max(atLeast[1], values[Math.floor(0.985 * (values.length - 1))]);
    for (const submap of shown) submap.share = ((value(submap) ?? high) - low) / Math.max(1e-9, high - low);
    return [low, high];
  }

  /**
   * Heights between which most of the points are; undefined while there are few. Taken anew when a tenth more points
   * have come.
   */
  heights(): [number, number] | undefined {
    if (this.heights_ && this.loaded < 1.1 * this.heightsOf) return this.heights_;
    const heights: number[] = [],
      p = new THREE.Vector3();
    const each = Math.max(4, Math.min(40, Math.floor(40_000 / this.all.size)));
    for (const submap of this.all.values()) {
      const known = Math.min(submap.loaded, 4096),
        step = Math.max(1, Math.floor(known / each));
      for (let k = 0; k < known; k += step) heights.push(submap.point(k, p).z);
    }
    if (heights.length < 10) return undefined;
    heights.sort((a, b) => a - b);
    this.heightsOf = this.loaded;
    this.heights_ = [heights[Math.floor(0.02 * heights.length)], heights[Math.floor(0.985 * heights.length)]];
    return this.heights_;
  }

  /** Some submap in view is not on the map at all yet. */
  get loading(): boolean {
    return this.visible.some(({submap}) => submap.total < 0 && !submap.failed);
  }

  private trim(): void {
    if (kBlock * this.pool.used <= 3 * this.budget + 2 * kBlock * this.all.size) return;
    for (const submap of this.all.values())
      if (submap.wanted < submap.loaded) submap.trim(Math.max(kMin, submap.wanted));
  }

  /** Goes on where the last picture left off, so that loading does not wait for slow pictures. */
  private fetchMore(): void {
    const open = this.visible.map(({submap}) => submap).filter((one) => !one.asked && !one.failed);
    const coarse = spread(open.filter((one) => one.total < 0));
    const share = Math.ceil(this.budget / Math.max(1, this.visible.length));
    for (let k = 0; k < coarse.length && this.running < kCoarseAtOnce; k += kTogether)
      void this.fetchTogether(coarse.slice(k, k + kTogether), 0, Math.min(kCoarse, Math.max(kMin, share)));
    if (coarse.length > 0) return;
    let together: Submap[] = [];
    for (const submap of open) {
      if (this.running >= kFineAtOnce) return;
      if (!this.isWorthMore(submap)) continue;
      if (useful(submap) > kCoarse) void this.fetchFine(submap);
      else if (together.length === 0 || submap.loaded === together[0].loaded) together.push(submap);
      if (together.length < kTogether) continue;
      void this.fetchFew(together);
      together = [];
    }
    if (together.length > 0 && this.running < kFineAtOnce) void this.fetchFew(together);
  }

  /** A few points more are not worth a request; while the view moves, it must be twice as many. */
  private isWorthMore(submap: Submap): boolean {
    const missing = useful(submap) - submap.loaded;
    if (this.moving) return missing > submap.loaded;
    return missing > 0 && (missing > 0.1 * submap.loaded || submap.wanted >= submap.total);
  }

  /** More points of several submaps of which as many are here, but not many. */
  private async fetchFew(submaps: Submap[]): Promise<void> {
    const from = submaps[0].loaded,
      max = Math.max(...submaps.map(useful));
    await this.fetchTogether(submaps, from, Math.min(kCoarse, Math.ceil(max / kMin) * kMin) - from);
  }

  /**
   * Some of the first points of several submaps. The program decodes some at a time; the rest is asked for again.
   */
  private async fetchTogether(submaps: Submap[], from: number, points: number): Promise<void> {
    const of = submaps.map((one) => one.hash).join();
    await this.ask(submaps, `/submaps?from=${from}&count=${points}&of=${of}`, (answer) => {
      const parts = parseParts(answer);
      if (parts.size === 0) throw new Error('the program sent none of the submaps');
      for (const submap of submaps) {
        const part = parts.get(submap.hash);
        if (part) this.put(submap, part);
      }
    });
  }

  private async fetchFine(submap: Submap): Promise<void> {
    const points = Math.ceil((submap.wanted - submap.loaded) / kFineStep) * kFineStep;
    await this.ask(
      [submap],
      `/submap/${submap.hash}?from=${submap.loaded}&count=${Math.min(points, 262_144)}`,
      (answer) => this.put(submap, parsePart(answer)),
    );
  }

  private async ask(submaps: Submap[], address: string, take: (answer: ArrayBuffer) => void): Promise<void> {
    for (const submap of submaps) submap.asked = true;
    ++this.running;
    try {
      const answer = await this.fetchPatiently(address);
      if (!answer.ok) throw new Error(await answer.text());
      take(await answer.arrayBuffer());
    } catch (error) {
      for (const submap of submaps) this.fail(submap);
      console.warn(`submap ${submaps.map((one) => one.hash).join()}: ${(error as Error).message}`);
    } finally {
      for (const submap of submaps) submap.asked = false;
      --this.running;
      this.fetchMore();
      this.refresh();
      this.changed();
    }
  }

  /** The picture goes on without it; it is asked for again later, since a robot may be busy or a token be missing. */
  private fail(submap: Submap): void {
    submap.failed = true;
    const wait = Math.min(kMaxAgain_ms, kAgain_ms * 2 ** submap.failures++);
    setTimeout(() => {
      submap.failed = false;
      this.refresh();
      this.changed();
    }, wait);
  }

  /** A robot that is out of reach for a while is asked again. */
  private async fetchPatiently(address: string): Promise<Response> {
    for (;;) {
      try {
        return await fetch(address);
      } catch {
        await new Promise((later) => setTimeout(later, kAgain_ms));
      }
    }
  }

  private put(submap: Submap, part: Part): void {
    if (this.all.get(submap.hash) !== submap) return;
    const before = submap.loaded;
    submap.add(part);
    this.loaded += submap.loaded - before;
    if (part.total > 0) {
      submap.failures = 0;
      return;
    }
    submap.total = -1;
    this.fail(submap);
    console.warn(`submap ${submap.hash}: the program cannot read it`);
  }
}

/**
 * In an order of which the first ones are spread over all (van der Corput), so that the first picture is of the whole
 * site.
 */
function spread(submaps: Submap[]): Submap[] {
  const bits = Math.max(1, Math.ceil(Math.log2(Math.max(2, submaps.length))));
  const order: Submap[] = [];
  const inTime = [...submaps].sort((a, b) => (a.robot < b.robot ? -1 : a.robot > b.robot ? 1 : a.t - b.t));
  for (let k = 0; k < 1 << bits; ++k) {
    let mirrored = 0;
    for (let bit = 0; bit < bits; ++bit) mirrored |= ((k >> bit) & 1) << (bits - 1 - bit);
    if (mirrored < inTime.length) order.push(inTime[mirrored]);
  }
  return order;
}

/** Points in proportion to the weights, no submap more than it has. */
function divide(visible: {submap: Submap; weight: number}[], budget: number): void {
  let left = budget;
  let open = [...visible];
  for (let round = 0; round < 8 && open.length > 0 && left > 0; ++round) {
    const sum = open.reduce((total, one) => total + one.weight, 0);
    const factor = left / sum;
    const full = open.filter(({submap, weight}) => submap.wanted + factor * weight >= size(submap));
    if (full.length === 0) {
      for (const {submap, weight} of open) submap.wanted += Math.floor(factor * weight);
      return;
    }
    for (const {submap} of full) {
      left -= size(submap) - submap.wanted;
      submap.wanted = size(submap);
    }
    const isFull = new Set(full);
    open = open.filter((one) => !isFull.has(one));
  }
}

/** Points that its share of the budget would draw. */
const useful = (submap: Submap) => Math.min(submap.wanted, submap.total);

function size(submap: Submap): number {
  return submap.total < 0 ? kFineStep : submap.total;
}
