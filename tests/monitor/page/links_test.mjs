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

// A run has links between all robots at a time: over Wi-Fi while that is heard, by the worse of both ways.
const heardAt = (from, to, link, loss_in) => heardLink(from, to, link, 300, {loss_in});
const history = radioHistory({
  begin_s: 10,
  steps: 300,
  traces: ['r1', 'r2', 'r3'],
  links: [
    heardAt('r1', 'r2', 'long_range', {0: 0.5, 5: 0.25, 8: 0}),
    heardAt('r2', 'r1', 'long_range', {0: 0, 5: 0.012, 8: 0}),
    heardAt('r1', 'r2', 'short_range', {7: 0.3, 9: 1, 30: 0.004}),
    heardAt('r2', 'r1', 'short_range', {7: 0, 9: 1, 30: 0}),
    heardAt('r3', 'r2', 'long_range', {200: 0.3, 220: 1}),
    heardAt('r2', 'r3', 'long_range', {200: 0, 221: 0}),
    heardAt('r4', 'r1', 'long_range', {280: 0}),
  ],
});
const at = (t) => linksAt(history, t).map(({from, to, quality, text}) => `${from}-${to} ${quality} ${text}`);
assert.deepEqual(at(9), [], 'nobody logged anything yet');
assert.deepEqual(at(10), ['r1-r2 poor radio, 50 % lost']);
assert.deepEqual(at(15), ['r1-r2 poor radio, 25 % lost']);
assert.deepEqual(at(17.5), ['r1-r2 poor Wi-Fi, 30 % lost'], 'the radio is as good, but Wi-Fi is heard');
assert.deepEqual(at(19), ['r1-r2 good radio, 0.0 % lost'], 'the Wi-Fi fell silent, the radio did not');
assert.deepEqual(at(29), ['r1-r2 good radio, 0.0 % lost, heard 11 s before']);
assert.deepEqual(at(46), ['r1-r2 good Wi-Fi, 0.4 % lost']);
assert.deepEqual(at(47), ['r1-r2 good radio, 0.0 % lost, heard 29 s before'], 'Wi-Fi is silent for too long');
assert.deepEqual(at(83), ['r1-r2 good radio, 0.0 % lost, heard 65 s before'], 'robots may be quiet on the radio');
assert.deepEqual(at(84), [], 'nothing was heard for too long');
assert.deepEqual(at(210), ['r3-r2 poor radio, 30 % lost']);
assert.deepEqual(at(231), ['r2-r3 poor radio, r3 alone hears the other'], 'r3 fell silent');
assert.deepEqual(at(290), ['r2-r3 poor radio, r3 alone hears the other', 'r4-r1 good radio, 0.0 % lost']);
assert.deepEqual(linksAt({...history, begin_s: undefined}, 15), [], 'of another time than the nodes');
assert.deepEqual(at(400), [], 'the trace is over');

// In a long run a step is longer than a robot may be silent: the step before counts, too.
const long = radioHistory({
  begin_s: 0,
  step_s: 40,
  steps: 300,
  traces: ['r1'],
  links: [heardAt('r2', 'r1', 'short_range', {3: 0})],
});
const texts = (t) => linksAt(long, t).map(({text}) => text);
assert.deepEqual(texts(119), []);
assert.deepEqual(texts(121), ['Wi-Fi, 0.0 % lost']);
assert.deepEqual(texts(161), ['Wi-Fi, 0.0 % lost, heard 40 s before']);
assert.deepEqual(texts(201), []);
