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

// Sums of all traces, the busiest time, a chart of each link, tables.
panel.show(
  radioHistory({
    begin_s: -20,
    step_s: 2,
    steps: 100,
    links: [
      heardLink('r2', 'r1', 'long_range', 100, {bytes: 1200, loss: 0.25, messages: 3, received: {40: 300}}),
      heardLink('r1', 'r2', 'long_range', 100, {bytes: 800, delay_s: 0.2, received: {40: 200, 41: 400}}),
      heardLink('r1', 'r2', 'short_range', 100, {
        bytes: 3e6,
        messages: 500,
        loss: 0.0123,
        delay_s: 1e-4,
        loss_in: {70: 0},
        received: {4: 1e6},
      }),
    ],
    kinds: [
      {link: 'long_range', kind: 'node', sent: 10, received: 20},
      {link: 'long_range', kind: 'hold', sent: 0, received: 0},
      {link: 'short_range', kind: 'submap_chunk', sent: 4000, received: 0},
    ],
  }),
  robots,
);
assert.equal(
  said('heard'),
  'In the last mission, 3:20 min, r1, r2 together heard 2.0 kB over the radio and 3.0 MB over Wi-Fi, ' +
    'in whole packets. Without r3, of which no link_trace.csv is here.',
);
assert.equal(
  said('busiest'),
  'The busiest, as the mean of 2 seconds: 500 B/s over the radio at 1:00, 1.0 MB/s over Wi-Fi at -0:12.',
  'times of the slider',
);
assert.deepEqual(table('kinds'), [
  ['submap chunk', 'Wi-Fi', '4.0 kB', '0 B'],
  ['node', 'radio', '10 B', '20 B'],
]);
assert.deepEqual(table('peers'), [
  ['r2 to r1', 'radio', '1.2 kB', '3', '1 of 4', '–'],
  ['r1 to r2', 'radio', '800 B', '10', '1 of 11', '200 ms'],
  ['r1 to r2', 'Wi-Fi', '3.0 MB', '500', '1.2 %', '< 1 ms'],
  ['r3 to r1', 'radio', 'nothing', '0', '–', '–'],
  ['r3 to r2', 'radio', 'nothing', '0', '–', '–'],
]);
assert.deepEqual(
  plots().map(({data}) => [data[0].length, data[0][40], data[1][40]]),
  [
    [100, 60, 500],
    [100, 60, 0],
  ],
);
assert.deepEqual(
  [...root.querySelectorAll('h2')].map(textOf).slice(0, 3),
  [
    'Bytes per second that r1, r2 heard over the radio',
    'Bytes per second that r1, r2 heard over Wi-Fi',
    'By kind of message, payload since the last start of r1, r2',
  ],
);

// The links of the time of the slider in words, which a screen reader has, too.
panel.showTime(121);
assert.equal(said('links'), 'Links at 2:01: r1 and r2: Wi-Fi, r2 alone hears the other.');
panel.showTime(20);
assert.equal(said('links'), 'Links at 0:20: none is logged.');

// Nobody hears the other link: no chart of it. The nodes have another clock: no links at a time of the slider.
panel.show(
  radioHistory({traces: ['r1'], steps: 1, links: [heardLink('r2', 'r1', 'long_range', 1, {received: [9]})]}),
  robots,
);
panel.showTime(0);
assert.equal(plots().length, 1);
assert.match(said('heard'), /, r1 heard .*Without r2, r3.*Times are from the first line/);
assert.match(said('busiest'), /^The busiest, as the mean of 1 s: 9 B\/s over the radio at 0:00\.$/);
assert.ok(root.querySelector('[data-of=links]').hidden);

// A run in virtual time has its kinds alone, and does not count what is received.
panel.show(
  radioHistory({traces: [], kinds: [{link: 'long_range', kind: 'node', sent: 10, received: 0}]}),
  robots.slice(0, 2),
);
assert.match(said('heard'), /^No robot left a link_trace\.csv here.*virtual time/);
assert.equal(said('busiest'), '');
assert.deepEqual(table('kinds'), [['node', 'radio', '10 B']]);
assert.equal(root.querySelector('[data-of=peers]'), null);
assert.equal(plots().length, 0);
const before = FakePlot.shown.length;
root.hidden = true;
panel.redraw();
assert.equal(FakePlot.shown.length, before, 'nothing is drawn that nobody sees');
