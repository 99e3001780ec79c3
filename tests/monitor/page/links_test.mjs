// Links between robots in words (src/monitor/page/links.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';
import {live, robotNow} from './states.mjs';

const {linksOf} = await pageModule(process.argv[2], 'links');
const peer = (robot, link, loss) => ({robot, link, received: 100, loss, delay_s: null});
const heard = (...seconds) =>
  seconds.map((seconds_ago, k) => ({link: k === 0 ? 'long_range' : 'short_range', seconds_ago}));
const base = live([
  robotNow('r1'),
  robotNow('r2', {heard: heard(2, 30)}),
  robotNow('r3', {heard: heard(3)}),
  robotNow('r4', {heard: heard(25)}),
  robotNow('r5', {heard: heard(70)}),
  robotNow('r6', {heard: heard(1)}),
  robotNow('r7'),
]);
base.radio.peers = [
  peer('r2', 'long_range', 0.4),
  peer('r2', 'short_range', 0.011),
  peer('r3', 'long_range', 0.25),
  peer('r5', 'long_range', 0),
];
const words = (later) => linksOf(base, later).map(({robot, quality, text}) => `${robot} ${quality} ${text}`);

// The better link counts; silence counts more than the loss of what was received before; nobody links to itself.
assert.deepEqual(words(0), [
  'r2 good Wi-Fi, 1.1 % lost',
  'r3 poor radio, 25 % lost',
  'r4 poor heard 25 s ago',
  'r5 silent silent for 70 s',
  'r6 good heard 1 s ago',
]);
// A status that nothing follows turns all links silent.
assert.ok(linksOf(base, 61).every((one) => one.quality === 'silent'));
