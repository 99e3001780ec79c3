import * as THREE from 'three';
import {drawStrokes, type Stroke} from './cpu_lines';
import {kPointSize, type PointStyle} from './point_material';
import {kBlock, type PointPool} from './point_pool';
import {rampOf, shaded, type Tones, turbo} from './ramp';
import type {PointPicture, View} from './shading';

const kEmpty = 2; // a depth behind everything
const kOnePixel = 0.55; // half of a point's side, pixels: it is drawn as one pixel

/**
 * VP times the block's matrix, of steps of 1/32767, each row scaled: pixels and depths from the picture's middle. Into
 * an array of numbers, since V8 takes three times as long for all points if these come out of lists.
 */
function toPixels(VP: number[], style: Float32Array, scales: number[], out: Float64Array): void {
  for (let r = 0; r < 4; ++r) {
    const x = scales[r] * VP[r],
      y = scales[r] * VP[r + 4],
      z = scales[r] * VP[r + 8];
    for (let c = 0; c < 3; ++c) out[4 * r + c] = (x * style[c] + y * style[c + 4] + z * style[c + 8]) / 32767;
    out[4 * r + 3] = x * style[3] + y * style[7] + z * style[11] + scales[r] * VP[r + 12];
  }
}

/** Place on the ramp, 0 to 255, of the height of a point of the block: factors of x, y, z, and what is added. */
function toRamp(style: Float32Array, low: number, high: number, out: Float64Array): void {
  const per = 255 / Math.max(0.1, high - low);
  for (let k = 0; k < 3; ++k) out[k] = (style[8 + k] / 32767) * per;
  out[3] = (style[11] - low) * per;
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
  private rows = new Float64Array(16);
  private heights = new Float64Array(4);
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
    const m = this.rows,
      h = this.heights;
    toPixels(VP, style, [halfWidth, halfHeight, 0.5, 1], m);
    toRamp(style, low.value, high.value, h);
    const [byHeight, byIntensity] = [mode.value < 2, mode.value >= 2 && mode.value < 3],
      own = ramp[Math.round(255 * style[15])];
    // Half of a point's side, pixels: at a distance of 1 m, the least and the most.
    const size = 0.5 * kPointSize.metres * pixelsPerMetre.value * ratio.value,
      min = 0.5 * kPointSize.min * ratio.value,
      max = 0.5 * kPointSize.max * ratio.value;
    const flat = planar.value > 0.5,
      pixels = this.pixels,
      depths = this.depths;
    for (let at = 4 * kBlock * block, end = at + 4 * points; at < end; at += 4) {
      const x = v[at],
        y = v[at + 1],
        z = v[at + 2];
      const w = m[12] * x + m[13] * y + m[14] * z + m[15];
      if (w <= 0) continue;
      const per_w = 1 / w;
      const depth = 0.5 + (m[8] * x + m[9] * y + m[10] * z + m[11]) * per_w;
      if (depth < 0 || depth > 1) continue;
      const half = Math.min(max, Math.max(min, flat ? size : size * Math.min(2, per_w)));
      const cx = (m[0] * x + m[1] * y + m[2] * z + m[3]) * per_w + halfWidth;
      const cy = (m[4] * x + m[5] * y + m[6] * z + m[7]) * per_w + halfHeight;
      let colour = own;
      if (byHeight) colour = ramp[Math.min(255, Math.max(0, (h[0] * x + h[1] * y + h[2] * z + h[3]) | 0))];
      else if (byIntensity) colour = ramp[(20.4 + 214.2 * Math.max(0, v[at + 3] / 32767)) | 0];
      if (half < kOnePixel) {
        if (cx < 0 || cy < 0 || cx >= width || cy >= height) continue;
        const p = (cy | 0) * width + (cx | 0);
        if (depth >= depths[p]) continue;
        depths[p] = depth;
        pixels[p] = colour;
        continue;
      }
      this.drawSquare(cx, cy, half, width, height, depth, colour);
    }
  }

  /** The pixels whose middles are within the square. */
  private drawSquare(
    cx: number,
    cy: number,
    half: number,
    width: number,
    height: number,
    depth: number,
    colour: number,
  ): void {
    const left = Math.max(0, Math.ceil(cx - 0.5 - half)),
      right = Math.min(width, Math.ceil(cx - 0.5 + half));
    const bottom = Math.max(0, Math.ceil(cy - 0.5 - half)),
      top = Math.min(height, Math.ceil(cy - 0.5 + half));
    const {pixels, depths} = this;
    for (let py = bottom; py < top; ++py) {
      for (let p = py * width + left, last = py * width + right; p < last; ++p) {
        if (depth >= depths[p]) continue;
        depths[p] = depth;
        pixels[p] = colour;
      }
    }
  }
}
