// The measuring tool (src/monitor/page/measure.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule, three} from './page_module.mjs';
import {state} from './states.mjs';

await openPage(process.argv[2], '<svg id="overlay"></svg>');
const {Measure} = await pageModule(process.argv[2], 'measure');
const {Vector3} = await three(process.argv[2]);
const overlay = document.getElementById('overlay');
let next = new Vector3(0, 0, 0);
let visible = true;
let floating;
const map = {
  pointAt: () => next && {p: next.clone(), submap: {floating}},
  project: (p) => (visible ? {x: 10 * p.x, y: 10 * p.y, depth: 0} : undefined),
};
let card;
const measure = new Measure(map, overlay, (content) => (card = content));
const text = () => card.map(textOf).join(' ');
const click = (...p) => {
  next = p.length > 0 ? new Vector3(...p) : undefined;
  measure.click(0, 0, 10, state().origin);
};
const shapes = () => [...overlay.children].map((one) => one.tagName.toLowerCase());

measure.start();
assert.match(text(), /Click two points/);
click();
assert.match(text(), /Click two points/, 'there is no point under the pointer');
click(0, 0, 1);
assert.match(text(), /A49\.0000000°, 8\.4000000°, 111\.00 mUTM 32N .*ENU 0\.00, 0\.00, 1\.00 m/);
assert.doesNotMatch(text(), /distance/);
assert.deepEqual(shapes(), ['circle', 'text']);
click(3, 4, -11);
assert.match(text(), /distance13\.0 mon the plan5\.00 mheight−12\.0 m/);
assert.deepEqual(shapes(), ['line', 'circle', 'text', 'circle', 'text']);
assert.deepEqual(
  ['x1', 'y1', 'x2', 'y2'].map((name) => overlay.firstElementChild.getAttribute(name)),
  ['0', '0', '30', '40'],
);
visible = false;
measure.draw();
assert.deepEqual(shapes(), [], 'behind the camera');
visible = true;
click(1, 1, 1);
assert.doesNotMatch(text(), /distance/, 'a third point begins anew');

// A frame that nothing ties to a place on Earth has no coordinates there, and no distance to another frame.
floating = 1;
click(4, 1, 1);
assert.match(text(), /BPlace on Earth not known: no GPS fix.*on the map 4\.00, 1\.00, 1\.00 m/);
assert.equal(text().match(/UTM/g).length, 1, 'of A alone');
assert.match(text(), /A to Bdistance not known/);
assert.doesNotMatch(text(), /on the plan|height/);
click(0, 0, 0);
click(0, 3, 0);
assert.doesNotMatch(text(), /UTM|°/);
assert.match(text(), /distance3\.00 m/, 'within one frame there is a distance');
measure.stop();
assert.equal(card, null);
assert.deepEqual(shapes(), []);
assert.equal(measure.active, false);
