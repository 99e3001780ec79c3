// Segments with a width (src/monitor/page/wide_lines.ts).
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {WideLines} = await pageModule(process.argv[2], 'wide_lines');
const {Color, Vector2} = await three(process.argv[2]);
const size = new Vector2(100, 50);
const {object} = new WideLines([0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9], new Color(1, 0, 0), 3, 0.5, size);
const rows = (name) => {
  const {array, itemSize} = object.geometry.getAttribute(name);
  return Array.from({length: array.length / itemSize}, (_, k) => [...array.slice(itemSize * k, itemSize * (k + 1))]);
};

// Each segment has two corners at either end, and each corner knows the other end.
assert.deepEqual(rows('position').slice(0, 4), [
  [0, 0, 0],
  [0, 0, 0],
  [1, 2, 3],
  [1, 2, 3],
]);
assert.deepEqual(rows('other').slice(4), [
  [7, 8, 9],
  [7, 8, 9],
  [4, 5, 6],
  [4, 5, 6],
]);
assert.deepEqual(rows('side').flat().slice(0, 4), [1, -1, -1, 1]);

// Drawn as the shader does, with y up, both triangles turn the same way, so the quad has no gap and no fold.
const index = [...object.geometry.index.array];
assert.deepEqual(
  index.slice(6),
  index.slice(0, 6).map((corner) => corner + 4),
);
const corner = (k) => {
  const [a, b] = [rows('position')[k], rows('other')[k]],
    [side] = rows('side')[k];
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]),
    along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
  return [a[0] - along[1] * side - along[0], a[1] + along[0] * side - along[1]];
};
const area = ([a, b, c]) => ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
const areas = [0, 3].map((from) => area(index.slice(from, from + 3).map(corner)));
const whole = 2 * (Math.hypot(1, 2) + 2);
assert.ok(areas[0] * areas[1] > 0, 'one triangle is folded over the other');
assert.ok(Math.abs(Math.abs(areas[0] + areas[1]) - whole) < 1e-6, `${areas} is not the segment with its ends`);

size.set(200, 80);
assert.deepEqual(object.material.uniforms.resolution.value.toArray(), [200, 80], 'it follows the picture');
