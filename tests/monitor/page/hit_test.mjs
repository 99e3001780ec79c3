// The choice under the pointer (src/monitor/page/hit.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {hitAt} = await pageModule(process.argv[2], 'hit');
const nodes = new Map([
  ['a', {x: 10, y: 10}],
  ['b', {x: 110, y: 10}],
  ['behind', undefined],
  ['c', {x: 14, y: 10}],
]);
const ab = {kind: 'used', a: 'a', b: 'b'};
const edges = [{kind: 'used', a: 'a', b: 'behind'}, {kind: 'used', a: 'a', b: 'gone'}, ab];
const at = (x, y, shown = true, reach = 10) => hitAt({x, y}, nodes, shown, edges, reach);

assert.deepEqual(at(11, 10), {node: 'a'});
assert.deepEqual(at(13, 10), {node: 'c'}, 'the nearest one');
assert.deepEqual(at(60, 15), {edge: ab}, 'beside the middle of the line');
assert.deepEqual(at(11, 10, false), {edge: ab}, 'nodes that are hidden are not chosen');
assert.deepEqual(at(19, 10), {node: 'c'}, 'a node goes before the line that it lies on');
assert.equal(at(60, 21), undefined);
assert.equal(at(125, 10), undefined, 'a line ends at its nodes');
assert.equal(at(11, 10, true, 0.5)?.node, undefined);

// A trajectory comes last.
const steps = [
  ['a', 'behind'],
  ['a', 'b'],
];
assert.deepEqual(hitAt({x: 60, y: 15}, nodes, true, [], 10, steps), {node: 'a', next: 'b'});
assert.deepEqual(hitAt({x: 60, y: 15}, nodes, true, edges, 10, steps), {edge: ab});
assert.deepEqual(hitAt({x: 11, y: 10}, nodes, true, [], 10, steps), {node: 'a'});
const dot = {kind: 'used', a: 'a', b: 'a'};
assert.deepEqual(hitAt({x: 12, y: 10}, nodes, false, [dot], 10), {edge: dot}, 'also one without length');
