// Times of the mission without long gaps (src/monitor/page/times.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';
import {node, radioHistory, state} from './states.mjs';

const {cutGaps, gapNote} = await pageModule(process.argv[2], 'times');
const of = (...times) => state({nodes: times.map((t, k) => ({...node('r1', k), t}))});
const day = 86_400;

// A node of 1970 among those of today: the rest of the mission keeps its times, order stays.
const jumped = of(20_000 * day, 20_000 * day + 60, 0, 20_000 * day + 3600);
assert.equal(cutGaps(jumped), 20_000 * day - 60);
assert.deepEqual(
  jumped.nodes.map((one) => one.t),
  [60, 120, 0, 3660],
);
assert.equal(jumped.nodes[1].stamp_s, 20_000 * day + 60, 'its card tells the time that it carries');
assert.match(gapNote(20_000 * day - 60), /^20,000 days without any node/);

// Two gaps, and none.
const missions = of(0, 10, 2 * day, 2 * day + 5, 9 * day);
cutGaps(missions);
assert.deepEqual(
  missions.nodes.map((one) => one.t),
  [0, 10, 70, 75, 135],
);
const usual = of(5, 0, day);
assert.equal(cutGaps(usual), 0);
assert.deepEqual(
  usual.nodes.map((one) => [one.t, one.stamp_s]),
  [
    [5, undefined],
    [0, undefined],
    [day, undefined],
  ],
);
assert.equal(cutGaps(of()), 0);

// The radio's times are those of the slider only where nothing is left out.
for (const [times, begin] of [
  [[0, day], 7],
  [[0, 2 * day], undefined],
]) {
  const run = {...of(...times), radio: radioHistory({begin_s: 7})};
  cutGaps(run);
  assert.equal(run.radio.begin_s, begin);
}
