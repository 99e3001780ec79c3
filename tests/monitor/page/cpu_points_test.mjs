// Points drawn by the CPU (src/monitor/page/cpu_points.ts), pixel by pixel.
//   node cpu_points_test.mjs PAGE_FOLDER
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {CpuPoints, PointPool, Submap, kPointSize, pointStyle, rgbOf} = await pageModule(
  process.argv[2],
  'cpu_points',
  'point_pool',
  'submap',
  'point_material',
);
const {Matrix4, OrthographicCamera, PerspectiveCamera, Vector3} = await three(process.argv[2]);
const kSize = 64,
  kSteps = 32767;

/** Looks down from 10 m at a square of 8 m, north up, 8 pixels a metre. */
function above(Camera) {
  const camera =
    Camera === OrthographicCamera
      ? new Camera(-4, 4, 4, -4, 1, 100)
      : new Camera((360 / Math.PI) * Math.atan(0.4), 1, 1, 100);
  camera.up.set(0, 1, 0);
  camera.position.set(0, 0, 10);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return camera;
}

/** A map of submaps, each with points [x, y, z (m), intensity (0 to 1)] around a place. */
function mapOf(...submaps) {
  const style = pointStyle(),
    pool = new PointPool(style);
  Object.assign(style.pixelsPerMetre, {value: 8});
  Object.assign(style.planar, {value: 1});
  Object.assign(style.low, {value: -1});
  Object.assign(style.high, {value: 1});
  const made = submaps.map(({points, at = [0, 0, 0], colour = '#ff0000'}, k) => {
    const submap = new Submap(String(k), 'r1', 0, pool, colour);
    submap.place(new Matrix4().makeTranslation(...at));
    submap.add({
      centre: [0, 0, 0],
      scale: 8 / kSteps,
      total: points.length,
      from: 0,
      values: Int16Array.from(
        points.flatMap(([x, y, z, i = 0]) => [x / 8, y / 8, z / 8, i].map((v) => Math.round(v * kSteps))),
      ),
    });
    submap.wanted = points.length;
    return submap;
  });
  const drawer = new CpuPoints(pool, style);
  const picture = (camera = above(OrthographicCamera)) => {
    pool.begin();
    for (const submap of made) {
      submap.dress();
      submap.draw(1);
    }
    return drawer.render({camera, width: kSize, height: kSize}, true);
  };
  return {style, pool, submaps: made, drawer, picture};
}
const pixel = ({colours}, x, y) => [...colours.image.data.slice(4 * (kSize * y + x), 4 * (kSize * y + x) + 4)];
const covered = ({colours}) =>
  Array.from({length: kSize * kSize}, (_, k) => k).filter((k) => colours.image.data[4 * k + 3] > 0);

// A point of 2 x 2 pixels is at its place, and nothing is elsewhere. Rows count from the south, as in WebGL's textures.
for (const Camera of [OrthographicCamera, PerspectiveCamera]) {
  const {picture} = mapOf({points: [[2, 1, 0]]});
  assert.deepEqual(
    covered(picture(above(Camera))),
    [
      [47, 39],
      [48, 39],
      [47, 40],
      [48, 40],
    ].map(([x, y]) => kSize * y + x),
  );
}

// With few pixels a point is the one that it lies in, also beside the last row and column.
{
  const {style, picture} = mapOf({
    points: [
      [2.05, 1.05, 0],
      [3.99, -3.99, 0],
      [4.01, 0, 0],
      [0, 4.01, 0],
    ],
  });
  style.ratio.value = 0.6; // 1.02 pixels
  assert.deepEqual(covered(picture()), [kSize * 0 + 63, kSize * 40 + 48]);
}

// The nearer of two points at one pixel is drawn, whichever comes first; depths are WebGL's.
for (const order of [0, 1]) {
  const both = [
    {points: [[0, 0, 2]], colour: '#00ff00'},
    {points: [[0, 0, -2]], colour: '#0000ff'},
  ];
  const picture = mapOf(...(order ? both : both.reverse())).picture();
  const [r, g, b] = pixel(picture, 32, 32);
  assert.ok(g > 200 && b < 150 && r < 150, `the lower one is seen: ${[r, g, b]}`);
  const expected = new Vector3(0, 0, 2).project(above(OrthographicCamera)).z * 0.5 + 0.5;
  assert.ok(Math.abs(picture.depths.image.data[32 * kSize + 32] - expected) < 1e-4);
}

// Colours: a robot's, lighter with height; the ramp by height and intensity.
const {style, picture} = mapOf({
  points: [
    [-2, 0, -1, 0],
    [2, 0, 1, 1],
  ],
  colour: '#2f7de1',
});
const {r, g, b} = rgbOf('#2f7de1');
const near = (value, expected) => expected.every((one, k) => Math.abs(value[k] - 255 * one) <= 2);
assert.ok(near(pixel(picture(), 16, 32), [0.5 * r, 0.5 * g, 0.5 * b]));
assert.ok(near(pixel(picture(), 48, 32), [r, g, b]));
Object.assign(style.highTone, {value: 0.42}); // as on a dark map
assert.ok(near(pixel(picture(), 48, 32), [r + 0.42 * (1 - r), g + 0.42 * (1 - g), b + 0.42 * (1 - b)]));
for (const mode of [1, 2]) {
  style.mode.value = mode;
  const [low, high] = [pixel(picture(), 16, 32), pixel(picture(), 48, 32)];
  assert.ok(high[0] > high[2] && low[2] > high[2], `mode ${mode}: ${low} to ${high}`);
}

// A correction moves the matrix and no point: the values that came over the network stay as they are.
const moved = mapOf({
  points: [
    [2, 1, 0],
    [1, 1, 0],
  ],
});
const before = Int16Array.from(moved.pool.values),
  first = covered(moved.picture());
moved.submaps[0].place(new Matrix4().makeTranslation(-1, 0, 0));
assert.deepEqual(
  covered(moved.picture()),
  first.map((k) => k - 8),
);
assert.deepEqual(moved.pool.values, before);
assert.ok(moved.submaps[0].point(0, new Vector3()).distanceTo(new Vector3(1, 1, 0)) < 1e-3);

// Points behind the eye or beside the picture are not drawn.
const beside = mapOf({
  points: [
    [7, 7, 0],
    [-7.9, 0, 0],
    [0, 0, 3],
  ],
  at: [0, 0, 8],
});
assert.equal(covered(beside.picture(above(PerspectiveCamera))).length, 0);

// Lines lie over points, in the view of the last picture.
const lined = mapOf({points: [[0, 0, 3]], colour: '#00ff00'}),
  behind = lined.picture();
const line = {ends: [-3, 0, 0, 3, 0, 0], colour: 0xff0000ff, width: 2};
lined.drawer.stroke([line]);
assert.deepEqual(pixel(behind, 32, 32), [255, 0, 0, 255]);
assert.equal(covered(behind).length, 2 * (6 * 8 + 2));

// Robots of different colours are told apart.
const two = mapOf({points: [[-2, 0, 0]], colour: '#2f7de1'}, {points: [[2, 0, 0]], colour: '#2f7de0'}).picture();
assert.notDeepEqual(pixel(two, 16, 32), pixel(two, 48, 32));

// In perspective a point that is half as far is twice as large, up to a bound.
const sizes = [0, 5, 8].map((z) => {
  const one = mapOf({points: [[0, 0, 0]], at: [0, 0, z]});
  Object.assign(one.style.planar, {value: 0});
  Object.assign(one.style.pixelsPerMetre, {value: 20 / kPointSize.metres});
  return Math.sqrt(covered(one.picture(above(PerspectiveCamera))).length);
});
assert.deepEqual(sizes, [2, 4, kPointSize.max]);
