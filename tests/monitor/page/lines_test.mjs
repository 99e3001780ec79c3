// Trajectories, edges and nodes (src/monitor/page/lines.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule, three} from './page_module.mjs';
import {node, state} from './states.mjs';

await openPage(process.argv[2]);
const {Lines, dashed, stepsOf} = await pageModule(process.argv[2], 'lines');
const {Scene, Vector3} = await three(process.argv[2]);
const scene = new Scene(),
  lines = new Lines(scene);
const nodes = [
  node('r1', 2, [20, 0, 0], {session: 1}),
  node('r1', 1, [10, 0, 0]),
  node('r1', 0),
  node('r1', 3, [30, 0, 0], {session: 1}),
  node('r2', 0, [0, 5, 0]),
].map((one) => ({node: one, p: new Vector3(...one.T)}));
const place = (id) => nodes.find(({node}) => node.id === id)?.p;
const edge = (kind, a, b) => ({kind, a, b});
const marks = (more) => ({state: state(), nodes, place, edges: [], paths: false, dots: false, ...more});
/** The segments of each line in the scene, as pairs of east coordinates and colours. */
const shown = () =>
  scene.children
    .filter((one) => one.isMesh)
    .map(({geometry, material}) => {
      const {array} = geometry.getAttribute('position');
      const ends = Array.from({length: array.length / 12}, (_, k) => [array[12 * k], array[12 * k + 6]]);
      return [material.uniforms.colour.value.getHexString(), ends];
    });

// A path goes from node to node in time, and not from one session to the next.
lines.show(marks({paths: true}));
const [border, path] = shown();
assert.deepEqual(path[1], [
  [0, 10],
  [20, 30],
]);
assert.deepEqual(border[1], path[1]);
assert.notEqual(path[0], border[0]);
assert.equal(shown().length, 2, 'r2 has no two nodes');

const ids = stepsOf(nodes).map((step) => step.map(({node}) => node.id));
assert.deepEqual(ids, [
  ['r1#0', 'r1#1'],
  ['r1#2', 'r1#3'],
]);

// Edges are dashed from end to end on a dark ground, trajectories are not and lie on a white one.
assert.deepEqual(
  dashed([0, 0, 0, 10, 5, 0], [2, 0.25]).map((v) => Math.round(100 * v) / 100),
  [0, 0, 0, 2, 1, 0, 8, 4, 0, 10, 5, 0],
);
lines.show(marks({edges: [edge('used', 'r1#1', 'r2#0')]}));
const [ground, dashes] = shown();
assert.equal(border[0], 'ffffff');
assert.notEqual(ground[0], border[0]);
assert.deepEqual([ground[1].length, dashes[1].length, path[1].length], [1, 5, 2]);

// Edges in use lie above those that are not, and those above rejected ones.
const edges = [edge('used', 'r1#0', 'r2#0'), edge('rejected', 'r1#1', 'r2#0'), edge('unused', 'r1#2', 'r2#0')];
lines.show(marks({edges}));
assert.deepEqual(
  shown().map(([, ends]) => ends[0][0]),
  [10, 10, 20, 20, 0, 0],
);
const orders = scene.children.map((one) => one.renderOrder);
assert.deepEqual(
  orders,
  [...orders].sort((a, b) => a - b),
);

// The selection stands out: an edge is drawn three times more, its nodes are larger.
lines.show(marks({edges, dots: true, selected: {edge: edges[0]}}));
assert.equal(shown().length, 9);
const dots = scene.children.at(-1);
assert.deepEqual([...dots.geometry.getAttribute('size').array], [8, 8, 16, 8, 16]);
assert.deepEqual([...dots.geometry.getAttribute('position').array.slice(0, 3)], [20, 0, 0]);
assert.ok(dots.renderOrder > Math.max(...shown().keys()), 'nodes lie above lines');
lines.show(marks({dots: true, selected: {node: 'r1#3'}}));
assert.deepEqual([...scene.children.at(-1).geometry.getAttribute('size').array], [8, 8, 8, 16, 8]);

// Without details: no nodes, and lines without white borders.
lines.show(marks({paths: true, dots: true}));
lines.detailed = false;
assert.deepEqual(
  scene.children.map((one) => one.visible),
  [false, true, false],
);
lines.detailed = true;
assert.ok(scene.children.every((one) => one.visible));
lines.show(marks({}));
assert.equal(scene.children.length, 0);

// The same lines as strokes: opaque ones without borders, in the order in which they lie.
lines.show(marks({paths: true, edges, dots: true, selected: {edge: edges[0]}}));
assert.deepEqual(
  lines.strokes.map(({width}) => width),
  [3, 2.5, 2.5, 2.5, 9, 6, 3],
);
assert.deepEqual(lines.strokes[0].ends, [0, 0, 0, 10, 0, 0, 20, 0, 0, 30, 0, 0]);
assert.deepEqual([...new Uint8Array(new Uint32Array([lines.strokes[1].colour]).buffer)], [0xd9, 0x2d, 0x3a, 255]);
lines.show(marks({}));
assert.equal(lines.strokes.length, 0);
