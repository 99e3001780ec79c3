import * as THREE from 'three';
import {pointMaterial, type PointStyle} from './point_material';

export const kBlock = 256; // points; the shader shifts by 8
const kTexels = 4; // of a block: three rows of its matrix, then colour and share
const kAcross = 64; // blocks in a row of the texture
const kAtFirst = 1024; // blocks

/**
 * All points of the map in one buffer that WebGL draws by one call. Points lie in blocks; each block has its pose and
 * colour in a texture, so that a correction of the graph writes matrices and no point. An index names the points that
 * are drawn.
 */
export class PointPool {
  readonly object: THREE.Points<THREE.BufferGeometry, THREE.ShaderMaterial>;
  readonly runs: {block: number; points: number}[] = []; // that are drawn: of each block the first points
  values = new Int16Array(0); // x, y, z, intensity of each point
  private styles = new Float32Array(0);
  private indices = new Uint32Array(0);
  private free: number[] = [];
  private blocks = 0; // that there is room for

  constructor(style: PointStyle) {
    this.object = new THREE.Points(new THREE.BufferGeometry(), pointMaterial(style));
    this.object.frustumCulled = false;
    this.object.matrixAutoUpdate = false;
    this.grow(kAtFirst);
  }

  get used(): number {
    return this.blocks - this.free.length;
  }

  take(): number {
    if (this.free.length === 0) this.grow(2 * this.blocks);
    return this.free.pop()!;
  }

  give(block: number): void {
    this.free.push(block);
  }

  /** Points of a block, from its first one on. */
  fill(block: number, from: number, points: Int16Array): void {
    const start = 4 * (kBlock * block + from);
    this.values.set(points, start);
    const buffer = (this.object.geometry.getAttribute('position') as THREE.InterleavedBufferAttribute).data;
    buffer.addUpdateRange(start, points.length);
    buffer.needsUpdate = true;
  }

  /** Pose (to the world, of steps of 1/32767) and style of a block. */
  dress(block: number, matrix: THREE.Matrix4, colour: THREE.Color, share: number): void {
    const m = matrix.elements,
      start = 4 * kTexels * block;
    for (let row = 0; row < 3; ++row) this.styles.set([m[row], m[row + 4], m[row + 8], m[row + 12]], start + 4 * row);
    this.styles.set([colour.r, colour.g, colour.b, share], start + 12);
    this.texture.needsUpdate = true;
  }

  /** Begins a new list of what is drawn; draw() adds to it. */
  begin(): void {
    this.runs.length = 0;
  }

  draw(block: number, points: number): void {
    this.runs.push({block, points});
  }

  /** Brings the list to WebGL. */
  end(): void {
    const points = this.runs.reduce((sum, run) => sum + run.points, 0);
    const {geometry} = this.object;
    if (this.indices.length < points) {
      this.indices = new Uint32Array(Math.ceil(1.2 * points));
      geometry.setIndex(new THREE.BufferAttribute(this.indices, 1).setUsage(THREE.DynamicDrawUsage));
    }
    let drawn = 0;
    for (const run of this.runs) {
      for (let k = 0, first = kBlock * run.block; k < run.points; ++k) this.indices[drawn++] = first + k;
    }
    if (geometry.index) {
      geometry.index.clearUpdateRanges();
      geometry.index.addUpdateRange(0, drawn);
      geometry.index.needsUpdate = true;
    }
    geometry.setDrawRange(0, drawn);
    this.object.visible = drawn > 0;
  }

  /** As dress() put it: three rows of its matrix, colour and share. */
  styleOf(block: number): Float32Array {
    return this.styles.subarray(4 * kTexels * block, 4 * kTexels * (block + 1));
  }

  /** Point k of a block, in steps of its submap. */
  step(block: number, k: number, out: THREE.Vector3): THREE.Vector3 {
    const v = this.values,
      at = 4 * (kBlock * block + k);
    return out.set(v[at] / 32767, v[at + 1] / 32767, v[at + 2] / 32767);
  }

  private get texture(): THREE.DataTexture {
    return this.object.material.uniforms.styles.value;
  }

  private grow(blocks: number): void {
    const values = new Int16Array(4 * kBlock * blocks),
      styles = new Float32Array(4 * kTexels * blocks);
    values.set(this.values);
    styles.set(this.styles);
    [this.values, this.styles] = [values, styles];
    for (let block = blocks; block-- > this.blocks;) this.free.push(block);
    this.blocks = blocks;
    const {geometry, material} = this.object;
    geometry.dispose();
    const buffer = new THREE.InterleavedBuffer(values, 4).setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute('position', new THREE.InterleavedBufferAttribute(buffer, 3, 0, true));
    geometry.setAttribute('intensity', new THREE.InterleavedBufferAttribute(buffer, 1, 3, true));
    material.uniforms.styles.value?.dispose();
    const texture = new THREE.DataTexture(
      styles,
      kTexels * kAcross,
      blocks / kAcross,
      THREE.RGBAFormat,
      THREE.FloatType,
    );
    texture.needsUpdate = true;
    material.uniforms.styles.value = texture;
  }
}
