import * as THREE from 'three';
import type {PoseValues} from './model';
import {pointMaterial, rgbOf, type PointLook} from './point_material';

const kHeader = 36;
const kFirst = 4096;  // points of the first part of a submap
const kAtOnce = 6;    // requests

/** One part of a submap as the program sends it (include/fleetmap/monitor/point_levels.hpp). */
interface Part {
  centre: [number, number, number];
  scale: number;
  total: number;
  from: number;
  values: Int16Array;
}

export function parsePart(buffer: ArrayBuffer): Part {
  const view = new DataView(buffer);
  const magic = String.fromCharCode(...new Uint8Array(buffer, 0, 4));
  const here = view.getUint32(28, true);
  if (magic !== 'FMP1' || buffer.byteLength !== kHeader + 8 * here) throw new Error('a submap came damaged');
  return {
    centre: [view.getFloat32(4, true), view.getFloat32(8, true), view.getFloat32(12, true)],
    scale: view.getFloat32(16, true),
    total: view.getUint32(20, true),
    from: view.getUint32(24, true),
    values: new Int16Array(buffer.slice(kHeader)),
  };
}

export function matrixOf([x, y, z, qx, qy, qz, qw]: PoseValues): THREE.Matrix4 {
  return new THREE.Matrix4().compose(new THREE.Vector3(x, y, z), new THREE.Quaternion(qx, qy, qz, qw), new THREE.Vector3(1, 1, 1));
}

/** A submap on the map. Its points never change; a correction moves `object` alone. */
export class Submap {
  readonly object: THREE.Points<THREE.BufferGeometry, THREE.ShaderMaterial>;
  readonly centre = new THREE.Vector3();  // in the world, of the bounding sphere
  radius = 30;
  total = -1;   // points it has; -1: nobody has asked yet
  loaded = 0;   // points that are here
  wanted = 0;   // points that the budget leaves it
  asked = false;
  failed = false;
  sigma_m: number | undefined;  // of its node in ENU, horizontal
  visible = true;
  inView = true;
  private values: Int16Array<ArrayBufferLike> = new Int16Array(0);  // x, y, z, intensity of each point
  private T = new THREE.Matrix4();
  private moved?: THREE.Matrix4;
  private local = new THREE.Matrix4();

  constructor(readonly hash: string, readonly robot: string, readonly t: number, look: PointLook, private colour: string) {
    this.object = new THREE.Points(new THREE.BufferGeometry(), pointMaterial(look, colour));
    this.object.matrixAutoUpdate = false;
    this.object.frustumCulled = false;  // allocate() does that
  }

  place(T_enu_node: THREE.Matrix4): void {
    this.T.copy(T_enu_node);
    this.object.matrix.multiplyMatrices(this.moved ?? this.T, this.local);
    this.object.matrixWorldNeedsUpdate = true;
    this.centre.setFromMatrixPosition(this.object.matrix);
  }

  /** Draws it elsewhere until it is moved back by undefined. */
  move(T_enu_node: THREE.Matrix4 | undefined): void {
    this.moved = T_enu_node;
    this.place(this.T.clone());
  }

  /** Draws it in another colour than its robot's; undefined ends that. */
  tint(colour: string | undefined): void {
    this.object.material.uniforms.colour.value.copy(rgbOf(colour ?? this.colour));
  }

  /** Where it stands on the ramp of colours, 0 to 1. */
  set share(value: number) {
    this.object.material.uniforms.share.value = Math.min(1, Math.max(0, value));
  }

  add(part: Part): void {
    this.total = part.total;
    if (part.from !== this.loaded) return;
    const values = new Int16Array(4 * this.loaded + part.values.length);
    values.set(this.values.subarray(0, 4 * this.loaded));
    values.set(part.values, 4 * this.loaded);
    this.loaded += part.values.length / 4;
    this.replace(values);
    const steps = part.scale * 32767;
    this.radius = steps * Math.sqrt(3);
    this.local.makeTranslation(...part.centre).scale(new THREE.Vector3(steps, steps, steps));
    this.place(this.T.clone());
  }

  /** Keeps the coarse part alone, so that memory stays bounded. */
  trim(): void {
    if (this.loaded <= kFirst) return;
    this.loaded = kFirst;
    this.replace(this.values.slice(0, 4 * kFirst));
  }

  private replace(values: Int16Array<ArrayBufferLike>): void {
    this.values = values;
    this.object.geometry.dispose();
    this.object.geometry = new THREE.BufferGeometry();
    const buffer = new THREE.InterleavedBuffer(values, 4);
    this.object.geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(buffer, 3, 0, true));
    this.object.geometry.setAttribute('intensity', new THREE.InterleavedBufferAttribute(buffer, 1, 3, true));
  }

  /** World coordinates of point k. */
  point(k: number, out: THREE.Vector3): THREE.Vector3 {
    const v = this.values;
    return out.set(v[4 * k] / 32767, v[4 * k + 1] / 32767, v[4 * k + 2] / 32767).applyMatrix4(this.object.matrix);
  }
}

/** All submaps: asks for those that are worth it, and divides the budget of points among them. */
export class Submaps {
  readonly group = new THREE.Group();
  readonly all = new Map<string, Submap>();
  budget = 1_000_000;
  only: ReadonlySet<string> | undefined;  // the hashes of those that are shown; undefined: all
  drawn = 0;
  private running = 0;
  private order: Submap[] = [];  // nearest first

  constructor(private changed: () => void) {}

  allocate(camera: THREE.Camera, planar: boolean, until: number): void {
    const frustum = new THREE.Frustum().setFromProjectionMatrix(
      new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse));
    const eye = new THREE.Vector3().setFromMatrixPosition(camera.matrixWorld);
    const sphere = new THREE.Sphere();
    const seen: {submap: Submap; weight: number}[] = [];
    for (const submap of this.all.values()) {
      submap.visible = submap.t <= until && (this.only?.has(submap.hash) ?? true);
      submap.inView = submap.visible && frustum.intersectsSphere(sphere.set(submap.centre, submap.radius));
      submap.wanted = 0;
      if (!submap.inView) continue;
      const distance = planar ? 1 : Math.max(5, eye.distanceTo(submap.centre) - 0.5 * submap.radius);
      seen.push({submap, weight: 1 / (distance * distance)});
    }
    divide(seen, this.budget);
    this.drawn = 0;
    for (const submap of this.all.values()) {
      const drawn = Math.min(submap.wanted, submap.loaded);
      submap.object.visible = drawn > 0;
      submap.object.geometry.setDrawRange(0, drawn);
      this.drawn += submap.object.visible ? drawn : 0;
    }
    this.trim();
    this.order = seen.sort((a, b) => b.weight - a.weight).map((one) => one.submap);
    this.fetchMore();
  }

  /** Puts each submap on the ramp of colours by a value of it; returns the values at the ramp's ends. */
  putOnRamp(value: (submap: Submap) => number | undefined, until: number): [number, number] {
    const shown = [...this.all.values()].filter((one) => one.t <= until);
    const values: number[] = [];
    for (const submap of shown) {
      const one = value(submap);
      if (one !== undefined) values.push(one);
    }
    if (values.length === 0) return [0, 0];
    values.sort((a, b) => a - b);
    const low = values[0], high = values[Math.floor(0.985 * (values.length - 1))];
    for (const submap of shown) submap.share = ((value(submap) ?? high) - low) / Math.max(1e-9, high - low);
    return [low, high];
  }

  /** Heights between which most of the points are; undefined while there are few. */
  heights(): [number, number] | undefined {
    const heights: number[] = [], p = new THREE.Vector3();
    for (const submap of this.all.values()) {
      const known = Math.min(submap.loaded, 4096), step = Math.max(1, Math.floor(known / 40));
      for (let k = 0; k < known; k += step) heights.push(submap.point(k, p).z);
    }
    if (heights.length < 10) return undefined;
    heights.sort((a, b) => a - b);
    return [heights[Math.floor(0.02 * heights.length)], heights[Math.floor(0.985 * heights.length)]];
  }

  /** Some submap in view is not on the map at all yet. */
  get loading(): boolean {
    return this.order.some((one) => one.total < 0 && !one.failed);
  }

  private trim(): void {
    let held = 0;
    for (const submap of this.all.values()) held += submap.loaded;
    if (held <= 3 * this.budget + 200_000) return;
    for (const submap of this.all.values()) if (submap.wanted <= kFirst) submap.trim();
  }

  /** Goes on where the last picture left off, so that loading does not wait for slow pictures. */
  private fetchMore(): void {
    const coarse = this.order.filter((one) => one.total < 0), fine = this.order.filter((one) => one.total >= 0 && one.loaded < Math.min(one.wanted, one.total));
    for (const submap of [...coarse, ...fine]) {
      if (this.running >= kAtOnce) return;
      if (!submap.asked && !submap.failed) void this.fetchPart(submap);
    }
  }

  private async fetchPart(submap: Submap): Promise<void> {
    submap.asked = true;
    ++this.running;
    const points = submap.total < 0 ? kFirst : Math.max(kFirst, Math.ceil((submap.wanted - submap.loaded) / kFirst) * kFirst);
    try {
      const answer = await fetch(`/submap/${submap.hash}?from=${submap.loaded}&count=${Math.min(points, 262_144)}`);
      if (!answer.ok) throw new Error(await answer.text());
      submap.add(parsePart(await answer.arrayBuffer()));
    } catch (error) {
      submap.failed = true;  // the picture goes on without it
      console.warn(`submap ${submap.hash}: ${(error as Error).message}`);
    } finally {
      submap.asked = false;
      --this.running;
      this.fetchMore();
      this.changed();
    }
  }
}

/** Points in proportion to the weights, no submap more than it has. */
function divide(seen: {submap: Submap; weight: number}[], budget: number): void {
  let left = budget;
  let open = [...seen];
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
    open = open.filter((one) => !full.includes(one));
  }
}

function size(submap: Submap): number {
  return submap.total < 0 ? kFirst : submap.total;
}
