// Lines drawn by the CPU (src/monitor/page/cpu_lines.ts), pixel by pixel.
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {drawStrokes} = await pageModule(process.argv[2], 'cpu_lines');
const {Matrix4, OrthographicCamera, PerspectiveCamera} = await three(process.argv[2]);
const kSize = 32;

/** The matrix of an eye 10 m above a square of 32 m, a pixel a metre, y up; or of one that looks north along it. */
const above = () => {
  const camera = new OrthographicCamera(0, kSize, kSize, 0, 1, 100);
  camera.position.set(0, 0, 10);
  camera.updateMatrixWorld();
  return new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
};
const northward = () => {
  const camera = new PerspectiveCamera(90, 1, 0.5, 100);
  camera.up.set(0, 0, 1);
  camera.lookAt(0, 1, 0);
  camera.updateMatrixWorld();
  return new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
};
/** The pixels [x, y] that strokes set, with their colours. */
function drawn(VP, strokes, ratio = 1) {
  const colours = new Uint32Array(kSize * kSize);
  drawStrokes({colours, width: kSize, height: kSize}, VP, strokes, ratio);
  const set = new Map();
  colours.forEach((colour, k) => colour && set.set(`${k % kSize},${Math.floor(k / kSize)}`, colour));
  return set;
}
const stroke = (ends, width = 1, colour = 7) => ({ends, width, colour});

// A segment covers its length, and half a width beyond each end, by its width, along either axis and either way.
for (const ends of [
  [4, 10, 0, 12, 10, 0],
  [12, 10, 0, 4, 10, 0],
]) {
  const across = drawn(above(), [stroke(ends, 2)]);
  assert.equal(across.size, 2 * 10);
  for (let x = 3; x < 13; ++x) for (const y of [9, 10]) assert.ok(across.has(`${x},${y}`), `${x}, ${y}`);
  const [ax, ay, , bx, by] = ends;
  const up = drawn(above(), [stroke([ay, ax, 0, by, bx, 0], 2)]);
  assert.deepEqual(new Set([...up.keys()].map((key) => key.split(',').reverse().join())), new Set(across.keys()));
}

// One across both axes has no gap and is as wide as the others.
const slanted = drawn(above(), [stroke([2, 3, 0, 26, 19, 0], 3)]);
for (let k = 0; k <= 100; ++k) {
  const at = [2 + 0.24 * k, 3 + 0.16 * k].map(Math.floor).join();
  assert.ok(slanted.has(at), at);
}
const area = 3 * (Math.hypot(24, 16) + 3);
assert.ok(Math.abs(slanted.size - area) < 0.08 * area, `${slanted.size} pixels, not ${area}`);

// Widths are of the page; a thin one is not lost in a picture of fewer pixels.
assert.equal(drawn(above(), [stroke([4, 10, 0, 12, 10, 0], 4)], 0.5).size, 2 * 10);
assert.ok(drawn(above(), [stroke([4, 10, 0, 12, 10, 0], 1)], 0.25).size >= 8);

// A later stroke lies above, and one that leaves the picture ends at its edge.
const crossed = drawn(above(), [stroke([0, 16, 0, 32, 16, 0], 2, 1), stroke([16, -900, 0, 16, 900, 0], 2, 2)]);
assert.equal(crossed.get('16,16'), 2);
assert.equal(crossed.get('4,16'), 1);
assert.equal([...crossed.values()].filter((colour) => colour === 2).length, 2 * kSize);
assert.equal(drawn(above(), [stroke([50, 40, 0, 90, 90, 0], 5)]).size, 0);

// A segment that passes the eye is drawn as far as it is in front, one behind the eye is not.
const passing = drawn(northward(), [stroke([0, 20, -2, 0, -20, -2], 1)]);
assert.ok(passing.size >= 13 && passing.size <= 16, `${passing.size} pixels`);
assert.ok(
  [...passing.keys()].every((key) => Number(key.split(',')[1]) < kSize / 2),
  'it lies below the horizon',
);
assert.equal(drawn(northward(), [stroke([0, -1, -2, 0, -20, -2], 1)]).size, 0);
