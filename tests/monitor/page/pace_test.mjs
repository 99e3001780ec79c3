// The page's effort while the view moves (src/monitor/page/pace.ts).
//   node pace_test.mjs PAGE_FOLDER
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {drawnShare, Pace} = await pageModule(process.argv[2], 'pace');
const full = {shaded: true, detailed: true, ratio: 2, share: 1};
let now = 0;
/** The efforts of so many frames while the view moves, `step` ms apart. */
const frames = (pace, count, step) =>
  Array.from({length: count}, () => pace.effort((now += typeof step === 'function' ? step() : step), true));

// A graphics card draws all of it, however long the view moves, and so does a view that stands still.
const card = new Pace(full);
for (const effort of frames(card, 200, 16.7)) assert.deepEqual(effort, full);
assert.deepEqual(card.effort((now += 5000), false), full);

// Slow frames leave out the shading first, then pixels, and points last; what is left out comes back when the view
// stands still.
const slow = new Pace(full);
const efforts = frames(slow, 12, 100);
assert.deepEqual(efforts[0], full, 'the first frame tells nothing of its time');
assert.deepEqual(efforts[1], {shaded: false, detailed: true, ratio: 1, share: 1});
assert.ok(!efforts[2].shaded && !efforts[2].detailed && efforts[2].ratio < 1 && efforts[2].share === 1);
assert.ok(efforts[3].ratio < efforts[2].ratio && efforts[3].share === 1, 'pixels before points');
assert.ok(efforts.at(-1).share < 1 && efforts.at(-1).share >= 0.25, 'a picture of too few points shows nothing');
assert.deepEqual(slow.effort((now += 200), false), full);

// If WebGL is known to be slow, the first frame that moves has little effort; a still view and fast frames have all.
const software = new Pace(full, 0.25, true);
assert.deepEqual(software.effort((now += 100), false), full);
assert.ok(!frames(software, 1, 16)[0].detailed);
assert.deepEqual(frames(software, 40, 8).at(-1), full);

// A page that is to draw all points does so, however slow it is.
globalThis.location = {search: '?share=all'};
assert.ok(frames(new Pace(full, drawnShare()), 50, 200).every(({share}) => share === 1));
globalThis.location = {search: ''};
assert.equal(drawnShare(), 0.25);

// The time in which nothing moved is no slow frame.
now += 60_000;
for (const effort of frames(card, 5, 16)) assert.deepEqual(effort, full);

// A machine whose frames take 45 ms for all points and 5 ms for none comes to its 30 frames/s, and stays there.
const steady = new Pace(full);
let last = full;
const cost = () => 5 + (last.shaded ? 60 : 0) + 40 * last.share;
const times = [];
for (let k = 0; k < 300; ++k) {
  const step = cost();
  [last] = frames(steady, 1, step);
  times.push(step);
}
const mean = times.slice(20).reduce((sum, one) => sum + one, 0) / 280;
assert.ok(mean < 34, `a frame takes ${mean} ms`);
assert.ok(mean > 15, `points are left out for nothing: a frame takes ${mean} ms`);

// All is drawn again once it becomes faster.
assert.deepEqual(frames(steady, 400, 8).at(-1), full);

// Pictures of a view that stands still take a quarter of the time at most; a graphics card's do not wait a frame.
const still = new Pace(full);
assert.equal(still.rest(1000), 0);
still.drewStill(1000, 1080);
assert.equal(still.rest(1080), 240);
assert.equal(still.rest(1320), 0);
still.drewStill(3000, 5000);
assert.equal(still.rest(5000), 1000);
still.drewStill(7000, 7002);
assert.ok(still.rest(7002) < 16);
