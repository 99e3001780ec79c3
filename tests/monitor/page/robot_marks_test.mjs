// Robots and links on the map (src/monitor/page/robot_marks.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {heardLink, live, node, radioHistory, robot, robotNow, state} from './states.mjs';

await openPage(process.argv[2], '<svg id="robots"></svg>');
const {ellipseOf, RobotMarks} = await pageModule(process.argv[2], 'robot_marks');
const overlay = document.getElementById('robots');
let behind = -1; // x of what the camera does not see
const map = {project: (p) => (p.x === behind ? undefined : {x: 10 * p.x, y: -10 * p.y, depth: 0})};
const marks = new RobotMarks(map, overlay);
const all = (selector) => [...overlay.querySelectorAll(selector)];
const marksOf = (id) => overlay.querySelector(`[data-mark=${id}]`);
const labels = () => all('text.robot-name').map((one) => one.textContent);

const north = Math.SQRT1_2; // of a quaternion that turns by 90 degrees
const fleet = state({
  robots: [robot('r1', {last_node: 'r1#5', covariance_m2: [4, 0, 1]}), robot('r2', {last_node: 'r2#4'}), robot('r3')],
  nodes: [
    node('r1', 5, [20, 0, 0], {T: [20, 0, 0, 0, 0, north, north]}),
    node('r1', 1, [1, 0, 0]),
    node('r2', 4, [20, 20, 0]),
    node('r3', 9, [0, 0, 0], {T: undefined}),
  ],
});

// Each robot that has a place is at its last node, turned as it was there, with its name and colour.
marks.show(fleet, Infinity);
assert.deepEqual(labels(), ['r1', 'r2']);
assert.equal(marksOf('r1').getAttribute('transform'), 'translate(200.0 0.0) rotate(-90.0)', 'north is up');
assert.equal(marksOf('r2').getAttribute('transform'), 'translate(200.0 -200.0) rotate(0.0)');
assert.match(marksOf('r2').getAttribute('style'), /#d05a1b/);
assert.equal(all('line').length, 0, 'nothing was heard yet');
assert.equal(all('polygon').length, 1, 'one covariance is known');

// Links go from the robot that shows the page to those that it heard.
marks.showLive(live([robotNow('r1'), robotNow('r2', {heard: [{link: 'long_range', seconds_ago: 1}]}), robotNow('r3')]));
assert.deepEqual(
  all('line.link').map((one) => ['class', 'x1', 'y1', 'x2', 'y2'].map((name) => one.getAttribute(name))),
  [['link good', '200', '0', '200', '-200']],
);
assert.deepEqual(
  all('text.link').map((one) => one.textContent),
  ['heard 1 s ago'],
);
overlay.clientWidth = 210;
marks.draw();
assert.equal(overlay.querySelector('text.link').getAttribute('x'), '148.0', 'the side of the map does not cut it');
marks.showLive(live([robotNow('r1'), robotNow('r2', {heard: [{link: 'long_range', seconds_ago: 90}]})]));
assert.equal(all('line.link.silent').length, 1);
assert.deepEqual(labels(), ['r1', 'r2 (lost)']);

// Words that would lie on others are left out; their lines stay.
const beside = state({nodes: [node('r1', 0), node('r2', 0, [20, 20, 0]), node('r3', 0, [20, 20.5, 0])]});
const said = [{link: 'long_range', seconds_ago: 1}];
marks.show(beside, Infinity);
marks.showLive(live([robotNow('r1'), robotNow('r2', {heard: said}), robotNow('r3', {heard: said})]));
assert.deepEqual([all('line.link').length, all('text.link').length], [2, 1]);
marks.showLive(live([robotNow('r1'), robotNow('r2', {heard: [{link: 'long_range', seconds_ago: 90}]})]));

// Names of robots at one place are above each other.
marks.show(state({nodes: [node('r1', 0, [5, 5, 0]), node('r2', 0, [5, 5, 0])]}), Infinity);
const [lower, upper] = all('text.robot-name').map((one) => Number(one.getAttribute('y')));
assert.ok(lower - upper >= 15, `${lower} and ${upper}`);

// A running robot is where its last status has it, moved and turned as alignments moved its last node.
const aligned = state({
  nodes: [node('r1', 0, [5, 5, 0], {T: [5, 5, 0, 0, 0, north, north], gps: [4, 5, 0, 0, 0, 0, 1]})],
});
const origin = aligned.origin;
marks.show(aligned, Infinity);
const status = (place) => marks.showLive(live([robotNow('r1', {place})], {}));
const here = [origin.latitude_deg, origin.longitude_deg, origin.altitude_m, 0];
status([...here, 1001]);
assert.equal(
  marksOf('r1').getAttribute('transform'),
  'translate(100.0 -10.0) rotate(-90.0)',
  'it is 4 m west and 5 m south of its node by its EKF, which the map has turned by 90 degrees',
);
marks.show(aligned, 10);
assert.equal(marksOf('r1').getAttribute('transform'), 'translate(50.0 -50.0) rotate(-90.0)', 'as it was then');
marks.show(state({nodes: [node('r1', 0, [5, 5, 0])]}), Infinity);
assert.equal(marksOf('r1').getAttribute('transform'), 'translate(50.0 -50.0) rotate(0.0)', 'nothing ties it to ENU');
marks.show(aligned, Infinity);
for (const [place, why] of [
  [null, 'not known'],
  [[...here, 999], 'the node is newer'],
  [[...here, 1601], 'the clocks are others'],
]) {
  status(place);
  assert.equal(marksOf('r1').getAttribute('transform'), 'translate(50.0 -50.0) rotate(-90.0)', why);
}

// At an earlier time robots are where they were; links are of the present.
marks.show(fleet, 3);
assert.deepEqual(labels(), ['r1']);
assert.equal(marksOf('r1').getAttribute('transform'), 'translate(10.0 0.0) rotate(0.0)');
assert.equal(all('line, polygon').length, 0);
marks.show(fleet, Infinity);
behind = 20;
marks.draw();
assert.equal(overlay.children.length, 0, 'behind the camera');
behind = -1;
marks.shown = false;
marks.draw();
assert.equal(overlay.children.length, 0);

// The ellipse holds 95 % and lies along the axis of the larger variance.
const reach = (C, axis) => Math.max(...ellipseOf(C).map((corner) => corner[axis]));
assert.ok(Math.abs(reach([4, 0, 1], 0) - 2 * 2.4477) < 1e-6);
assert.ok(Math.abs(reach([4, 0, 1], 1) - 2.4477) < 1e-6);
const diagonal = ellipseOf([2, 1.9, 2]);
const furthest = diagonal.reduce((a, b) => (Math.hypot(...b) > Math.hypot(...a) ? b : a));
assert.ok(Math.abs(furthest[0] - furthest[1]) < 1e-6, 'xx = yy and a positive xy: along the diagonal');
assert.ok(ellipseOf([0, 0, 0]).every((corner) => Math.hypot(...corner) === 0));

// A run has the links of the time that is shown, between any two robots.
const run = new RobotMarks(map, overlay);
const links = [
  heardLink('r1', 'r2', 'long_range', 10, {loss_in: {0: 0, 5: 1}}),
  heardLink('r3', 'r2', 'long_range', 10, {loss_in: {6: 0.5}}),
];
const logged = {
  ...beside,
  nodes: [...beside.nodes, node('r3', 9, [20, 20.5, 0])],
  radio: radioHistory({begin_s: 0, steps: 10, links, traces: ['r2']}),
};
const ends = () => all('line.link').map((one) => `${one.getAttribute('class')} ${one.getAttribute('y1')}`);
run.show(logged, 2);
assert.deepEqual(ends(), ['link good 0']);
run.show(logged, Infinity);
assert.deepEqual(ends(), ['link poor -205']);
assert.ok(labels().every((one) => !one.includes('lost')));
assert.deepEqual([...run.qualities], ['poor'], 'the legend names what is drawn');

// A link is found where its line is.
assert.equal(run.linkAt(200, -202, 10)?.text, 'radio, 50 % lost');
assert.equal(run.linkAt(100, -100, 10), undefined);
run.show(beside, Infinity);
assert.deepEqual(ends(), []);
assert.equal(run.qualities.size, 0);
assert.equal(run.linkAt(200, -202, 10), undefined);
