// Traffic of a run that is over (src/monitor/page/radio_history.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {heardLink, radioHistory, robot} from './states.mjs';

await openPage(process.argv[2], '<div id="radio">of a running robot</div>');
const {RadioHistoryPanel} = await pageModule(process.argv[2], 'radio_history');
const root = document.getElementById('radio');
const panel = new RadioHistoryPanel(root);
const robots = [robot('r1'), robot('r2'), robot('r3')];
const said = (name) => textOf(root.querySelector(`[data-of=${name}]`));
const table = (name) =>
  [...root.querySelectorAll(`[data-of=${name}] tbody tr`)].map((row) => [...row.children].map(textOf));
const plots = () => FakePlot.shown.filter((one) => !one.destroyed);

// Sums of all robots, the busiest time, a chart of each link, tables.
panel.show(
  radioHistory({
    step_s: 2,
    steps: 100,
    links: [
      heardLink('r2', 'r1', 'long_range', 100, {bytes: 1200, loss: 0.0123, received: {40: 300}}),
      heardLink('r1', 'r2', 'long_range', 100, {bytes: 800, delay_s: 0.2, received: {40: 200, 41: 400}}),
      heardLink('r1', 'r2', 'short_range', 100, {bytes: 3e6, received: {70: 1e6}}),
    ],
    kinds: [
      {link: 'long_range', kind: 'node', sent: 10, received: 20},
      {link: 'short_range', kind: 'submap_chunk', sent: 4000, received: 0},
    ],
  }),
  robots,
);
assert.equal(
  said('heard'),
  'In the last mission, 3:20 min, r1, r2 together heard 2.0 kB over the radio and 3.0 MB over Wi-Fi. ' +
    'Without r3, of which no link_trace.csv is here.',
);
assert.equal(
  said('busiest'),
  'The busiest, as the mean of 2 seconds: 500 B/s over the radio at 1:20, 1.0 MB/s over Wi-Fi at 2:20.',
);
assert.deepEqual(table('kinds'), [
  ['submap chunk', 'Wi-Fi', '4.0 kB', '0 B'],
  ['node', 'radio', '10 B', '20 B'],
]);
assert.deepEqual(table('peers'), [
  ['r2 to r1', 'radio', '1.2 kB', '1.2 %', '–'],
  ['r1 to r2', 'radio', '800 B', '10.0 %', '200 ms'],
  ['r1 to r2', 'Wi-Fi', '3.0 MB', '10.0 %', '–'],
]);
assert.deepEqual(
  plots().map(({data}) => [data[0].length, data[0][40], data[1][40]]),
  [
    [100, 80, 500],
    [100, 80, 0],
  ],
);

// Nobody hears the other link: no chart of it.
panel.show(radioHistory({steps: 1, links: [heardLink('r1', 'r2', 'long_range', 1, {received: [9]})]}), robots);
assert.equal(plots().length, 1);
assert.match(said('busiest'), /^The busiest, as the mean of 1 s: 9 B\/s over the radio at 0:00\.$/);

// A run in virtual time has its kinds alone, and does not count what is received.
panel.show(
  radioHistory({traces: [], kinds: [{link: 'long_range', kind: 'node', sent: 10, received: 0}]}),
  robots.slice(0, 2),
);
assert.match(said('heard'), /^No robot left a link_trace\.csv here.*virtual time/);
assert.equal(said('busiest'), '');
assert.deepEqual(table('kinds'), [['node', 'radio', '10 B', '–']]);
assert.equal(said('peers'), 'Not known.');
assert.equal(plots().length, 0);
const before = FakePlot.shown.length;
root.hidden = true;
panel.redraw();
assert.equal(FakePlot.shown.length, before, 'nothing is drawn that nobody sees');
