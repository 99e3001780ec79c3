// Bytes per second of a link over time (src/monitor/page/rate_chart.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(process.argv[2]);
const {RateChart} = await pageModule(process.argv[2], 'rate_chart');
const chart = new RateChart('bytes', () => 300, ['sent', 'received', 'may send']);
const drawn = FakePlot.shown.length;
chart.redraw();
assert.equal(FakePlot.shown.length, drawn, 'nothing came yet');

// The last five minutes, one series each of sent, received and the limit.
for (let k = 0; k < 400; ++k) chart.add(k, 10 * k, 20 * k, 5);
chart.draw();
const plot = FakePlot.shown.at(-1);
assert.deepEqual(
  plot.data.map((values) => [values.length, values[0], values.at(-1)]),
  [
    [300, 100, 399],
    [300, 1000, 3990],
    [300, 2000, 7980],
    [300, 5, 5],
  ],
);
assert.deepEqual(
  plot.options.series.map((one) => one.label),
  ['time', 'sent', 'received', 'may send'],
);
assert.equal(chart.root.querySelector('canvas').getAttribute('aria-label'), 'bytes');
chart.draw();
assert.equal(FakePlot.shown.at(-1), plot, 'a plot that is there is brought up to date');
chart.redraw();
assert.ok(plot.destroyed);

// As many lines as there are names; the whole of a run at once.
const free = new RateChart('bytes', () => 300, ['heard']);
free.replace([Array.from({length: 400}, (_, k) => k), Array(400).fill(7)]);
free.draw();
const whole = FakePlot.shown.at(-1);
assert.deepEqual(
  whole.options.series.map((one) => one.label),
  ['time', 'heard'],
);
assert.deepEqual(
  whole.data.map((values) => values.length),
  [400, 400],
);
