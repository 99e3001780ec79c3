// Lines between nodes (src/monitor/page/edges.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';
import {alignment, registration, state} from './states.mjs';

const {edgeIn, edgeOfRegistration, edgesOf} = await pageModule(process.argv[2], 'edges');
const fleet = state({
  alignments: [
    alignment('r1#0', 'r2#0', 'used'),
    alignment('r1#1', 'r2#1', 'against_others'),
    alignment('r1#1', 'r2#1', 'used'),
  ],
  registrations: [
    registration('r1#1', 'r2#1', 'rejected'),
    registration('r1#1', 'r2#1', 'accepted', {alignment: 1}),
    registration('r1#0', 'r2#0', 'accepted', {by: 'r2'}),
    registration('r1#1', 'r2#1', 'ambiguous', {alignment: 2}),
    registration('r1#0', 'r2#1', 'failed'),
  ],
});

// An alignment is joined with the registration that it came of, also where its pair was registered again.
const edges = edgesOf(fleet);
assert.deepEqual(edges, [
  {kind: 'used', a: 'r1#0', b: 'r2#0', alignment: 0, registration: undefined},
  {kind: 'unused', a: 'r1#1', b: 'r2#1', alignment: 1, registration: 1},
  {kind: 'used', a: 'r1#1', b: 'r2#1', alignment: 2, registration: 3},
  {kind: 'rejected', a: 'r1#1', b: 'r2#1', registration: 0},
  {kind: 'rejected', a: 'r1#0', b: 'r2#1', registration: 4},
]);

// The panel's registrations have the same edges, without a map.
for (const edge of edges)
  if (edge.registration !== undefined) assert.deepEqual(edgeOfRegistration(fleet, edge.registration), edge);
assert.deepEqual(edgeOfRegistration(fleet, 2), {kind: 'unused', a: 'r1#0', b: 'r2#0', registration: 2});

// Each edge is found again in a newer state, whose lists grew in front, and in none where it is gone.
const grown = state({
  alignments: [alignment('r0#0', 'r1#0', 'used'), ...fleet.alignments],
  registrations: [
    registration('r0#0', 'r1#0', 'accepted', {alignment: 0}),
    ...fleet.registrations.map((one) => ({...one, alignment: one.alignment === null ? null : one.alignment + 1})),
  ],
});
const grew = (index) => (index === undefined ? undefined : index + 1);
for (const edge of edges) {
  const {kind, a, b} = edge;
  const found = edgeIn(grown, fleet, edge);
  const numbers = {alignment: grew(edge.alignment), registration: grew(edge.registration)};
  assert.deepEqual({alignment: undefined, ...found}, {kind, a, b, ...numbers});
  assert.equal(edgeIn(state(), fleet, edge), undefined);
}

// Ten thousand alignments and registrations take no time to speak of: each is visited once.
let reads = 0;
const many = Array.from({length: 10_000}, (_, k) =>
  Object.defineProperty(registration(`r1#${k}`, 'r2#0', 'accepted'), 'alignment', {get: () => (++reads, k)}),
);
edgesOf(state({alignments: many.map(({target}) => alignment(target, 'r2#0', 'used')), registrations: many}));
assert.ok(reads <= 2 * many.length, `${reads} reads`);
