// Links between robots in words (src/monitor/page/links.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';
import {heardLink, live, radioHistory, robotNow} from './states.mjs';

const {linksAt, linksOf} = await pageModule(process.argv[2], 'links');
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
const words = (later) =>
  linksOf(base, later).map(({from, to, quality, text}) => `${from === 'r1' ? '' : from}${to} ${quality} ${text}`);

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

// A run has links between all robots at a time, by the better of both ways and media.
const history = radioHistory({
  begin_s: 10,
  steps: 200,
  links: [
    heardLink('r1', 'r2', 'long_range', 200, {loss_in: {0: 0.5, 5: 0.25}}),
    heardLink('r2', 'r1', 'long_range', 200, {loss_in: {5: 0.012}}),
    heardLink('r1', 'r2', 'short_range', 200, {loss_in: {7: 0, 9: 1, 30: 0}}),
    heardLink('r3', 'r2', 'long_range', 200, {loss_in: {100: 0.3, 120: 1}}),
  ],
});
const at = (t) => linksAt(history, t).map(({from, to, quality, text}) => `${from}-${to} ${quality} ${text}`);
assert.deepEqual(at(9), [], 'nobody logged anything yet');
assert.deepEqual(at(10), ['r1-r2 poor radio, 50 % lost']);
assert.deepEqual(at(15), ['r2-r1 good radio, 1.2 % lost']);
assert.deepEqual(at(17.5), ['r1-r2 good Wi-Fi, 0.0 % lost']);
assert.deepEqual(at(19), ['r2-r1 good radio, 1.2 % lost'], 'the Wi-Fi fell silent, the radio did not');
assert.deepEqual(at(46.5), ['r1-r2 good Wi-Fi, 0.0 % lost']);
assert.deepEqual(at(47), ['r2-r1 good radio, 1.2 % lost'], 'the Wi-Fi is silent for longer than it may be');
assert.deepEqual(at(80), ['r2-r1 good radio, 1.2 % lost'], 'robots may be quiet on the radio for a while');
assert.deepEqual(at(81), [], 'nothing was heard for too long');
assert.deepEqual(at(110), ['r3-r2 poor radio, 30 % lost']);
assert.deepEqual(at(130), [], 'it fell silent');
assert.deepEqual(linksAt({...history, begin_s: undefined}, 15), [], 'of another time than the nodes');
history.links[3].loss_in[199] = 0;
assert.deepEqual(at(Infinity), ['r3-r2 good radio, 0.0 % lost'], 'the end');
