// Two clouds alone on the map (src/monitor/page/pair_view.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {alignment, node, registration, state} from './states.mjs';

await openPage(process.argv[2]);
const {PairView} = await pageModule(process.argv[2], 'pair_view');
const at = (x) => [x, 0, 0, 0, 0, 0, 1];
const fleet = state({
  nodes: [node('r1', 0, [5, 0, 0], {gps: at(1)}), node('r2', 0, [9, 0, 0], {gps: at(4)}), node('r3', 0, [7, 0, 0])],
  alignments: [alignment('r1#0', 'r2#0', 'used', {poses: [at(2), at(3)], modes: 2})],
  registrations: [registration('r1#0', 'r3#0', 'rejected', {pose: at(8)})],
});
const submap = (hash) => ({
  hash,
  move(T) {
    this.at = T && T.elements[12];
  },
  tint(colour) {
    this.colour = colour;
  },
});
const submaps = new Map(fleet.nodes.map((one) => [one.submap, submap(one.submap)]));
let only = new Set();
const view = new PairView({submaps: {all: submaps}, showOnly: (hashes) => (only = hashes)});
const [r1, r2, r3] = fleet.nodes.map((one) => submaps.get(one.submap));

// The source is drawn where the target's pose and each transform put it; the target stays.
const edge = {kind: 'used', a: 'r1#0', b: 'r2#0', alignment: 0};
const box = view.buttons(fleet, edge);
const buttons = [...box.querySelectorAll('button')];
assert.deepEqual(buttons.map(textOf), ['as placed', 'before, by GPS', 'pose 1', 'pose 2']);
const places = buttons.map((button) => {
  button.click();
  assert.deepEqual(
    buttons.filter((one) => one.getAttribute('aria-pressed') === 'true'),
    [button],
  );
  return r2.at;
});
assert.deepEqual(places, [undefined, 5 + 3, 5 + 2, 5 + 3]);
assert.equal(r1.at, undefined);
assert.deepEqual([...only], [r1.hash, r2.hash]);
assert.ok(r1.colour && r2.colour && r1.colour !== r2.colour);

view.end();
assert.equal(only, undefined);
assert.deepEqual([r1.colour, r2.colour, r2.at], [undefined, undefined, undefined]);

// A rejected one has the pose that was rejected, and no GPS where a node has none.
const rejected = view.buttons(fleet, {kind: 'rejected', a: 'r1#0', b: 'r3#0', registration: 0});
assert.deepEqual([...rejected.querySelectorAll('button')].map(textOf), ['as placed', 'as rejected']);
[...rejected.querySelectorAll('button')][1].click();
assert.equal(r3.at, 13);
submaps.delete(fleet.nodes[2].submap);
assert.equal(
  view.buttons(fleet, {kind: 'rejected', a: 'r1#0', b: 'r3#0', registration: 0}),
  null,
  'its cloud is not here',
);
