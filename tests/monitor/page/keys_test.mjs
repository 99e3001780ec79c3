// Keys of the map (src/monitor/page/keys.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {actOnKey} = await pageModule(process.argv[2], 'keys');
const calls = [];
const note =
  (name) =>
  (...values) =>
    void calls.push([name, ...values]);
const eye = {planar: false, turn: note('turn'), pan: note('pan'), zoom: note('zoom')};
const acts = Object.fromEntries(
  ['fit', 'setPlanar', 'measure', 'pick', 'step', 'end'].map((name) => [name, note(name)]),
);
let prevented = 0;
/** The calls that a key makes. */
const press = (key, more = {}) => {
  const acted = actOnKey({key, preventDefault: () => ++prevented, ...more}, eye, acts);
  assert.equal(acted, calls.length > 0, key);
  return calls.splice(0);
};

assert.deepEqual(press('ArrowLeft'), [['pan', -1, 0]]);
assert.deepEqual(press('ArrowUp'), [['pan', 0, 1]]);
const [[name, left, up]] = press('ArrowLeft', {shiftKey: true});
assert.ok(name === 'turn' && left < 0 && up === 0);
const [[, none, down]] = press('ArrowUp', {shiftKey: true});
assert.ok(none === 0 && down < 0);
assert.deepEqual(press('+', {shiftKey: true}), [['zoom', 1.25]], 'plus needs Shift on many keyboards');
assert.deepEqual(press('p'), [['setPlanar', true]]);
for (const [key, act] of [
  ['f', 'fit'],
  ['m', 'measure'],
  ['Enter', 'pick'],
  ['Escape', 'end'],
])
  assert.deepEqual(press(key), [[act]]);
assert.deepEqual(
  [...press('n'), ...press('b')],
  [
    ['step', 1],
    ['step', -1],
  ],
);

// Keys of the browser and Tab stay the browser's.
const before = prevented;
for (const key of ['x', 'Tab', ' ']) assert.deepEqual(press(key), []);
for (const modifier of ['ctrlKey', 'metaKey', 'altKey']) assert.deepEqual(press('f', {[modifier]: true}), []);
assert.equal(prevented, before);
