// Ramps of colours (src/monitor/page/ramp.ts).
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {rampOf, shaded, tonesOf, turbo, turboTexture} = await pageModule(process.argv[2], 'ramp');
const {Color} = await three(process.argv[2]);

// From blue over green to red without a jump, as Turbo goes.
const largest = (x) => turbo(x).indexOf(Math.max(...turbo(x)));
assert.deepEqual([0.2, 0.5, 0.85].map(largest), [2, 1, 0]);
for (let k = 0; k < 255; ++k) {
  const step = turbo((k + 1) / 255).map((one, c) => Math.abs(one - turbo(k / 255)[c]));
  assert.ok(Math.max(...step) < 0.06, `a jump at ${k}`);
}

// A robot's colour becomes lighter with height and stays its own; on a light map it never becomes lighter than it is.
const blue = new Color(0.2, 0.4, 0.9);
for (const dark of [true, false]) {
  const tones = tonesOf(dark);
  const [low, high] = [shaded(blue, 0, tones), shaded(blue, 1, tones)];
  assert.ok(low.every((one, k) => one < high[k]));
  for (const height of [0, 0.5, 1])
    assert.equal(Math.max(...shaded(blue, height, tones)), shaded(blue, height, tones)[2]);
  assert.equal(high[0] > 0.2 + 1e-9, dark);
}

const bytes = rampOf((x) => [x, 1 - x, 0]);
assert.equal(bytes.length, 4 * 256);
assert.deepEqual([...bytes.slice(0, 4)], [0, 255, 0, 255]);
assert.deepEqual([...bytes.slice(-4)], [255, 0, 0, 255]);
assert.equal(bytes[4 * 100], 100);
assert.deepEqual(turboTexture().image.data, rampOf(turbo));
