// Points drawn by WebGL (src/monitor/page/gl_points.ts): what is asked of the renderer.
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {GlPoints, PointPool, pointStyle} = await pageModule(
  process.argv[2],
  'gl_points',
  'point_pool',
  'point_material',
);
const {PerspectiveCamera} = await three(process.argv[2]);
const pool = new PointPool(pointStyle()),
  camera = new PerspectiveCamera();
const calls = [];
let target = null;
const renderer = {
  setRenderTarget: (next) => (target = next),
  setClearColor: (colour, alpha) => calls.push(['colour', colour, alpha]),
  clear: () => calls.push(['clear', target]),
  render: (scene, camera) => calls.push(['render', target, scene.children, camera]),
};
const points = new GlPoints(pool, renderer);
const picture = points.render({camera, width: 30, height: 20});

// Only the pool's points, into a cleared picture of their own, and then the canvas is the target again.
const into = calls[1][1];
assert.ok(into);
assert.deepEqual([into.width, into.height], [30, 20]);
assert.deepEqual(calls[0], ['colour', 0, 0], 'nothing is where there is no point');
assert.deepEqual(calls.slice(1), [
  ['clear', into],
  ['render', into, [pool.object], camera],
]);
assert.equal(target, null);
assert.deepEqual(picture, {colours: into.texture, depths: into.depthTexture});

// One picture serves until its size changes, and the picture follows.
assert.equal(points.render({camera, width: 30, height: 20}).colours, picture.colours);
points.render({camera, width: 40, height: 20});
assert.equal(into.width, 40);
