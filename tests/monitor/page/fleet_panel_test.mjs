// The robots' maps and who holds them (src/monitor/page/fleet_panel.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {live, node, pair, robot, robotNow, state} from './states.mjs';

await openPage(process.argv[2], '<div id="fleet"></div>');
const {FleetPanel} = await pageModule(process.argv[2], 'fleet_panel');
const root = document.getElementById('fleet'),
  now = document.createElement('section');
const chosen = [];
const panel = new FleetPanel(root, {selectNode: (id) => chosen.push(id)}, now);
const holding = (holder, maker, nodes, submaps) => ({holder, maker, nodes, submaps, alignments: 0});
const fleet = state({
  robots: [
    robot('r1', {first_s: 0, last_s: 61, last_node: 'r1#1', sigma_m: 0.021, alignments_used: 3}),
    robot('r2', {sessions: 2, quarantined: true, sessions_not_georeferenced: 1}),
    robot('r3', {nodes: 0}),
  ],
  nodes: [node('r1', 0), node('r2', 1), node('r1', 2)],
  pairs: [pair('r1', 'r2', true), pair('r1', 'r3', false), pair('r2', 'r3', false)],
  holdings: [holding('r1', 'r1', 4, 4), holding('r2', 'r2', 4, 3), holding('r1', 'r2', 2, 1)],
  notes: ['a file is missing'],
});
panel.show(fleet);
assert.equal(root.firstElementChild, now, 'what the robots do now stays above');
const cards = [...root.querySelectorAll('article')].map(textOf);
assert.match(
  cards[0],
  /r1joined with r2its map is shown2 nodes on 12\.3 m of path, from 0:00 to 1:01\. Last at r1#1, known to 0\.02 m/,
);
assert.match(cards[0], /0\.02 m \(1 σ\) in the graph\. 3 of its alignments are in use, 0 contradict\./);
assert.match(cards[1], /joined with r11 of 2 sessions not georeferencedquarantined.*, in 2 sessions/);
assert.match(cards[2], /joined with nobody.*made no node that is held here/);
root.querySelector('article button').click();
assert.deepEqual(chosen, ['r1#1']);
assert.equal(textOf(root.querySelector('.note')), 'a file is missing');

// JSON has null for a sigma that is infinite.
panel.show({...fleet, robots: [{...fleet.robots[0], sigma_m: null}]});
assert.match(textOf(root.querySelector('article')), /Last at r1#1\./);
panel.show(fleet);

// A newer state leaves what has the focus, and the scroll of the matrix, where they are.
const kept = () => [root.querySelector('article button'), root.querySelector('.scroll')];
const before = kept();
panel.show({...fleet, notes: [], robots: [{...fleet.robots[0], path_m: 20}, ...fleet.robots.slice(1)]});
assert.deepEqual(kept(), before);
assert.match(textOf(root.querySelector('article')), /on 20\.0 m of path/);
panel.show(fleet);

// The matrix of holdings: shares are of the most that anyone holds.
const cells = [...root.querySelectorAll('.holdings tbody td')].map((one) => [
  textOf(one),
  one.querySelector('i').style.width,
]);
assert.deepEqual(cells, [
  ['4 / 4', '100.0%'],
  ['2 / 1', '25.0%'],
  ['–', '0.0%'],
  ['0 / 0', '0.0%'],
  ['4 / 3', '75.0%'],
  ['–', '0.0%'],
]);

// Robots whose stores are elsewhere have a row of what they report, which follows their statuses.
const totals = () =>
  [...root.querySelectorAll('.holdings tbody:last-child tr')].map((row) => [
    textOf(row),
    row.querySelector('.fill i').style.width,
    row.querySelector('td').getAttribute('title'),
  ]);
assert.deepEqual(totals(), []);
const held = (id, nodes, submaps) => robotNow(id, {nodes, submaps});
panel.showNow(live([held('r1', 4, 4), held('r2', 4, 3), held('r3', 8, 2), held('r4', 0, 0)]));
assert.deepEqual(totals(), [
  ['r38 / 2 of all robots, as it reports', '25.0%', 'r3 lacks 0 nodes and 6 submaps of 8 in all'],
]);
const table = root.querySelector('.holdings');
panel.showNow(live([held('r1', 10, 4), held('r3', 8, 5)]));
assert.deepEqual(totals(), [
  ['r38 / 5 of all robots, as it reports', '50.0%', 'r3 lacks 2 nodes and 5 submaps of 10 in all'],
]);
assert.equal(root.querySelector('.holdings'), table, 'the table itself stays');
panel.show(fleet);
assert.equal(totals().length, 1, 'a newer state keeps them');

// Nodes over time are counted per robot at the times of all.
const plot = FakePlot.shown.at(-1);
assert.deepEqual(plot.data, [
  [0, 1, 2],
  [1, 1, 2],
  [0, 1, 1],
  [0, 0, 0],
]);
assert.deepEqual(
  plot.options.series.slice(1).map((one) => one.label),
  ['r1', 'r2', 'r3'],
);
panel.show(fleet);
assert.ok(plot.destroyed, 'a newer state has one plot');
panel.show(state({nodes: [], robots: [robot('r1')], pairs: []}));
assert.match(textOf(root.querySelector('article')), /r1alone/);

// The status came before the state.
const early = document.createElement('div');
const opened = new FleetPanel(early, {selectNode() {}}, document.createElement('section'));
opened.showNow(live([held('r3', 8, 2)]));
opened.show(fleet);
assert.match(textOf(early.querySelector('.holdings')), /8 \/ 2 of all robots/);
