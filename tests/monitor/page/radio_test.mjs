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
  'Sends 500 B/s of 1.0 kB/s that it may (50 %); all robots together may send 20.0 kB/s. 1.5 kB wait, sent in 12 s.',
);
assert.match(
  textOf(root.querySelector('[data-of=maps]')),
  /^2 submaps are missing here \(3\.0 MB\); .* in 5:00 min\.$/,
);
assert.match(textOf(root.querySelector('[data-of=access]')), /Anyone on the radios may join.*r1 has no keys/);
show({missing_submaps: 1, share: 0, who_may_join: 'members of the fleet'});
assert.match(textOf(root.querySelector('.headline')), /\(0 %\).*Nothing waits\./, 'no share is no division by zero');
assert.match(textOf(root.querySelector('[data-of=maps]')), /none arrive now/);
assert.equal(textOf(root.querySelector('[data-of=access]')), 'Only members of the fleet may join.');

// The robot that will have as many submaps as the others last decides; counts do not show which these are.
const mapsOf = (maps) => {
  panel.show(live([], {maps: {...live([]).maps, ...maps}}));
  return textOf(root.querySelector('[data-of=fleet-maps]'));
};
assert.equal(
  mapsOf({}),
  'By their counts no robot holds fewer submaps; that they hold the same ones, counts do not show.',
);
assert.equal(
  mapsOf({last: 'r3', missing_submaps: 20, seconds_to_equal: 300}),
  'r3 will be the last: it counts 20 submaps fewer than there are nodes; ' +
    'at the present rates it has as many in 5:00 min.',
);
assert.equal(
  mapsOf({last: 'r3', missing_submaps: 20, seconds_to_equal: null, not_counted: ['r2', 'r4']}),
  'r3 will be the last: it counts 20 submaps fewer than there are nodes; ' +
    'none came there lately. Without r2, r4, lost or not heard yet.',
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

// The plot keeps the last five minutes, one series each of sent, received and share.
for (let k = 0; k < 400; ++k) show({sent: k});
const plot = FakePlot.shown.at(-1);
assert.equal(plot.data.length, 4);
assert.ok(plot.data.every((values) => values.length === 300));
assert.deepEqual([plot.data[1][0], plot.data[1].at(-1)], [100, 399]);
const plots = FakePlot.shown.length;
panel.redraw();
assert.equal(FakePlot.shown.length, plots + 1);
assert.ok(plot.destroyed);
root.hidden = true;
panel.redraw();
show({});
assert.equal(FakePlot.shown.length, plots + 1, 'nothing is drawn that nobody sees');
assert.equal(page.observers.length, 1);
