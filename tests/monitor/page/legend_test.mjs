// Scale and ramp beside the map (src/monitor/page/legend.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(process.argv[2]);
const {edgeKeys, linkKeys, rampEnds, rampKey, scaleLength} = await pageModule(process.argv[2], 'legend');

// A round number that takes 44 to 110 pixels, whatever the zoom.
for (let metresPerPixel = 1e-3; metresPerPixel < 100; metresPerPixel *= 1.07) {
  const length = scaleLength(metresPerPixel);
  const pixels = length / metresPerPixel;
  assert.ok(pixels <= 110 + 1e-9 && pixels >= 43.9, `${length} m takes ${pixels} pixels`);
  assert.match(length.toExponential(), /^[125](\.0*)?e|^(1\.9{5}|4\.9{5}|9\.9{5})/, 'a round number');
}
assert.equal(scaleLength(1), 100);
assert.equal(scaleLength(0.99), 100);
assert.equal(scaleLength(0.9), 50);

const picture = {heights: [-1.26, 7], range: [0.5, 125]};
assert.deepEqual(rampEnds(picture, 'height'), ['-1.3 m', '7.0 m']);
assert.deepEqual(rampEnds(picture, 'age'), ['0:01', '2:05']);
assert.deepEqual(rampEnds(picture, 'sigma'), ['0.50 m', '125.0 m']);
assert.deepEqual(rampEnds(picture, 'intensity'), ['weak', 'strong']);

assert.equal(rampKey(picture, 'robot'), null);
assert.equal(textOf(rampKey(picture, 'sigma')), 'Place, 1 sigma, horizontal: 0.50 m125.0 m');
assert.equal(textOf(rampKey(picture, 'height')), 'Height: -1.3 m7.0 m');

const edges = edgeKeys(['used', 'rejected']);
assert.deepEqual(edges.map(textOf), ['alignment in use', 'rejected registration']);
assert.ok(edges[1].querySelector('.key.rejected'));
// Links have keys for what is drawn alone; the legend says whose they are, unless they are all.
const keys = (drawn, of) => linkKeys(new Set(drawn), of).map(textOf);
assert.deepEqual(keys(['silent', 'good'], {running: 'r1'}), ['heard by r1', 'lost', '(links of r1 alone)']);
assert.deepEqual(keys([], {running: 'r1'}), []);
assert.deepEqual(keys(['good', 'poor'], {traces: ['r1', 'r2'], all: true}), ['heard then', 'a fifth lost, or one way']);
assert.deepEqual(keys(['good'], {traces: ['r2', 'r3'], all: false}), ['heard then', '(links of r2, r3 alone)']);
