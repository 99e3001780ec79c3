// The buffer of all points (src/monitor/page/point_pool.ts).
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {kBlock, PointPool, pointStyle} = await pageModule(process.argv[2], 'point_pool', 'point_material');
const {Color, Matrix4, Vector3} = await three(process.argv[2]);
const pool = new PointPool(pointStyle());
const steps = (...points) => Int16Array.from(points.flat());

// Blocks are given once, until they come back.
const first = pool.take(),
  second = pool.take();
assert.notEqual(first, second);
assert.equal(pool.used, 2);
pool.fill(first, 3, steps([32767, 0, -32767, 100], [0, 32767, 0, 200]));
assert.deepEqual(pool.step(first, 3, new Vector3()).toArray(), [1, 0, -1]);
assert.deepEqual(pool.step(first, 4, new Vector3()).toArray(), [0, 1, 0]);

// The texture has three rows of the matrix, then colour and share.
pool.dress(second, new Matrix4().makeTranslation(5, 6, 7), new Color(0.25, 0.5, 0.75), 0.125);
assert.deepEqual([...pool.styleOf(second)], [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0.25, 0.5, 0.75, 0.125]);

// The index names the first points of each block that is drawn, in one call.
const {geometry} = pool.object;
pool.begin();
pool.draw(second, 2);
pool.draw(first, 3);
pool.end();
assert.deepEqual(geometry.drawRange, {start: 0, count: 5});
const at = (block, k) => kBlock * block + k;
const drawn = [at(second, 0), at(second, 1), at(first, 0), at(first, 1), at(first, 2)];
assert.deepEqual([...geometry.index.array.slice(0, 5)], drawn);
pool.begin();
pool.end();
assert.equal(pool.object.visible, false, 'nothing is drawn of an empty list');

// Later points reach WebGL's copy: the range and the version of the buffer.
const {data} = geometry.getAttribute('position');
const version = data.version;
pool.fill(second, 0, steps([1, 2, 3, 4]));
assert.equal(data.version, version + 1);
assert.deepEqual(data.updateRanges.at(-1), {start: 4 * kBlock * second, count: 4});

// When it grows, points, poses and free blocks stay.
pool.give(first);
assert.equal(pool.take(), first);
const taken = new Set([first, second]);
while (taken.size < 1500) taken.add(pool.take());
assert.equal(pool.used, 1500);
assert.deepEqual([...pool.styleOf(second).slice(3, 4)], [5]);
assert.deepEqual(
  [...geometry.getAttribute('position').data.array.slice(4 * kBlock * second, 4 * kBlock * second + 4)],
  [1, 2, 3, 4],
);
const {image} = pool.object.material.uniforms.styles.value;
assert.equal(image.width * image.height * 4, image.data.length);
