// Words and numbers for people (src/monitor/page/model.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';
import {pair, registration, robot, state} from './states.mjs';

const page = await pageModule(process.argv[2], 'model');
const {ago, bytes, colourOf, comparable, count, duration, findPair, linkName, metres, placeMark} = page;
const {registrationKeys, sigmasOf} = page;
const table = (act, cases) => {
  for (const [value, words] of cases) assert.equal(act(value), words, `${act.name}(${value})`);
};
table(duration, [
  [0, '0:00'],
  [59.6, '1:00'],
  [61, '1:01'],
  [3725, '1:02:05'],
]);
table(count, [
  [999, '999'],
  [1234, '1,234'],
  [12_345, '12 k'],
  [1_234_567, '1.23 M'],
]);
table(metres, [
  [0.123, '0.12 m'],
  [10, '10.0 m'],
  [1234, '1.23 km'],
]);
for (const none of [null, undefined, NaN, Infinity]) assert.equal(metres(none), 'an unknown length');
table(bytes, [
  [950, '950 B'],
  [1200, '1.2 kB'],
  [3_400_000, '3.4 MB'],
]);
table(ago, [
  [3.4, '3 s'],
  [250, '4:10 min'],
  [3725, '1:02:05 h'],
]);
assert.deepEqual(['long_range', 'short_range'].map(linkName), ['radio', 'Wi-Fi']);

// Coordinates count where something ties a frame to a place on Earth, distances also within one component.
assert.equal(placeMark(robot('r1')), '');
assert.equal(placeMark(robot('r1', {nodes: 0, sessions_not_georeferenced: 1})), '', 'nothing of it is drawn');
assert.equal(placeMark(robot('r1', {sessions_not_georeferenced: 1})), 'not georeferenced');
assert.equal(
  placeMark(robot('r1', {sessions: 3, sessions_not_georeferenced: 2})),
  '2 of 3 sessions not georeferenced',
);
assert.ok(comparable({}, {}) && comparable({floating: 0}, {floating: 0}));
assert.ok(!comparable({}, {floating: 0}) && !comparable({floating: 1}, {floating: 0}));

assert.equal(colourOf(state(), 'r2'), '#d05a1b');
assert.match(colourOf(state(), 'stranger'), /^#/);

const pairs = state({pairs: [pair('r1', 'r2', true), pair('r1', 'r3', false)]});
assert.equal(findPair(pairs, 'r3', 'r1'), pairs.pairs[1]);
assert.equal(findPair(pairs, 'r2', 'r3'), undefined);

// A registration keeps its name when more of other robots come before it; a pair registered again has one more.
const one = registration('r1#0', 'r2#0', 'rejected'),
  names = (...registrations) => registrationKeys(state({registrations}));
assert.equal(names(registration('r1#1', 'r2#0', 'accepted'), one)[1], names(one)[0]);
assert.equal(new Set(names(one, one, {...one, by: 'r2'})).size, 3);

// Submaps take the sigma of the node before them, or the first one that is known; other robots' do not count.
const sigmas = sigmasOf([
  {id: 'r1#0', robot: 'r1'},
  {id: 'r1#1', robot: 'r1', sigma_m: 0.2},
  {id: 'r2#0', robot: 'r2'},
  {id: 'r1#2', robot: 'r1', sigma_m: null},
  {id: 'r1#3', robot: 'r1', sigma_m: 0.7},
]);
assert.deepEqual(Object.fromEntries(sigmas), {'r1#0': 0.2, 'r1#1': 0.2, 'r1#2': 0.2, 'r1#3': 0.7});
