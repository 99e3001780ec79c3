// Colours of robots and lines (src/monitor/page/colours.ts).
import assert from 'node:assert/strict';
import {pageModule} from './page_module.mjs';

const {kEdgeColours, RobotColours} = await pageModule(process.argv[2], 'colours');
const channels = (colour) => [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));

/** Contrast of two colours after WCAG 2. */
function contrast(one, other) {
  const luminance = (colour) => {
    const [r, g, b] = channels(colour)
      .map((v) => v / 255)
      .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const [low, high] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (high + 0.05) / (low + 0.05);
}

// A robot that is heard later, and comes first by name, changes no colour.
const page = new RobotColours();
const alone = page.of(['r2']).get('r2');
const both = page.of(['r1', 'r2']);
assert.equal(both.get('r2'), alone);
assert.notEqual(both.get('r1'), alone);
page.of(['r1']);
assert.equal(page.of([]).get('r2'), alone, 'it is kept while the robot is silent');

// Pages of different robots agree on names with numbers; names without have a colour each.
assert.deepEqual(new RobotColours().of(['r1', 'r2']), new RobotColours().of(['r2', 'r1']));
assert.equal(new Set(new RobotColours().of(['anna', 'bert', 'r1', 'x1', 'x01']).values()).size, 5);

// Sixty robots differ, and ten stand out from both grounds of the map, as its lines do.
const many = [...new RobotColours().of(Array.from({length: 60}, (_, k) => `robot-${k + 1}`)).values()];
for (const [k, one] of many.entries()) {
  assert.match(one, /^#[0-9a-f]{6}$/);
  for (const other of many.slice(0, k))
    assert.ok(Math.hypot(...channels(one).map((v, c) => v - channels(other)[c])) > 8, `${one} is like ${other}`);
  assert.ok(contrast(one, '#e9edf1') >= 3, `${one} on the light map`);
}
for (const one of [...many.slice(0, 10), ...Object.values(kEdgeColours)])
  for (const ground of ['#e9edf1', '#0c1116']) assert.ok(contrast(one, ground) >= 3, `${one} on ${ground}`);
