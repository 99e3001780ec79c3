// The page's program (src/monitor/page/main.ts) with its own HTML and a map that only notes what it is told.
import assert from 'node:assert/strict';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {openPage, textOf} from './fake_page.mjs';
import {pageProgram, three} from './page_module.mjs';
import {alignment, live, node, registration, robot, robotNow, state} from './states.mjs';

const html = readFileSync(join(process.argv[2], 'index.html'), 'utf8');
await openPage(process.argv[2], html.match(/<body>([^]*)<script/)[1]);
const {Vector3} = await three(process.argv[2]);
const byId = (id) => document.getElementById(id);
const canvas = Object.assign(byId('canvas'), {clientWidth: 800, clientHeight: 400});
let socket;
globalThis.location = {search: '', host: 'robot:8080'};
globalThis.matchMedia = () => ({matches: false});
globalThis.navigator ??= {};
globalThis.screen = {width: 1366, height: 768};
globalThis.WebSocket = class {
  constructor() {
    socket = this;
  }
  close() {}
};
// Tries again at once; the watch for silence never ends.
const {setTimeout: real} = globalThis;
globalThis.setTimeout = (act, ms) => (ms === 500 ? act() : ms < 500 && real(act, ms));
const say = (content) => socket.onmessage({data: JSON.stringify(content)});
const fire = (target, type, more = {}) =>
  target.dispatchEvent(Object.assign(new window.Event(type, {cancelable: true}), more));
const calls = (globalThis.mapCalls = []);
/** Calls of the map since the last look, of these kinds. */
const told = (...names) => calls.splice(0).filter(([name]) => names.includes(name));
const pressed = (id) => byId(id).getAttribute('aria-pressed');
const card = () => (byId('card').hidden ? null : textOf(byId('card')));

await pageProgram(process.argv[2], {map: 'fake_map.mjs'});
const map = globalThis.fakeMap;
assert.deepEqual(told('budget'), [['budget', 1_500_000]], 'a desk draws more than a phone');
assert.match(textOf(byId('budget-value')), /1[.,]5/);

// The state: title, counts, the map, the panels; status shows a tab more.
const fleet = state({
  title: 'trial <3',
  nodes: [node('r1', 0), node('r1', 60, [10, 0, 0]), node('r2', 0, [0, 8, 0])],
  alignments: [alignment('r1#0', 'r2#0', 'used')],
  registrations: [registration('r1#60', 'r2#0', 'rejected'), registration('r1#0', 'r2#0', 'accepted')],
});
assert.ok(byId('tab-radio').hidden);
say({live: live([robotNow('r1')])});
assert.ok(!byId('tab-radio').hidden);
assert.equal(textOf(byId('summary')), '1 robot · no nodes yet');
say(fleet);
assert.equal(textOf(byId('title')), 'trial <3');
assert.equal(textOf(byId('summary')), '2 robots · 3 nodes · 1 alignment');
const shown = told('show');
assert.equal(shown.length, 1);
assert.notEqual(shown[0][1].colours.get('r1'), shown[0][1].colours.get('r2'));
assert.match(textOf(byId('why')), /r1 and r2: why/);
say({live: live([robotNow('r1'), robotNow('r2')])});
assert.equal(textOf(byId('summary')), '2 robots · 3 nodes · 1 alignment', 'a status leaves the counts');
socket.onclose();
assert.match(textOf(byId('connection')), /lost/);
assert.equal(textOf(byId('summary')), '2 robots · 3 nodes · 1 alignment', 'the last state is shown');
say(fleet);
assert.equal(textOf(byId('connection')), '');

// A click on the map: what is there; a drag selects nothing.
for (const {id, T} of fleet.nodes) map.places.set(id, new Vector3(...T));
const click = (x = 50, to = x) => {
  fire(canvas, 'pointerdown', {offsetX: x, offsetY: 50});
  fire(canvas, 'pointerup', {offsetX: to, offsetY: 50, pointerType: 'mouse'});
};
map.hit = {node: 'r1#60'};
click(50, 90);
assert.equal(card(), null);
told();
click();
assert.match(card(), /Node r1#60.*10\.00, 0\.00, 0\.00 m/);
assert.deepEqual(told('select', 'goTo'), [['select', {node: 'r1#60'}]], 'the view stays');
map.hit = {edge: {kind: 'used', a: 'r1#0', b: 'r2#0', alignment: 0, registration: 1}};
click();
assert.match(card(), /Alignment in use: r2#0 → r1#0.*8\.0+ m apart/);
byId('card').querySelector('.close').onclick();
assert.equal(card(), null);
assert.deepEqual(told('select').at(-1), ['select', undefined]);

// An open card tells what the newest state has of it.
click();
const contradicts = {status: 'against_gps', sentence: 'it contradicts GPS'};
say({
  ...fleet,
  alignments: [alignment('r1#0', 'r2#0', 'against_gps')],
  registrations: [fleet.registrations[0], {...fleet.registrations[1], alignment: 0, ...contradicts}],
});
assert.match(card(), /Alignment not used: r2#0 → r1#0.*it contradicts GPS/);
say(fleet);
assert.doesNotMatch(card(), /contradicts/);
map.hit = undefined;
click();
assert.equal(card(), null);

// A registration of the panel is marked, described and brought into view, also if the map has no edge for it.
byId('verdict-all')?.onclick?.();
const rows = [...document.querySelectorAll('.registration')];
assert.ok(rows.length > 0, 'the panel lists registrations');
told();
rows[0].onclick();
assert.match(card(), /r2#0 → r1#/);
assert.equal(told('goTo').length, 1);

// Keys of the map, and none with a modifier.
const key = (name, more = {}) => fire(canvas, 'keydown', {key: name, ...more});
told();
for (const name of ['ArrowLeft', 'ArrowUp', '+', '-', 'f']) key(name);
assert.deepEqual(told('pan', 'zoom', 'fit'), [['pan', -1, 0], ['pan', 0, 1], ['zoom', 1.25], ['zoom', 0.8], ['fit']]);
key('f', {ctrlKey: true});
key('x');
assert.deepEqual(told('fit'), []);
key('p');
assert.deepEqual([map.eye.planar, pressed('view-plan'), pressed('view-3d')], [true, 'true', 'false']);
byId('view-3d').onclick();
assert.deepEqual([map.eye.planar, pressed('view-plan'), pressed('view-3d')], [false, 'false', 'true']);
key('m');
assert.equal(pressed('measure'), 'true');
assert.match(card(), /Click two points/);
const points = [new Vector3(0, 0, 0), new Vector3(3, 4, 0)];
map.pointAt = (x, y) => {
  const p = x === canvas.clientWidth / 2 && y === canvas.clientHeight / 2 ? points.shift() : undefined;
  return p && {p, submap: {}};
};
key('Enter');
key('Enter');
assert.match(card(), /distance5\.00 m/, 'measured by keys alone');
key('Enter');
assert.match(textOf(byId('said')), /No point is at the cross/);
key('Escape');
assert.deepEqual([pressed('measure'), card()], ['false', null]);

// Every node is reached by keys, and what is under the cross.
const visited = ['n', 'n', 'n', 'n', 'b'].map((name) => {
  key(name);
  return card().match(/Node (\S+?) ?made/)?.[1] ?? card();
});
for (const [k, id] of ['r1#0', 'r1#60', 'r2#0', 'r1#0', 'r2#0'].entries()) assert.match(visited[k], new RegExp(id));
assert.equal(told('goTo').length, 5);
map.hit = {node: 'r1#60'};
key('Enter');
assert.match(card(), /Node r1#60/);
map.hit = undefined;
key('Enter');
assert.equal(card(), null);
assert.match(textOf(byId('said')), /Nothing is at the cross/);

// Tools: colours, layers, the budget, time.
told();
document.querySelector('[data-colour=height]').onclick();
assert.deepEqual(told('setColour'), [['setColour', 'height']]);
assert.equal(document.querySelector('[data-colour=robot]').getAttribute('aria-pressed'), 'false');
byId('layer-nodes').onchange({target: {checked: false}});
assert.equal(told('remark')[0][2].nodes, false);
byId('budget').value = '5';
byId('budget').oninput();
assert.deepEqual(told('budget'), [['budget', 100_000]]);
byId('time').value = '500';
byId('time').oninput();
assert.equal(told('remark').at(-1)[1], 30, 'half of the minute');
assert.match(byId('time').getAttribute('aria-valuetext'), /30/);
say({...fleet, nodes: [...fleet.nodes, node('r2', 240, [0, 9, 0])]});
assert.equal(told('remark').at(-1)[1], 30, 'the mission goes on, the time that is shown stays');
assert.equal(byId('time').value, '125');
say({...fleet, nodes: [...fleet.nodes, node('r2', 1e9, [0, 9, 0])]});
assert.match(textOf(byId('fleet')), /11,57\d days without any node are left out/);
say(fleet);
told();
byId('time').value = '1000';
byId('time').oninput();
assert.equal(told('remark').at(-1)[1], Infinity, 'all that is there and that comes');

// The words about a picture wait until the view stands still.
const picture = (more) =>
  map.onPicture({
    drawn: 200,
    total: 1000,
    loading: true,
    moving: false,
    coarse: false,
    metresPerPixel: 0.1,
    planar: false,
    heights: [1, 5],
    range: [0, 60],
    ...more,
  });
picture({});
assert.match(textOf(byId('drawn')), /200 of 1[ ,.]?000 points drawn, loading/);
assert.equal(canvas.dataset.loading, 'true');
assert.match(canvas.getAttribute('aria-label'), /Map of trial <3: 3D view/);
assert.equal(textOf(byId('scale')), '10 m');
picture({metresPerPixel: 1e-6});
assert.ok(byId('scale').hidden, 'no scale of 0 cm');
picture({});
assert.ok(!byId('scale').hidden);
assert.match(textOf(byId('legend')), /r1.*r2.*1\.0 m.*5\.0 m/);
say({...fleet, robots: [robot('r1'), robot('r2', {sessions_not_georeferenced: 1})]});
picture({});
assert.match(textOf(byId('legend')), /r1.*r2 \(not georeferenced\)/);
say(fleet);
picture({});
assert.doesNotMatch(textOf(byId('legend')), /georeferenced/);
byId('layer-robots').onchange({target: {checked: false}});
assert.equal(byId('robots').children.length, 0);
byId('layer-robots').onchange({target: {checked: true}});
map.edges = [{kind: 'unused'}, {kind: 'used'}];
picture({});
assert.match(textOf(byId('legend')), /alignment in usealignment not used/);
assert.doesNotMatch(textOf(byId('legend')), /rejected/);
picture({drawn: 300, moving: true, loading: false, planar: true});
assert.equal(canvas.dataset.drawn, '300');
assert.match(textOf(byId('drawn')), /200 of/);

// On a slow machine robots' marks and measures are hidden while the map moves, and are drawn when it stands still.
const hidden = () => byId('map').classList.contains('coarse');
let projected = 0;
map.project = () => void ++projected;
assert.ok(!hidden());
picture({moving: true, coarse: true});
assert.ok(hidden());
assert.equal(projected, 0);
picture({drawn: 300, loading: false, planar: true});
assert.ok(!hidden());
assert.ok(projected > 0);
assert.match(textOf(byId('drawn')), /300 of 1[ ,.]?000 points drawn$/);
assert.match(canvas.getAttribute('aria-label'), /plan view/);

// The pointer shows what a click would do.
const pointer = () => {
  fire(canvas, 'pointermove', {buttons: 0, offsetX: 1, offsetY: 1});
  return canvas.style.cursor;
};
assert.equal(pointer(), 'grab');
map.hit = {node: 'r1#0'};
assert.equal(pointer(), 'pointer');
globalThis.setTimeout = real;
