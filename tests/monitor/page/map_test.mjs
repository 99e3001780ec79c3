// The map's pictures: when one is drawn, and of what (src/monitor/page/map.ts). A renderer that only notes what it is
// given takes the place of WebGL.
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule, three} from './page_module.mjs';
import {alignment, node, registration, state} from './states.mjs';

const page = await openPage(process.argv[2], '<div><canvas></canvas></div>');
const {FleetMap} = await pageModule(process.argv[2], 'map');
const {Vector3} = await three(process.argv[2]);
const canvas = Object.assign(document.querySelector('canvas'), {clientWidth: 800, clientHeight: 400});
canvas.parentElement.getBoundingClientRect = () => ({width: 800, height: 400});
canvas.getBoundingClientRect = () => ({left: 0, top: 0, width: 800, height: 400});
window.devicePixelRatio = 1;
globalThis.location = {search: '?points=cpu'};

class Renderer {
  ratio = 1;
  cost = 0; // ms that a scene takes
  rendered = []; // the objects of each scene since the last look
  setSize() {}
  setPixelRatio(ratio) {
    this.ratio = ratio;
  }
  getPixelRatio() {
    return this.ratio;
  }
  getDrawingBufferSize(size) {
    return size.set(800 * this.ratio, 400 * this.ratio);
  }
  setClearColor() {}
  clear() {}
  render(scene) {
    time += this.cost;
    this.rendered.push(scene.children.filter((one) => one.visible).map((one) => one.type));
  }
}

/** A program whose submaps have 500 points, which it sends at once. */
globalThis.fetch = async (address) => {
  const url = new URL(address, 'http://x');
  const parts = url.searchParams
    .get('of')
    .split(',')
    .map((hash) => {
      const bytes = Buffer.alloc(36 + 8 * 500);
      bytes.write('FMP1');
      bytes.writeFloatLE(1e-4, 16);
      [500, 0, 500].forEach((value, k) => bytes.writeUInt32LE(value, 20 + 4 * k));
      return Buffer.concat([Buffer.from(hash), bytes]);
    });
  return {ok: true, arrayBuffer: async () => new Uint8Array(Buffer.concat(parts)).buffer};
};
const {now} = performance,
  timers = {set: globalThis.setTimeout, clear: globalThis.clearTimeout};
let time = 0;
const waiting = new Set();
performance.now = () => time;
globalThis.setTimeout = (act, ms) => {
  const timer = {act, at: time + ms};
  waiting.add(timer);
  return timer;
};
globalThis.clearTimeout = (timer) => waiting.delete(timer);
try {
  const renderer = new Renderer(),
    pictures = [];
  const map = new FleetMap(canvas, () => renderer);
  map.onPicture = (picture) => pictures.push(picture);
  /** Draws what is due, `ms` later; returns how many pictures that were. */
  const frames = (ms = 16) => {
    time += ms;
    for (const timer of [...waiting]) {
      if (timer.at > time || !waiting.delete(timer)) continue;
      timer.act();
    }
    const before = pictures.length;
    for (const act of page.frames.splice(0)) act(time);
    return pictures.length - before;
  };
  const drawAll = async () => {
    for (let k = 0; k < 20; ++k) {
      await new Promise((next) => setImmediate(next));
      frames(100);
    }
  };
  const fleet = (more = {}) =>
    state({
      alignments: [alignment('r1#0', 'r2#0', 'used')],
      registrations: [registration('r1#1', 'r2#1', 'rejected')],
      ...more,
    });

  // Its points come, all of them are drawn, and then nothing more is drawn.
  assert.equal(frames(), 0, 'nothing is there');
  map.show(fleet());
  await drawAll();
  const last = pictures.at(-1);
  assert.equal(last.drawn, 4 * 500);
  assert.equal(last.total, 4 * 500);
  assert.ok(!last.loading && !last.moving && !last.planar);
  assert.equal(frames(5000), 0, 'a picture of which nothing has changed');
  map.draw();
  map.draw();
  assert.equal(frames(), 1);

  // A submap is as floating as its node.
  const [first] = fleet().nodes;
  map.show(fleet({nodes: fleet().nodes.map((one) => (one.id === first.id ? {...one, floating: 2} : one))}));
  assert.equal(map.submaps.all.get(first.submap).floating, 2);
  map.show(fleet());
  assert.equal(map.submaps.all.get(first.submap).floating, undefined);
  await drawAll();
  // A fleet that drives out of the view is followed until somebody moves the view.
  const grown = (x) => fleet({nodes: [...fleet().nodes, node('r2', 9, [x, 0, 0], {submap: undefined})]});
  const visible = (x) => {
    map.eye.camera.updateMatrixWorld();
    const at = map.project(new Vector3(x, 0, 0));
    return at !== undefined && at.x > 0 && at.x < 800 && at.y > 0 && at.y < 400;
  };
  const eyeAt = map.eye.camera.position.clone();
  map.show(grown(11));
  assert.ok(map.eye.camera.position.equals(eyeAt), 'all is in view');
  assert.ok(!visible(200));
  map.show(grown(200));
  assert.ok(visible(200));
  map.eye.pan(0, 0);
  map.show(grown(2000));
  assert.ok(!visible(2000), 'somebody looks at a part of it');
  map.show(fleet());
  map.fit();
  await drawAll();

  // Points have their robot's colour, also where it changes; a theme is a picture.
  const coloursOfBlocks = () => {
    const found = new Set();
    for (const {block} of map.submaps.pool.runs)
      found.add([...map.submaps.pool.styleOf(block).slice(12, 15)].map((v) => Math.round(255 * v)).join());
    return [...found].sort();
  };
  assert.deepEqual(coloursOfBlocks(), ['208,90,27', '47,125,225']);
  map.show(
    fleet({
      colours: new Map([
        ['r1', '#010203'],
        ['r2', '#2f7de1'],
      ]),
    }),
  );
  await drawAll();
  assert.deepEqual(coloursOfBlocks(), ['1,2,3', '47,125,225']);
  map.show(fleet());
  await drawAll();
  map.setDark(true);
  assert.equal(frames(), 1);
  map.setDark(false);
  frames();

  // The whole fleet is in view, and a click finds nodes and edges where they are seen.
  const at = (id) => map.project(map.place(id));
  for (const {id} of fleet().nodes) {
    const {x, y} = at(id);
    assert.ok(x > 0 && x < 800 && y > 0 && y < 400, id);
    assert.deepEqual(map.hitAt(x, y, 5), {node: id});
  }
  const between = (a, b) => [(at(a).x + at(b).x) / 2, (at(a).y + at(b).y) / 2];
  assert.equal(map.hitAt(...between('r1#0', 'r2#0'), 5).edge.kind, 'used');
  assert.equal(map.hitAt(...between('r1#1', 'r2#1'), 5).edge.kind, 'rejected');
  map.layers.used = false;
  assert.equal(map.hitAt(...between('r1#0', 'r2#0'), 5), undefined, 'what is not shown is not clicked');
  map.layers.used = true;

  // A click between two nodes finds the trajectory, one on points the node that they were seen from.
  assert.deepEqual(map.hitAt(...between('r1#0', 'r1#1'), 5), {node: 'r1#0', next: 'r1#1'});
  const layers = {...map.layers};
  Object.assign(map.layers, {nodes: false, paths: false, used: false, rejected: false});
  assert.equal(map.hitAt(...between('r1#0', 'r1#1'), 5), undefined, 'nor are trajectories that are hidden');
  const point = map.pick(at('r2#1').x, at('r2#1').y, 5);
  assert.equal(point.node, 'r2#1');
  assert.ok(point.point.distanceTo(map.place('r2#1')) < 1e-6);
  assert.equal(map.pick(...between('r1#0', 'r2#0'), 5), undefined);
  map.layers.points = false;
  assert.equal(map.pick(at('r2#1').x, at('r2#1').y, 5), undefined);
  Object.assign(map.layers, layers);
  assert.deepEqual(map.pick(at('r2#1').x, at('r2#1').y, 5), {node: 'r2#1'}, 'a node goes before its points');

  // Sigmas of a few centimetres have nearly one colour, not all of the ramp.
  map.setColour('sigma');
  map.show(fleet({nodes: fleet().nodes.map((one, k) => ({...one, sigma_m: 0.01 * k}))}));
  await drawAll();
  assert.deepEqual(pictures.at(-1).range, [0, 0.5]);
  map.show(fleet({nodes: fleet().nodes.map((one) => ({...one, sigma_m: 3}))}));
  await drawAll();
  assert.deepEqual(pictures.at(-1).range, [0, 3]);
  map.setColour('robot');
  map.show(fleet());
  await drawAll();

  // While the view moves slowly, lines are drawn with the points, in one picture of fewer pixels; none is left out.
  renderer.rendered.length = 0;
  map.draw();
  frames();
  const still = renderer.rendered.splice(0);
  assert.equal(still.length, 2, 'points, then lines and nodes');
  assert.ok(still[1].includes('Mesh') && still[1].includes('Points'));
  for (let k = 0; k < 2; ++k) {
    map.eye.pan(0.1, 0);
    renderer.rendered.length = 0;
    frames(60);
  }
  assert.ok(pictures.at(-1).moving && pictures.at(-1).coarse);
  assert.equal(pictures.at(-1).drawn, 4 * 500);
  assert.equal(renderer.rendered.length, 1);
  assert.ok(renderer.ratio < 1);

  // When it stands still all is drawn again, by itself.
  renderer.rendered.length = 0;
  assert.equal(frames(500), 1);
  assert.equal(renderer.rendered.length, 2);
  assert.equal(renderer.ratio, 1);
  assert.ok(!pictures.at(-1).moving && !pictures.at(-1).coarse);
  assert.equal(frames(5000), 0);

  // A correction moves nodes and asks for no point again.
  const before = map.place('r2#1').clone();
  const {fetch} = globalThis;
  globalThis.fetch = () => assert.fail('points were asked for again');
  map.show(
    fleet({
      nodes: fleet().nodes.map((one) => (one.robot === 'r2' ? {...one, T: [one.T[0] + 3, ...one.T.slice(1)]} : one)),
    }),
  );
  await drawAll();
  assert.ok(
    map
      .place('r2#1')
      .clone()
      .sub(before)
      .distanceTo(new Vector3(3, 0, 0)) < 1e-9,
  );
  assert.equal(pictures.at(-1).drawn, 4 * 500);
  globalThis.fetch = fetch;

  // A place that is no number is none.
  map.show(fleet({nodes: [...fleet().nodes, node('r2', 9, [null, 0, 0])]}));
  assert.equal(map.place('r2#9'), undefined);
  map.show(fleet());

  // Time hides what came later; layers hide points; a pair is looked at alone.
  map.until = 0;
  map.remark();
  frames();
  assert.equal(pictures.at(-1).drawn, 2 * 500);
  assert.equal(map.hitAt(at('r1#1').x, at('r1#1').y, 3), undefined);
  map.until = Infinity;
  map.layers.points = false;
  map.remark();
  renderer.rendered.length = 0;
  frames();
  assert.equal(pictures.at(-1).drawn, 0);
  assert.equal(renderer.rendered.length, 1, 'lines alone');
  map.layers.points = true;
  map.showOnly(new Set([fleet().nodes[0].submap]));
  frames();
  assert.equal(pictures.at(-1).drawn, 500);
  map.showOnly(undefined);

  // Pictures of what arrives leave time to the page; one of what the user does is drawn at the next frame.
  frames(5000);
  renderer.cost = 80;
  map.draw();
  assert.equal(frames(), 1);
  map.show(fleet());
  map.show(fleet());
  assert.equal(frames(), 0, 'it rests');
  assert.equal(frames(1000), 1, 'one picture of both states');
  map.show(fleet());
  assert.equal(frames(), 0);
  map.select({node: 'r1#0'});
  assert.equal(frames(), 1);
  assert.equal(frames(5000), 0, 'the state was in that picture');
  renderer.cost = 0;

  // Robots that are gone take their points with them, and the plan tells that it is one.
  map.show(fleet({nodes: fleet().nodes.slice(0, 1), alignments: [], registrations: []}));
  map.eye.setPlanar(true);
  frames();
  await drawAll();
  assert.equal(pictures.at(-1).total, 500);
  assert.ok(pictures.at(-1).planar);
  assert.equal(map.place('r2#0'), undefined);
  assert.deepEqual(map.edges, []);
} finally {
  performance.now = now;
  globalThis.setTimeout = timers.set;
  globalThis.clearTimeout = timers.clear;
  globalThis.location = {search: ''};
}
