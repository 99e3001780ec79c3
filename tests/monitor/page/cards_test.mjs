// Descriptions of nodes and edges (src/monitor/page/cards.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule, three} from './page_module.mjs';
import {alignment, node, registration, state} from './states.mjs';

await openPage(process.argv[2]);
const {edgeCard, edgeOfRegistration, linkCard, nodeCard, pointCard, stepCard} = await pageModule(
  process.argv[2],
  'cards',
  'edges',
);
const {Vector3} = await three(process.argv[2]);
/** Heading, sentence and rows of a card. */
const content = (card) => {
  const list = card.find((one) => one.tagName === 'DL');
  const texts = [...list.children].map(textOf);
  const rows = Object.fromEntries(texts.flatMap((text, k) => (k % 2 === 0 ? [[text, texts[k + 1]]] : [])));
  return {heading: textOf(card[0]), sentence: textOf(card[1]), rows};
};

const shown = state({
  nodes: [
    node('r1', 0, [0, 0, 0], {gps_sigma_m: 0.256, bytes: 51_400}),
    node('r1', 75, [10, 0, 0], {submap: undefined}),
    node('r2', 0, [0, 10, 0], {submap: undefined, bytes: 0}),
  ],
  alignments: [
    alignment('r1#0', 'r2#0', 'used', {modes: 3}),
    alignment('r1#75', 'r1#0', 'unused'),
    alignment('r1#75', 'r2#0', 'unused'),
  ],
  registrations: [registration('r1#0', 'r2#0', 'accepted', {sentence: 'they fit'})],
});
const first = content(nodeCard(shown, 'r1#0', new Vector3(0, 0, 0)));
assert.equal(first.heading, 'Node r1#0');
assert.equal(first.rows.ENU, '0.00, 0.00, 0.00 m');
assert.match(first.rows.WGS84, /49\.0+.*8\.40+/);
assert.equal(first.rows.GPS, 'known to 0.26 m (1 σ) before alignment');
assert.equal(first.rows.submap, '51 kB, held');
assert.equal(first.rows.alignments, '2');
const floating = state({
  nodes: [node('r1', 0), node('r2', 0, [0, 10, 0], {floating: 1}), node('r2', 1, [0, 15, 0], {floating: 1})],
});
const nowhere = content(nodeCard(floating, 'r2#0', new Vector3(0, 10, 0))).rows;
assert.equal(nowhere.ENU, undefined, 'its place is an assumption');
assert.equal(nowhere.WGS84, undefined);
assert.equal(nowhere['on the map'], '0.00, 10.00, 0.00 m');
assert.match(nowhere['on Earth'], /^not known: no GPS fix/);
const across = content(edgeCard(floating, {kind: 'rejected', a: 'r1#0', b: 'r2#0'}, 10)).rows;
assert.match(across.nodes, /^distance not known/);
const within = content(edgeCard(floating, {kind: 'rejected', a: 'r2#0', b: 'r2#1'}, 5)).rows;
assert.equal(within.nodes, '5.00 m apart as placed');
const second = content(nodeCard(shown, 'r1#75', undefined)).rows;
assert.match(second.made, /^1:15 after the first node, by r1$|^1 min 15 s after the first node, by r1$/);
assert.equal(second.ENU, undefined, 'it has no place on the map');
assert.equal(second.GPS, 'none');
assert.equal(second.submap, 'not held here');
assert.equal(content(nodeCard(shown, 'r2#0', undefined)).rows.submap, 'empty');
assert.equal(nodeCard(shown, 'r9#0', undefined), null);

// A point has its own place and the node that it was seen from; a trajectory its two nodes.
const rowsOf = (card) =>
  Object.fromEntries([...card[1].querySelectorAll('dt')].map((one) => [textOf(one), textOf(one.nextElementSibling)]));
const point = pointCard(shown, 'r1#75', new Vector3(1, 2, 3));
assert.equal(textOf(point[0]), 'Point of the submap of node r1#75');
assert.equal(rowsOf(point).ENU, '1.00, 2.00, 3.00 m');
assert.match(rowsOf(point).made, /^1:15 after the first node, by r1$/);
assert.match(rowsOf(pointCard(floating, 'r2#0', new Vector3(0, 0, 0)))['on Earth'], /^not known/);
assert.equal(pointCard(shown, 'r9#0', new Vector3(0, 0, 0)), null);
const step = stepCard(shown, 'r1#0', 'r1#75', 10);
assert.equal(textOf(step[0]), 'Trajectory of r1');
assert.deepEqual(rowsOf(step), {
  from: 'r1#0',
  to: 'r1#75',
  driven: '0:00 to 1:15 after the first node',
  length: '10.0 m',
});
assert.equal(stepCard(shown, 'r1#0', 'r9#0', 10), null);

const edge = content(edgeCard(shown, {kind: 'used', a: 'r1#0', b: 'r2#0', registration: 0, alignment: 0}, 12.5));
assert.equal(edge.heading, 'Alignment in use: r2#0 → r1#0');
assert.equal(edge.sentence, 'they fit', 'the registration tells more than the alignment');
assert.match(edge.rows.nodes, /^12\.5.* m apart as placed$/);
assert.equal(edge.rows.poses, '3 fit');
const other = content(edgeCard(shown, {kind: 'unused', a: 'r1#75', b: 'r1#0', alignment: 1}, undefined));
assert.equal(other.heading, 'Alignment not used: r1#0 → r1#75');
assert.equal(other.sentence, 'r1#0 onto r1#75: unused');
assert.deepEqual(other.rows, {});
assert.equal(content(edgeCard(shown, {kind: 'rejected', a: 'a', b: 'b'}, 1)).sentence, '');

// Each card agrees with the verdict, whether its alignment is held or not.
const verdicts = ['accepted', 'ambiguous', 'rejected', 'failed'];
const fate = state({
  registrations: verdicts.map((verdict) => registration('r1#0', 'r2#0', verdict)),
  alignments: [alignment('r1#0', 'r2#0', 'used', {sentence: 'held'})],
});
const titles = verdicts.map((_, k) => content(edgeCard(fate, edgeOfRegistration(fate, k), 1)).heading);
for (const [k, verdict] of verdicts.entries()) {
  assert.match(titles[k], new RegExp(`^${verdict} registration`, 'i'));
  assert.equal(/alignment is not held here/.test(titles[k]), k < 2);
}
fate.registrations[1].alignment = 0;
const held = content(edgeCard(fate, edgeOfRegistration(fate, 1), 1));
assert.deepEqual([held.heading, held.sentence], ['Alignment in use: r2#0 → r1#0', 'r2#0 onto r1#0: ambiguous']);

// JSON has null for a sigma that is infinite.
const endless = state({nodes: [node('r1', 0, [0, 0, 0], {gps_sigma_m: null})]});
assert.equal(content(nodeCard(endless, 'r1#0', undefined)).rows.GPS, 'of unknown accuracy');

// A link between robots: of a running robot as it hears the other, of a run at a time.
const link = {from: 'r1', to: 'r2', quality: 'poor', text: 'Wi-Fi, 30 % lost'};
const live = linkCard(link, 'r1');
assert.equal(textOf(live[0]), 'Link of r1 and r2');
assert.equal(textOf(live[1]), 'stateWi-Fi, 30 % lostknownnow, as r1 hears it');
assert.match(textOf(linkCard(link)[1]), /at the time of the slider, by the worse of both ways$/);
