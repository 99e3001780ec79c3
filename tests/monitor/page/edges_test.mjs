// Lines between nodes (src/monitor/page/edges.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';
import {alignment, registration, state} from './states.mjs';

const {edgesOf} = await pageModule(process.argv[2], 'edges');
const edges = edgesOf(
  state({
    alignments: [alignment('r1#0', 'r2#0', 'used'), alignment('r1#1', 'r2#1', 'against_others')],
    registrations: [
      registration('r1#1', 'r2#1', 'rejected'),
      registration('r1#1', 'r2#1', 'accepted'),
      registration('r1#0', 'r2#0', 'accepted', {by: 'r2'}),
      registration('r1#0', 'r2#1', 'failed'),
    ],
  }),
);

// An alignment is joined with the registration that made it: of the same nodes and robot, and not a rejected one.
assert.deepEqual(edges, [
  {kind: 'used', a: 'r1#0', b: 'r2#0', alignment: 0, registration: undefined},
  {kind: 'unused', a: 'r1#1', b: 'r2#1', alignment: 1, registration: 1},
  {kind: 'rejected', a: 'r1#1', b: 'r2#1', registration: 0},
  {kind: 'rejected', a: 'r1#0', b: 'r2#1', registration: 3},
]);
