// Submaps as the page holds them (src/monitor/page/submap.ts): parts that come, blocks that are given back.
//   node submap_test.mjs PAGE_FOLDER
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {parsePart, parseParts, Submap, PointPool, pointStyle} = await pageModule(
  process.argv[2],
  'submap',
  'point_pool',
  'point_material',
);
const {Matrix4, Vector3} = await three(process.argv[2]);

/** As src/monitor/point_levels.hpp describes it: point k is (k, 2 k, 3 k, 4 k) steps. */
function encoded(from, count, total) {
  const bytes = Buffer.alloc(36 + 8 * count);
  bytes.write('FMP1');
  [1, 2, 3, 0.001].forEach((value, k) => bytes.writeFloatLE(value, 4 + 4 * k));
  [total, from, count].forEach((value, k) => bytes.writeUInt32LE(value, 20 + 4 * k));
  for (let k = 0; k < count; ++k)
    [1, 2, 3, 4].forEach((axis, a) => bytes.writeInt16LE(axis * (from + k), 36 + 8 * k + 2 * a));
  return bytes;
}
const buffer = (bytes) => new Uint8Array(bytes).buffer;
const hashes = ['0123456789abcdef0123456789abcdef', 'f'.repeat(32)];

// Several submaps in one answer, each after its hash; one that cannot be read has no points.
const parts = parseParts(
  buffer(Buffer.concat([Buffer.from(hashes[0]), encoded(0, 300, 5000), Buffer.from(hashes[1]), encoded(0, 0, 0)])),
);
assert.deepEqual([...parts.keys()], hashes);
assert.equal(parts.get(hashes[0]).values.length, 4 * 300);
assert.equal(parts.get(hashes[0]).total, 5000);
assert.equal(parts.get(hashes[1]).total, 0);
assert.equal(parseParts(new ArrayBuffer(0)).size, 0);
for (const cut of [1, 20, 40, 8 * 300 + 67]) {
  const answer = Buffer.concat([Buffer.from(hashes[0]), encoded(0, 300, 5000)]);
  assert.throws(() => parseParts(buffer(answer.subarray(0, cut))), /damaged/, `cut after ${cut} bytes`);
}
assert.throws(() => parsePart(buffer(Buffer.concat([encoded(0, 10, 10), Buffer.alloc(1)]))), /damaged/);

// Parts that follow each other fill the blocks without gaps, whatever their sizes.
const pool = new PointPool(pointStyle()),
  submap = new Submap(hashes[0], 'r1', 0, pool, '#ffffff');
submap.place(new Matrix4());
for (const [from, count] of [
  [0, 100],
  [100, 300],
  [400, 1],
  [401, 599],
])
  submap.add(parsePart(buffer(encoded(from, count, 5000))));
assert.equal(submap.loaded, 1000);
assert.equal(pool.used, 4);
for (const k of [0, 99, 100, 255, 256, 400, 999]) {
  const at = submap.point(k, new Vector3());
  assert.ok(
    at.distanceTo(new Vector3(1 + 0.001 * k, 2 + 0.002 * k, 3 + 0.003 * k)) < 1e-4,
    `point ${k} is at ${at.toArray()}`,
  );
}
submap.add(parsePart(buffer(encoded(500, 10, 5000)))); // an answer that was overtaken
assert.equal(submap.loaded, 1000);

// Blocks that are freed are used again; those that are kept stay as they are.
submap.trim(300);
assert.equal(submap.loaded, 512);
assert.equal(pool.used, 2);
submap.add(parsePart(buffer(encoded(512, 488, 5000))));
assert.equal(pool.used, 4);
assert.ok(submap.point(999, new Vector3()).distanceTo(new Vector3(1.999, 3.998, 5.997)) < 1e-4);
submap.wanted = 700;
pool.begin();
assert.equal(submap.draw(0.5), 350);
assert.deepEqual(
  pool.runs.map((run) => run.points),
  [256, 94],
);
submap.trim(0);
assert.equal(pool.used, 0);

// The pool grows and keeps what it holds.
const many = Array.from({length: 1500}, (_, k) => {
  const one = new Submap(String(k), 'r1', 0, pool, '#ffffff');
  one.place(new Matrix4().makeTranslation(k, 0, 0));
  one.add(parsePart(buffer(encoded(0, 2, 2))));
  return one;
});
assert.ok(many.every((one, k) => Math.abs(one.point(1, new Vector3()).x - (k + 1.001)) < 1e-3));
