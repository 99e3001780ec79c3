// Traffic of the radio (src/monitor/page/radio.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {live} from './states.mjs';

const page = await openPage(process.argv[2], '<div id="radio"></div>');
const {RadioPanel} = await pageModule(process.argv[2], 'radio');
const root = document.getElementById('radio');
const panel = new RadioPanel(root);
const show = (more) => panel.show(live([], {radio: {...live([]).radio, ...more}}));
const table = (name) =>
  [...root.querySelectorAll(`[data-of=${name}] tbody tr`)].map((row) => [...row.children].map(textOf));

show({backlog_bytes: 1500, backlog_s: 12, missing_submaps: 2, missing_bytes: 3e6, seconds_to_equal_map: 300});
assert.equal(
  textOf(root.querySelector('.headline')),
  'Long-range radio: r1 sends 500 B/s of 1.0 kB/s that it may (50 %) and receives 250 B/s; ' +
    'all robots together may send 20.0 kB/s. 1.5 kB wait, sent in 12 s.',
);
assert.match(
  textOf(root.querySelector('[data-of=maps]')),
  /^r1 lacks 2 submaps of the nodes that it holds \(3\.0 MB\); .* it has all in 5:00 min\.$/,
);
assert.match(textOf(root.querySelector('[data-of=access]')), /Anyone on the radios may join.*r1 has no keys/);
show({missing_submaps: 1, share: 0, who_may_join: 'members of the fleet'});
assert.match(textOf(root.querySelector('.headline')), /\(0 %\).*Nothing waits\./, 'no share is no division by zero');
assert.match(textOf(root.querySelector('[data-of=maps]')), /lacks 1 submap of .*none arrives now/);
assert.equal(textOf(root.querySelector('[data-of=access]')), 'Only members of the fleet may join.');

// The robot that will have as many submaps as the others last decides; counts do not show which these are.
const mapsOf = (maps) => {
  panel.show(live([], {maps: {...live([]).maps, ...maps}}));
  return textOf(root.querySelector('[data-of=fleet-maps]'));
};
assert.equal(
  mapsOf({}),
  "By the robots' own counts none lacks a submap. Counts do not show whether all hold the same submaps.",
);
assert.equal(
  mapsOf({last: 'r3', missing_submaps: 20, seconds_to_equal: 300}),
  "r3 will be the last to have the whole map: by the robots' own counts it lacks 20 submaps; " +
    'at the present rates it has all in 5:00 min.',
);
assert.equal(
  mapsOf({last: 'r3', missing_submaps: 20, seconds_to_equal: null, not_counted: ['r2', 'r4']}),
  "r3 will be the last to have the whole map: by the robots' own counts it lacks 20 submaps; " +
    'none arrived there lately. Without r2, r4, lost or not heard yet.',
);

// A phone's sideways scroll and the focus are on elements that stay.
const regions = [...root.querySelectorAll('.scroll')];
show({kinds: [{link: 'long_range', kind: 'status', sent: 10, received: 20}]});
assert.deepEqual([...root.querySelectorAll('.scroll')], regions);

// Kinds with most bytes first; robots; queues that hold or dropped something.
show({
  kinds: [
    {link: 'long_range', kind: 'status', sent: 10, received: 20},
    {link: 'short_range', kind: 'submap_chunk', sent: 4000, received: 0},
  ],
  peers: [
    {robot: 'r2', link: 'long_range', received: 250, loss: 0.125, delay_s: 0.2},
    {robot: 'r3', link: 'short_range', received: 0, loss: 0, delay_s: null},
  ],
  queues: [
    {priority: 'safety', waiting: 0, dropped: 0},
    {priority: 'bulk', waiting: 3, dropped: 1},
  ],
});
assert.deepEqual(table('kinds'), [
  ['submap chunk', 'Wi-Fi', '4.0 kB/s', '0 B/s'],
  ['status', 'radio', '10 B/s', '20 B/s'],
]);
assert.deepEqual(table('peers'), [
  ['r2', 'radio', '250 B/s', '12.5 %', '200 ms'],
  ['r3', 'Wi-Fi', '0 B/s', '0.0 %', '–'],
]);
assert.deepEqual(table('queues'), [['bulk', '3', '1']]);
assert.equal(
  textOf(root.querySelector('[data-of=wifi]')),
  'Wi-Fi: r1 sends 4.0 kB/s and receives 0 B/s, as the mean of the last seconds.',
);
const titles = [...root.querySelectorAll('h2')].map(textOf).slice(0, 2);
assert.deepEqual(titles, ['Bytes per second of r1 on the long-range radio', 'Bytes per second of r1 on Wi-Fi']);

// A plot of each link: of the radio with the share, of Wi-Fi without.
show({sent: 77, kinds: [{link: 'short_range', kind: 'submap_chunk', sent: 4000, received: 90}]});
const plotOf = (k) =>
  FakePlot.shown
    .filter((one) => !one.destroyed)
    [k].data.map((values) => values.at(-1))
    .slice(1);
assert.deepEqual(
  [plotOf(0), plotOf(1)],
  [
    [77, 250, 1000],
    [4000, 90],
  ],
);
const plots = FakePlot.shown.length;
panel.redraw();
assert.equal(FakePlot.shown.length, plots + 2);
root.hidden = true;
panel.redraw();
show({});
assert.equal(FakePlot.shown.length, plots + 2, 'nothing is drawn that nobody sees');
assert.equal(page.observers.length, 1);
