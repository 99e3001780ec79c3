// The eye of the map (src/monitor/page/map_camera.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule, three} from './page_module.mjs';

await openPage(process.argv[2], '<canvas></canvas>');
const {MapCamera} = await pageModule(process.argv[2], 'map_camera');
const {Vector3} = await three(process.argv[2]);
const canvas = Object.assign(document.querySelector('canvas'), {clientWidth: 800, clientHeight: 400});
let moves = 0;
const made = () => {
  const eye = new MapCamera(canvas, () => ++moves);
  eye.resize(2);
  return eye;
};
/** The pixel of a place, from the left and from the top. */
const pixel = (eye, p) => {
  eye.camera.updateMatrixWorld();
  const {x, y} = p.clone().project(eye.camera);
  return [400 + 400 * x, 200 - 200 * y];
};
const near = ([ax, ay], [bx, by], max = 0.5) => Math.hypot(ax - bx, ay - by) < max;
const corners = [
  [100, 200],
  [400, 200],
  [100, 260],
  [400, 260],
].map(([x, y]) => new Vector3(x, y, 5));
const middle = new Vector3(250, 230, 5);

for (const planar of [true, false]) {
  const eye = made();
  eye.setPlanar(planar);
  assert.equal(eye.fitted, false);
  eye.fit([]);
  assert.equal(eye.fitted, false, 'there is nothing to look at');
  moves = 0;
  eye.fit(corners);
  assert.ok(eye.fitted && moves > 0);

  // All places are in the picture, and fill a good part of it.
  if (planar) assert.ok(near(pixel(eye, middle), [400, 200]));
  const centre = eye.target.clone();
  const pixels = corners.map((p) => pixel(eye, p));
  assert.ok(
    pixels.every(([x, y]) => x > 0 && x < 800 && y > 0 && y < 400),
    String(pixels),
  );
  const xs = pixels.map(([x]) => x);
  assert.ok(Math.max(...xs) - Math.min(...xs) > 450, `${xs}`);

  // A pixel is as many metres as it says, across the view at the target.
  const right = new Vector3().setFromMatrixColumn(eye.camera.matrixWorld, 0);
  const [x] = pixel(eye, centre.clone().addScaledVector(right, 100 * eye.metresPerPixel()));
  assert.ok(Math.abs(x - 500) < 0.5, `${x}`);

  // Twice as near, half the metres; the target stays.
  const before = eye.metresPerPixel();
  eye.zoom(2);
  assert.ok(Math.abs(eye.metresPerPixel() / before - 0.5) < 1e-6);
  assert.ok(near(pixel(eye, centre), [400, 200]));

  // Panning to the right brings what was there towards the middle, by 15 % of the picture's height.
  eye.pan(1, 0);
  assert.ok(near(pixel(eye, centre), [400 - 0.15 * 400, 200], 1), `${pixel(eye, centre)}`);
  eye.pan(-1, 0);
  eye.pan(0, 1);
  assert.ok(pixel(eye, centre)[1] > 205, 'what was in the middle is lower');

  // Going to a place from afar comes near, from nearby it only turns there.
  eye.fit(corners);
  eye.goTo(corners[0]);
  assert.ok(near(pixel(eye, corners[0]), [400, 200]));
  assert.ok(Math.abs(400 * eye.metresPerPixel() - 60) < 1e-3);
  eye.zoom(4);
  eye.goTo(corners[3]);
  assert.ok(Math.abs(400 * eye.metresPerPixel() - 15) < 1e-3);
}

// A fleet that is as deep as it is wide, of which the near side looks larger, is in the picture as a whole.
const deep = made();
const square = [
  [0, 0],
  [200, 0],
  [0, 200],
  [200, 200],
].map(([x, y]) => new Vector3(x, y, 5));
for (const turned of [0, 0.4, 1.2]) {
  deep.turn(turned, 0);
  deep.fit(square);
  const seen = square.map((p) => pixel(deep, p));
  assert.ok(
    seen.every(([x, y]) => x > 0 && x < 800 && y > 0 && y < 400),
    String(seen),
  );
  const rows = seen.map(([, y]) => y);
  assert.ok(Math.max(...rows) - Math.min(...rows) > 150, `fills too little of the picture: ${rows}`);
}

// Tools and legend lie over the sides of the picture: what is fitted is within them.
for (const planar of [true, false]) {
  const clear = made();
  clear.setPlanar(planar);
  clear.fit(square);
  assert.ok(clear.holds(square));
  for (const [x, y] of square.map((p) => pixel(clear, p)))
    assert.ok(x > 29 && x < 771 && y > 79 && y < 321, `${x}, ${y}`);
  clear.zoom(1.4);
  assert.ok(!clear.holds(square), 'a corner is under the tools');
}

// The view follows the fleet until somebody moves it; a look at the whole fleet begins anew.
const follower = made();
follower.fit(corners);
const tight = follower.metresPerPixel();
assert.ok(follower.follows);
follower.fit(corners, 1.5);
assert.ok(follower.follows && follower.metresPerPixel() > 1.3 * tight, 'with room');
follower.setPlanar(true);
assert.ok(follower.follows, 'a plan of the same is no other view');
follower.setPlanar(false);
for (const move of [
  () => follower.pan(1, 0),
  () => follower.zoom(2),
  () => follower.turn(1, 0),
  () => follower.goTo(corners[0]),
]) {
  move();
  assert.ok(!follower.follows, String(move));
  follower.fit(corners);
  assert.ok(follower.follows);
}

// Plan and 3D look at the same place at the same scale; north is up on the plan.
const eye = made();
eye.fit(corners);
eye.zoom(3);
eye.pan(2, 1);
const target = eye.target.clone(),
  scale = eye.metresPerPixel();
eye.setPlanar(true);
assert.ok(eye.target.distanceTo(target) < 1e-6 && Math.abs(eye.metresPerPixel() - scale) < 1e-6);
const [east, north] = [
  pixel(eye, target.clone().add(new Vector3(1, 0, 0))),
  pixel(eye, target.clone().add(new Vector3(0, 1, 0))),
];
assert.ok(near(east, [400 + 1 / scale, 200]) && near(north, [400, 200 - 1 / scale]));
eye.setPlanar(false);
assert.ok(eye.target.distanceTo(target) < 1e-6 && Math.abs(eye.metresPerPixel() - scale) < 1e-6);
moves = 0;
eye.setPlanar(false);
assert.equal(moves, 0, 'nothing has changed');

// Turning by keys: the target and the scale stay, a place in front goes to the side; the view stays above the ground.
const front = target.clone().add(new Vector3().subVectors(target, eye.camera.position).setZ(0).setLength(5));
const side = pixel(eye, front)[0];
eye.turn(0.5, 0);
assert.ok(eye.target.distanceTo(target) < 1e-6 && Math.abs(eye.metresPerPixel() - scale) < 1e-6);
assert.ok(near(pixel(eye, target), [400, 200]) && Math.abs(pixel(eye, front)[0] - side) > 10);
eye.turn(-0.5, 0);
assert.ok(Math.abs(pixel(eye, front)[0] - side) < 0.5, 'and back');
const height = eye.camera.position.z;
eye.turn(0, 0.2);
assert.ok(eye.camera.position.z > height, 'it looks from higher up');
eye.turn(0, -9);
assert.ok(eye.camera.position.z > target.z);
eye.turn(0, 9);
assert.ok(eye.camera.position.clone().sub(target).normalize().z > 0.99);
eye.setPlanar(true);
moves = 0;
eye.turn(1, 1);
assert.equal(moves, 0, 'north stays up');
