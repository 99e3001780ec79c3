// The point under the pointer (src/monitor/page/picking.ts).
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {placeOf, pointAt} = await pageModule(process.argv[2], 'picking');
const {OrthographicCamera, Vector3} = await three(process.argv[2]);
const camera = new OrthographicCamera(-4, 4, 4, -4, 1, 100);
camera.position.set(0, 0, 10);
camera.lookAt(0, 0, 0);
camera.updateMatrixWorld();
const canvas = {clientWidth: 80, clientHeight: 80}; // 10 pixels a metre, (40, 40) is above the origin
const submap = (points, drawn = points.length) => ({drawn, point: (k, out) => out.set(...points[k])});
const at = (submaps, x, y) => pointAt(submaps, camera, canvas, x, y, 6)?.p.toArray();

const low = submap([
    [0, 0, 0],
    [2, 1, 0],
  ]),
  high = submap([[0.3, 0, 5]]);
assert.deepEqual(at([low], 60, 30), [2, 1, 0]);
assert.deepEqual(at([low, high], 40, 40), [0.3, 0, 5], 'the one in front, though the other is nearer to the pointer');
assert.deepEqual(
  at(
    [
      submap([
        [0.3, 0, 0],
        [0.1, 0, 0],
        [-0.2, 0, 0],
      ]),
    ],
    40,
    40,
  ),
  [0.1, 0, 0],
  'of one depth the nearest',
);
assert.equal(at([low], 50, 40), undefined, 'beyond reach');
assert.equal(at([submap([[0, 0, 0]], 0)], 40, 40), undefined, 'what is not drawn is not picked');
assert.equal(
  at(
    [
      submap([
        [0, 0, 20],
        [0, 0, -95],
      ]),
    ],
    40,
    40,
  ),
  undefined,
  'behind the eye, or beyond what is drawn',
);
const picked = pointAt([low, high], camera, canvas, 40, 40, 6);
assert.ok(new Vector3(0.3, 0, 5).equals(picked.p), 'a vector of its own');
assert.equal(picked.submap, high, 'it tells whose coordinates these are');

const {x, y, depth} = placeOf(new Vector3(2, 1, 0), camera, canvas);
assert.deepEqual([x, y].map(Math.round), [60, 30]);
assert.ok(depth > placeOf(new Vector3(2, 1, 5), camera, canvas).depth, 'what is nearer has less depth');
assert.equal(placeOf(new Vector3(0, 0, 20), camera, canvas), undefined);
