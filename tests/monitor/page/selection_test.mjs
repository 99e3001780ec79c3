// The selection and its card (src/monitor/page/selection.ts).
import assert from 'node:assert/strict';
import {calls, FleetMap} from './fake_map.mjs';
import {openPage} from './fake_page.mjs';
import {pageModule, three} from './page_module.mjs';
import {alignment, node, registration, state} from './states.mjs';

await openPage(process.argv[2]);
const {Selection, edgeOfRegistration} = await pageModule(process.argv[2], 'selection', 'edges');
const {Vector3} = await three(process.argv[2]);
const map = new FleetMap();
const fleet = (more) => state({nodes: [node('r1', 0), node('r2', 0, [0, 8, 0])], ...more});
for (const {id, T} of fleet().nodes) map.places.set(id, new Vector3(...T));
const shown = [],
  marked = [];
const words = (content) => content && content.map((one) => one.textContent).join(' ');
const card = {
  show: (content, fromList) => shown.push(['show', words(content), fromList]),
  refresh: (content) => shown.push(['refresh', words(content)]),
};
const selection = new Selection(card, map, undefined, (index) => marked.push(index));
const told = (name) => calls.splice(0).filter(([one]) => one === name);
calls.length = 0;

// The map goes to what a list selects, and stays where it was for a click on it.
const before = fleet({registrations: [registration('r1#0', 'r2#0', 'rejected')]});
selection.select(before, {node: 'r2#0'});
assert.deepEqual(told('goTo'), []);
assert.equal(selection.node, 'r2#0');
selection.select(before, {edge: edgeOfRegistration(before, 0)}, true);
assert.deepEqual(told('goTo'), [['goTo', 0, 4, 0]]);
assert.deepEqual(marked, [0]);
assert.equal(selection.node, undefined);
assert.match(shown.at(-1)[1], /Rejected registration: r2#0 → r1#0/);

// A point of a submap, and the way from a node to the next.
selection.select(before, {node: 'r1#0', point: new Vector3(1, 2, 3)});
assert.match(shown.at(-1)[1], /Point of the submap of node r1#0.*1\.00, 2\.00, 3\.00/);
selection.select(before, {node: 'r1#0', next: 'r2#0'});
assert.match(shown.at(-1)[1], /Trajectory of r1.*8\.00.m/);
selection.select(before, {edge: edgeOfRegistration(before, 0)}, true);

// A newer state may list it elsewhere, and have changed what became of it.
const used = alignment('r1#0', 'r2#0', 'used');
const after = fleet({
  registrations: [
    registration('r1#0', 'r1#1', 'failed'),
    registration('r1#0', 'r2#0', 'accepted', {alignment: 0, sentence: 'the graph uses it'}),
  ],
  alignments: [used],
});
calls.length = 0;
selection.refresh(before, after);
assert.equal(shown.at(-1)[0], 'refresh');
assert.match(shown.at(-1)[1], /Alignment in use: r2#0 → r1#0 the graph uses it/);
assert.equal(told('select').at(-1)[1].edge.kind, 'used', 'its line has the colour of its new verdict');
assert.deepEqual([told('goTo'), marked], [[], [0, 0]]);

// One that is gone closes its card; without a selection nothing is shown.
selection.refresh(after, fleet());
assert.deepEqual(shown.at(-1), ['show', null, undefined]);
const n = shown.length;
selection.refresh(after, fleet());
assert.equal(shown.length, n);
