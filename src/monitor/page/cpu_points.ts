import * as THREE from 'three';
import {drawStrokes, type Stroke} from './cpu_lines';
import {kPointSize, type PointStyle} from './point_material';
import {kBlock, type PointPool} from './point_pool';
import {rampOf, shaded, type Tones, turbo} from './ramp';
import type {PointPicture, View} from './shading';

const kEmpty = 2; // a depth behind everything

/** VP times the block's matrix, of steps of 1/32767, each row scaled: pixels and depths from the picture's middle. */
function toPixels(VP: number[], style: Float32Array, scales: number[]): number[] {
  return scales.flatMap((scale, r) =>
    [0, 1, 2, 3].map(
      (c) =>
        (scale *
          (VP[r] * style[c] + VP[r + 4] * style[c + 4] + VP[r + 8] * style[c + 8] + (c === 3 ? VP[r + 12] : 0))) /
        (c === 3 ? 1 : 32767),
    ),
  );
}

/** Place on the ramp, 0 to 255, of the height of a point of the block: factors of x, y, z, and what is added. */
function toRamp(style: Float32Array, low: number, high: number): number[] {
  const per = 255 / Math.max(0.1, high - low);
  return [...[8, 9, 10].map((at) => (style[at] / 32767) * per), (style[11] - low) * per];
}

/**
 * Draws points as gl_PointSize squares with a depth buffer, by the CPU, into textures. WebGL that runs on the CPU, as
 * in a virtual machine or over a remote desktop, takes about a microsecond a point; this takes some twenty
 * nanoseconds.
 */
export class CpuPoints {
  private picture?: PointPicture;
  private width = 0;
  private pixels = new Uint32Array(0);
  private bytes = new Uint8Array(0);
  private depths = new Float32Array(0);
  private VP = new THREE.Matrix4();
  private ramps = new Map<number, Uint32Array>();
  private tones: Tones = [0, 0]; // of these ramps
  private turbo = new Uint32Array(rampOf(turbo).buffer);

  constructor(
    private pool: PointPool,
    private style: PointStyle,
  ) {}

  render({camera, width, height}: View, withDepths: boolean): PointPicture {
    const picture = this.resize(width, height);
    this.pixels.fill(0);
    this.depths.fill(kEmpty);
    this.VP.multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
    for (const {block, points} of this.pool.runs) this.drawBlock(block, points, this.VP.elements, width, height);
    picture.colours.needsUpdate = true;
    if (withDepths) picture.depths.needsUpdate = true;
    return picture;
  }

  /** Lines over the last picture, which has no depths. */
  stroke(strokes: Stroke[]): void {
    const picture = {colours: this.pixels, width: this.width, height: this.depths.length / this.width};
    drawStrokes(picture, this.VP.elements, strokes, this.style.ratio.value);
  }

  private resize(width: number, height: number): PointPicture {
    if (this.picture && this.width === width && this.depths.length === width * height) return this.picture;
    this.picture?.colours.dispose();
    this.picture?.depths.dispose();
    this.width = width;
    this.bytes = new Uint8Array(4 * width * height);
    this.pixels = new Uint32Array(this.bytes.buffer);
    this.depths = new Float32Array(width * height);
    const colours = new THREE.DataTexture(this.bytes, width, height),
      depths = new THREE.DataTexture(this.depths, width, height, THREE.RedFormat, THREE.FloatType);
    this.picture = {colours, depths};
    return this.picture;
  }

  /** The colours of a block: of height or intensity, or of the block as a whole. */
  private ramp(style: Float32Array): Uint32Array {
    if (this.style.mode.value !== 0) return this.turbo;
    const key = (255 * style[12]) | ((255 * style[13]) << 8) | ((255 * style[14]) << 16);
    const tones: Tones = [this.style.lowTone.value, this.style.highTone.value];
    if (tones[0] !== this.tones[0] || tones[1] !== this.tones[1]) this.ramps.clear();
    this.tones = tones;
    let ramp = this.ramps.get(key);
    if (!ramp) {
      const colour = new THREE.Color(style[12], style[13], style[14]);
      ramp = new Uint32Array(rampOf((h) => shaded(colour, h, tones)).buffer);
      this.ramps.set(key, ramp);
    }
    return ramp;
  }

  private drawBlock(block: number, points: number, VP: number[], width: number, height: number): void {
    const style = this.pool.styleOf(block),
      v = this.pool.values,
      ramp = this.ramp(style);
    const {mode, low, high, pixelsPerMetre, planar, ratio} = this.style;
    const [halfWidth, halfHeight] = [0.5 * width, 0.5 * height];
    const rows = toPixels(VP, style, [halfWidth, halfHeight, 0.5, 1]);
    const [xx, xy, xz, x1, yx, yy, yz, y1, zx, zy, zz, z1, wx, wy, wz, w1] = rows;
    const [hx, hy, hz, h1] = toRamp(style, low.value, high.value);
    const [byHeight, byIntensity] = [mode.value < 2, mode.value >= 2 && mode.value < 3],
      own = ramp[Math.round(255 * style[15])];
    const size = kPointSize.metres * pixelsPerMetre.value * ratio.value,
      min = kPointSize.min * ratio.value,
      max = kPointSize.max * ratio.value;
    const flat = planar.value > 0.5,
      pixels = this.pixels,
      depths = this.depths;
    for (let at = 4 * kBlock * block, end = at + 4 * points; at < end; at += 4) {
      const x = v[at],
        y = v[at + 1],
        z = v[at + 2];
      const w = wx * x + wy * y + wz * z + w1;
      if (w <= 0) continue;
      const per_w = 1 / w;
      const depth = 0.5 + (zx * x + zy * y + zz * z + z1) * per_w;
      if (depth < 0 || depth > 1) continue;
      // The pixels whose middles are within the square.
      const half = 0.5 * Math.min(max, Math.max(min, flat ? size : size * Math.min(2, per_w)));
      const cx = (xx * x + xy * y + xz * z + x1) * per_w + halfWidth - 0.5;
      const cy = (yx * x + yy * y + yz * z + y1) * per_w + halfHeight - 0.5;
      const left = Math.max(0, Math.ceil(cx - half)),
        right = Math.min(width, Math.ceil(cx + half));
      const bottom = Math.max(0, Math.ceil(cy - half)),
        top = Math.min(height, Math.ceil(cy + half));
      let colour = own;
      if (byHeight) colour = ramp[Math.min(255, Math.max(0, (hx * x + hy * y + hz * z + h1) | 0))];
      else if (byIntensity) colour = ramp[(20.4 + 214.2 * Math.max(0, v[at + 3] / 32767)) | 0];
      for (let py = bottom; py < top; ++py) {
        for (let p = py * width + left, last = py * width + right; p < last; ++p) {
          if (depth >= depths[p]) continue;
          depths[p] = depth;
          pixels[p] = colour;
        }
      }
    }
  }
}
