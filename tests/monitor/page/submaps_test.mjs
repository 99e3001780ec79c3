// Which points are asked for and drawn (src/monitor/page/submaps.ts).
import assert from 'node:assert/strict';
import {pageModule, three} from './page_module.mjs';

const {pointStyle, Submaps} = await pageModule(process.argv[2], 'submaps', 'point_material');
const {Matrix4, OrthographicCamera, PerspectiveCamera} = await three(process.argv[2]);
const settled = () => new Promise((later) => setImmediate(later));

/** A program whose submaps have so many points; it answers when the test says so. */
class Program {
  asked = [];
  waiting = [];
  constructor(points) {
    this.points = points;
    globalThis.fetch = (address) => {
      this.asked.push(address);
      return new Promise((answer, fail) => this.waiting.push({address, answer, fail}));
    };
  }
  part(from, count) {
    const bytes = Buffer.alloc(36 + 8 * count);
    bytes.write('FMP1');
    bytes.writeFloatLE(0.001, 16);
    [this.points, from, count].forEach((value, k) => bytes.writeUInt32LE(value, 20 + 4 * k));
    for (let k = 0; k < count; ++k) bytes.writeInt16LE(from + k, 36 + 8 * k + 4);
    return bytes;
  }
  body(address) {
    const url = new URL(address, 'http://x'),
      number = (name) => Number(url.searchParams.get(name));
    const part = this.part(number('from'), Math.min(number('count'), this.points - number('from')));
    if (url.pathname !== '/submaps') return part;
    const hashes = url.searchParams.get('of').split(',');
    return Buffer.concat(hashes.flatMap((hash) => [Buffer.from(hash), part]));
  }
  async answerAll(more = {}) {
    for (const {address, answer} of this.waiting.splice(0)) {
      const bytes = this.body(address);
      answer({ok: true, arrayBuffer: async () => new Uint8Array(bytes).buffer, ...more});
    }
    await settled();
    await settled();
  }
}
const eye = (Camera = OrthographicCamera) => {
  const camera = Camera === OrthographicCamera ? new Camera(-500, 500, 500, -500, 1, 1000) : new Camera(90, 1, 1, 5000);
  camera.position.set(0, 0, 100);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  return camera;
};
const real = globalThis.fetch;
const {warn} = console,
  {setTimeout: later} = globalThis;
try {
  // The first points of many submaps come in a few requests, whose submaps are spread over the site.
  const program = new Program(5000);
  const submaps = new Submaps(pointStyle(), () => {});
  submaps.budget = 40_000;
  const hash = (k) => String(k).padStart(32, '0');
  for (let k = 0; k < 200; ++k) submaps.add(hash(k), 'r1', k).place(new Matrix4().makeTranslation(k - 100, 0, 0));
  const picture = (share = 1, until = Infinity, camera = eye(), planar = true) => {
    submaps.refresh();
    submaps.prepare(camera, planar, until, false, share);
    return submaps.drawn;
  };
  picture();
  assert.equal(program.asked.length, 3, 'requests at once');
  const first = new URL(program.asked[0], 'http://x').searchParams;
  const of = first.get('of').split(',').map(Number);
  assert.equal(Number(first.get('count')), 200, 'its share of the budget');
  for (const from of [0, 50, 100, 150]) {
    const there = of.slice(0, 16).filter((k) => k >= from && k < from + 50).length;
    assert.ok(there >= 2 && there <= 6, `${there} of the first 16 are of a quarter of the site`);
  }
  assert.ok(submaps.loading);
  for (let k = 0; k < 4; ++k) {
    await program.answerAll();
    picture();
  }
  assert.equal(submaps.loading, false);
  assert.ok([...submaps.all.values()].every((one) => one.total === 5000 && one.loaded >= 200));

  // The budget holds, a share of it is drawn of each, and time hides what is later.
  const drawn = picture();
  assert.ok(drawn <= 40_000 && drawn > 35_000, `${drawn} points`);
  assert.ok(Math.abs(picture(0.25) - drawn / 4) <= 200);
  assert.ok(picture(1, 99) <= 40_000);
  assert.equal([...submaps.all.values()].filter((one) => one.visible).length, 100);
  submaps.only = new Set([hash(3)]);
  picture();
  assert.deepEqual(
    [...submaps.all.values()].filter((one) => one.visible).map((one) => one.t),
    [3],
  );
  await program.answerAll();
  submaps.only = undefined;

  // In perspective the near ones get more.
  picture(1, Infinity, eye(PerspectiveCamera), false);
  const wanted = (k) => submaps.all.get(hash(k)).wanted;
  assert.ok(wanted(100) > 1.4 * wanted(5), `${wanted(100)} and ${wanted(5)} points`);

  // The ramp goes from the least to nearly the most, and a value that is missing counts as the most.
  const range = submaps.putOnRamp((one) => (one.t === 7 ? undefined : one.t), Infinity);
  assert.deepEqual(range, [0, 196]);
  assert.deepEqual(
    submaps.putOnRamp((one) => one.t, Infinity, [-10, 50]),
    [-10, 196],
  );
  const low = submaps.heights();
  assert.ok(low[0] >= 0 && low[1] > low[0] && low[1] <= 5);

  // Points that all lack come together. While the view moves, what is nearly there is not asked for.
  const another = new Program(5000),
    few = new Submaps(pointStyle(), () => {});
  for (let k = 0; k < 100; ++k) few.add(hash(k), 'r1', k).place(new Matrix4().makeTranslation(k - 50, 0, 0));
  few.budget = 10_000;
  const show = (moving) => {
    few.refresh();
    few.prepare(eye(), true, Infinity, moving, 1);
  };
  for (show(false); few.loading; show(false)) await another.answerAll();
  few.budget = 18_000;
  another.asked.length = 0;
  show(true);
  assert.deepEqual(another.asked, [], 'nearly as many as are wanted');
  show(false);
  assert.deepEqual(
    another.asked.map((address) => address.replace(/of=.*/, '')),
    Array(2).fill('/submaps?from=100&count=92&'),
    'all in two requests',
  );
  await another.answerAll();
  assert.ok([...few.all.values()].every((one) => one.loaded === 192));
  few.budget = 60_000;
  show(true);
  assert.equal(another.asked.length, 4, 'twice as many are worth it');
  await another.answerAll();
  few.budget = 200_000;
  another.asked.length = 0;
  show(false);
  assert.ok(another.asked[0].startsWith(`/submap/`), 'many points come by themselves');

  // Those that are gone give their blocks back.
  submaps.keepOnly(new Set([hash(1)]));
  assert.deepEqual([...submaps.all.keys()], [hash(1)]);
  assert.ok(submaps.pool.used * 256 <= submaps.all.get(hash(1)).loaded + 255);

  // A submap that cannot be read is left out, and the picture goes on.
  console.warn = () => {};
  const broken = new Program(0),
    others = new Submaps(pointStyle(), () => {});
  others.add(hash(1), 'r1', 0).place(new Matrix4());
  others.prepare(eye(), true, Infinity, false, 1);
  await broken.answerAll();
  assert.ok(others.all.get(hash(1)).failed);
  assert.equal(others.loading, false);
  const refused = new Program(10),
    third = new Submaps(pointStyle(), () => {});
  third.add(hash(1), 'r1', 0).place(new Matrix4());
  third.prepare(eye(), true, Infinity, false, 1);
  const waits = [];
  globalThis.setTimeout = (act, wait) => waits.push({act, wait});
  const again = () => {
    waits.at(-1).act();
    third.prepare(eye(), true, Infinity, false, 1);
  };
  for (let k = 0; k < 7; ++k) {
    await refused.answerAll({ok: false, text: async () => 'no'});
    assert.ok(third.all.get(hash(1)).failed);
    third.prepare(eye(), true, Infinity, false, 1);
    assert.equal(refused.waiting.length, 0, 'not at once');
    again();
  }
  assert.deepEqual(
    waits.map(({wait}) => wait),
    [2000, 4000, 8000, 16_000, 32_000, 60_000, 60_000],
  );
  await refused.answerAll();
  assert.equal(third.all.get(hash(1)).loaded, 10, 'one answer of a busy robot does not lose it');
  assert.equal(third.all.get(hash(1)).failures, 0);
} finally {
  globalThis.fetch = real;
  console.warn = warn;
  globalThis.setTimeout = later;
}
