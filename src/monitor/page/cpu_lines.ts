/** Segments of one colour. */
export interface Stroke {
  ends: number[]; // x, y, z of both ends of each segment
  colour: number; // as the bytes of a pixel lie in memory
  width: number; // pixels of the page
}

/** A picture that the CPU draws: rows from the bottom up. */
export interface Pixels {
  colours: Uint32Array;
  width: number;
  height: number;
}

const kNear = 0.01; // w of an end behind the eye, which is moved there

/**
 * Draws segments over a picture, in front of everything, as WideLines does. WebGL that runs on the CPU takes some
 * 10 microseconds a segment, this a tenth of that.
 *
 * `VP`: from the world to clip space, by columns. `ratio`: pixels here per pixel of the page.
 */
export function drawStrokes(picture: Pixels, VP: number[], strokes: Stroke[], ratio: number): void {
  const {width, height} = picture;
  for (const {ends, colour, width: wide} of strokes) {
    const thick = Math.max(1, wide * ratio);
    for (let k = 0; k < ends.length; k += 6) {
      let [ax, ay, aw] = clipped(VP, ends, k),
        [bx, by, bw] = clipped(VP, ends, k + 3);
      if (aw < kNear && bw < kNear) continue;
      if (aw < kNear || bw < kNear) {
        const t = (kNear - aw) / (bw - aw),
          x = ax + t * (bx - ax),
          y = ay + t * (by - ay);
        if (aw < kNear) [ax, ay, aw] = [x, y, kNear];
        else [bx, by, bw] = [x, y, kNear];
      }
      drawSegment(
        picture,
        [(0.5 + (0.5 * ax) / aw) * width, (0.5 + (0.5 * ay) / aw) * height],
        [(0.5 + (0.5 * bx) / bw) * width, (0.5 + (0.5 * by) / bw) * height],
        thick,
        colour,
      );
    }
  }
}

/** x, y and w of the point at `k` in clip space. */
function clipped(VP: number[], points: number[], k: number): [number, number, number] {
  const x = points[k],
    y = points[k + 1],
    z = points[k + 2];
  return [
    VP[0] * x + VP[4] * y + VP[8] * z + VP[12],
    VP[1] * x + VP[5] * y + VP[9] * z + VP[13],
    VP[3] * x + VP[7] * y + VP[11] * z + VP[15],
  ];
}

type Pixel = [number, number];

/** Steps along the axis on which the segment is longer; at each step the pixels of its width across are set. */
function drawSegment({colours, width, height}: Pixels, a: Pixel, b: Pixel, thick: number, colour: number): void {
  const along = Math.abs(b[0] - a[0]) >= Math.abs(b[1] - a[1]) ? 0 : 1,
    across = 1 - along;
  const [low, high] = a[along] < b[along] ? [a, b] : [b, a];
  const length = high[along] - low[along],
    slope = length > 0 ? (high[across] - low[across]) / length : 0;
  const half = 0.5 * thick * Math.hypot(1, slope);
  const ends = [width, height];
  const stride = along === 0 ? 1 : width,
    step = along === 0 ? width : 1;
  // Half a width beyond each end, so that pieces of a path meet.
  const first = Math.max(0, Math.ceil(low[along] - 0.5 * thick - 0.5)),
    last = Math.min(ends[along] - 1, Math.floor(high[along] + 0.5 * thick - 0.5));
  for (let k = first; k <= last; ++k) {
    const middle = low[across] + slope * (k + 0.5 - low[along]);
    const from = Math.max(0, Math.ceil(middle - half - 0.5)),
      to = Math.min(ends[across], Math.ceil(middle + half - 0.5));
    for (let p = from; p < to; ++p) colours[stride * k + step * p] = colour;
  }
}
