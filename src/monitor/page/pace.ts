/** A way to draw. */
export interface Effort {
  shaded: boolean; // points
  detailed: boolean; // nodes, and lines with an edge
  ratio: number; // device pixels per pixel of the page
  share: number; // of the points
}

const kSlow_ms = 33; // 30 frames/s
const kFast_ms = 18;
const kGoal_ms = 25;
const kSteady = 8; // fast frames before the effort grows
const kLevels = 4;
const kSlowLevel = 2;
const kMinShare = 1 / 4;
const kCoarse = [0.6, 0.5]; // of levels 2 and 3: pixels that are drawn along a side, of those that there are
export const kStill_ms = 180; // without a change: the view stands still
const kStillShare = 1 / 4; // of the time that drawing a still view may take
const kMaxRest_ms = 1000;

/**
 * Chooses the effort of a picture: all of it while the view stands still. While it moves and frames take longer than
 * 33 ms, first the shading is left out, then the finer pixels, the nodes and the page's marks on the map, then
 * points; each submap then shows its coarser ones. If drawing costs little, as with a graphics card, nothing changes.
 * Pictures of what arrives while the view stands still leave three quarters of the time to the rest of the page.
 */
export class Pace {
  private level: number; // 1: without shading; 2, 3: with fewer pixels and no nodes; 4: and with a share of the points
  private share = 1;
  private fast = 0;
  private last?: number;
  private restsUntil = 0; // ms

  /**
   * `minShare`: share of the points that is drawn however long a frame takes. `slow`: frames will take long, so the
   * first ones that move are drawn with less effort, too.
   */
  constructor(
    private full: Effort,
    private minShare = kMinShare,
    slow = false,
  ) {
    this.level = slow ? kSlowLevel : 0;
  }

  /** The effort of the frame at `now`, ms. */
  effort(now: number, moving: boolean): Effort {
    if (!moving) {
      this.last = undefined;
      return this.full;
    }
    if (this.last !== undefined) this.adapt(now - this.last);
    this.last = now;
    if (this.level === 0) return this.full;
    const ratio = Math.min(1, this.full.ratio);
    return {
      shaded: false,
      detailed: this.level < 2,
      ratio: this.level < 2 ? ratio : kCoarse[Math.min(this.level - 2, 1)] * ratio,
      share: this.share,
    };
  }

  /** A picture of a view that stands still was drawn from `began` to `ended`, ms. */
  drewStill(began: number, ended: number): void {
    this.restsUntil = ended + Math.min(kMaxRest_ms, (ended - began) * (1 / kStillShare - 1));
  }

  /** Time until the next picture of a view that stands still, ms. */
  rest(now: number): number {
    return Math.max(0, this.restsUntil - now);
  }

  /** To a frame that took so many ms. */
  private adapt(step: number): void {
    this.fast = step < kFast_ms ? this.fast + 1 : 0;
    if (step > kSlow_ms) {
      if (this.level === kLevels) this.share = Math.max(this.minShare, this.share * Math.max(0.5, kGoal_ms / step));
      this.level = Math.min(kLevels, this.level + 1);
    } else if (this.fast >= kSteady) {
      this.fast = 0;
      this.share *= 1.3;
      if (this.share < 1) return;
      this.share = 1;
      this.level = Math.max(0, this.level - 1);
    }
  }
}

/** All points are drawn while the view moves, too, if the page's address has `share=all`. */
export const drawnShare = () => (new URLSearchParams(location.search).get('share') === 'all' ? 1 : kMinShare);

/** Whether WebGL draws on the CPU, where each sample of a pixel costs as much as the first. */
export function drawsOnCpu(): boolean {
  const wanted = new URLSearchParams(location.search).get('points');
  if (wanted) return wanted === 'cpu';
  const gl = document.createElement('canvas').getContext('webgl2');
  const info = gl?.getExtension('WEBGL_debug_renderer_info');
  const name = gl && info ? String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)) : '';
  gl?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
