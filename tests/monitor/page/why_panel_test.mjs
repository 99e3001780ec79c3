// Registrations and what joins each pair (src/monitor/page/why_panel.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {alignment, live, pair, registration, robot, state} from './states.mjs';

await openPage(process.argv[2], '<div id="why"></div>');
const {WhyPanel} = await pageModule(process.argv[2], 'why_panel');
const root = document.getElementById('why');
const chosen = [];
const actions = {
  selectNode: (id) => chosen.push(id),
  selectRegistration: (index) => {
    chosen.push(index);
  },
};
const panel = new WhyPanel(root, actions);
const shown = () => [...root.querySelectorAll('.registration .who')].map((one) => one.textContent);
const chip = (name) => root.querySelector(`#verdict-${name}`);
const fleet = state({
  robots: [robot('r1'), robot('r2'), robot('r3')],
  alignments: [alignment('r1#0', 'r2#0', 'used')],
  registrations: [
    registration('r1#0', 'r2#0', 'accepted'),
    registration('r1#0', 'r3#0', 'rejected'),
    registration('r3#1', 'r1#1', 'rejected'),
    registration('r2#0', 'r3#0', 'failed'),
  ],
  pairs: [
    pair('r1', 'r2', true, {used: 1, attempts: 1}),
    pair('r1', 'r3', false, {attempts: 2, nearest_m: 3.21, nearest: ['r1#1', 'r3#1']}),
    pair('r2', 'r3', false, {attempts: 1}),
  ],
});
panel.show(state({robots: [], pairs: []}));
assert.equal(root.querySelector('.answer'), null, 'a page that is opened early has no pair yet');
panel.show(fleet);

// It begins with the first pair that is not joined, and answers why.
assert.equal(textOf(root.querySelector('.headline')), '2 of 3 pairs of robots are not joined.');
assert.match(
  textOf(root.querySelector('.answer')),
  /Why are r1 and r3 not joined\?.*r1 and r3: why.*nearest nodes 3\.21 m apart/,
);
assert.deepEqual(shown(), ['r3#0 → r1#0', 'r1#1 → r3#1']);
root.querySelector('.facts button').click();
assert.deepEqual(chosen, ['r1#1']);

// Filters: of the pair, its verdicts, one robot. Numbers on the chips are of what the other filters let through.
assert.equal(textOf(chip('rejected')), 'Rejected2');
assert.equal(chip('accepted'), null, 'there is none to choose');
root.querySelector('#pair-r1-r3').click();
assert.equal(root.querySelector('.answer'), null);
assert.deepEqual(shown().length, 4);
assert.equal(textOf(chip('rejected')), 'Rejected2');
chip('failed').click();
assert.deepEqual(shown(), ['r3#0 → r2#0']);
root.querySelector('#pair-r1-r2').click();
assert.deepEqual(shown(), [], 'none of these failed');
chip('all').click();
assert.deepEqual(shown(), ['r2#0 → r1#0']);
root.querySelector('#pair-r1-r2').click();
const select = root.querySelector('#robot-filter');
select.value = 'r2';
select.onchange({target: select});
assert.deepEqual(shown(), ['r2#0 → r1#0', 'r3#0 → r2#0']);

// Those of the last minute, the newest first: of r2 those that were rejected.
const late = state({
  robots: [robot('r1'), robot('r2')],
  registrations: [
    registration('r1#0', 'r2#0', 'rejected', {t: 100}),
    registration('r1#1', 'r2#0', 'rejected', {t: 161}),
    registration('r1#2', 'r1#0', 'rejected', {t: 200}),
    registration('r1#3', 'r2#0', 'accepted', {t: 210}),
    registration('r1#4', 'r2#0', 'rejected', {t: 220}),
    registration('r1#5', 'r2#0', 'rejected'),
  ],
  pairs: [pair('r1', 'r2', true)],
});
const minute = document.createElement('div');
const latest = new WhyPanel(minute, actions);
latest.show({...late, registrations: [registration('r1#0', 'r2#0', 'rejected')]});
assert.ok(minute.querySelector('#last-minute').hidden, 'no time is known');
latest.show(late);
const rows = () => [...minute.querySelectorAll('.registration .who')].map((one) => one.textContent.split(' → ')[1]);
assert.equal(rows().length, 6);
assert.ok(!minute.querySelector('#last-minute').hidden);
const order = [...minute.querySelectorAll('.registration')].map((one) => one.getAttribute('data-index'));
assert.deepEqual(order, ['4', '3', '2', '1', '0', '5'], 'the newest is first');
assert.match(textOf(minute.querySelector('.registration')), /3:40/, 'two of one pair are told apart by their time');
minute.querySelector('#last-minute').click();
assert.equal(minute.querySelector('#last-minute').getAttribute('aria-pressed'), 'true');
assert.deepEqual(rows(), ['r1#4', 'r1#3', 'r1#2', 'r1#1']);
minute.querySelector('#verdict-rejected').click();
const robots = minute.querySelector('#robot-filter');
robots.value = 'r2';
robots.onchange({target: robots});
assert.deepEqual(rows(), ['r1#4', 'r1#1']);
assert.equal(minute.querySelector('.registration').getAttribute('data-index'), '4', 'its place among all');
minute.querySelector('#last-minute').click();
assert.equal(rows().length, 4);

// A session that nothing joins is named although one session of each robot is joined.
const sessions = document.createElement('div');
new WhyPanel(sessions, actions).show(
  state({pairs: [pair('r1', 'r2', true)], loose_sessions: ["r2's second session is not joined"]}),
);
assert.match(
  textOf(sessions.querySelector('.headline')),
  /robots are joined, but not all sessions: r2's second session is not joined\.$/,
);

// The numbers are of the registrations that are known, if the log of one of the two is elsewhere.
const page = state({logs: ['r2'], pairs: [pair('r1', 'r2', false, {attempts: 2, missing_logs: ['r1']})]});
const other = document.createElement('div');
new WhyPanel(other, actions).show(page);
assert.match(textOf(other.querySelector('.facts')), /^2 registrations known here \(without those of r1\), 0 accepted/);
assert.match(textOf(other.querySelector('.registrations')), /None yet by r2, whose registrations are known here/);
new WhyPanel(other, actions).show({...page, logs: []});
assert.match(textOf(other.querySelector('.registrations')), /No registrations\.csv lies beside the store/);

// A choice here is one of all registrations, by its index; the mark follows it, also through a newer state.
[...root.querySelectorAll('.registration')].at(-1).click();
assert.equal(chosen.at(-1), 3);
panel.mark(3);
panel.show({...fleet, registrations: [registration('r1#0', 'r2#0', 'rejected'), ...fleet.registrations]});
const current = [...root.querySelectorAll('.registration')].filter(
  (one) => one.getAttribute('aria-current') === 'true',
);
assert.deepEqual(
  current.map((one) => one.getAttribute('data-index')),
  ['4'],
  'r1 has logged one more',
);
panel.show(fleet);

assert.equal(root.querySelector('.answer'), null, 'who chose no pair is shown none');

// The menu, the chips and a registration stay the same elements, so an open menu stays open and focus where it is.
const kept = () => [
  select,
  chip('all'),
  [...root.querySelectorAll('.registration')].at(-1),
  root.querySelector('.scroll'),
];
const parts = kept();
panel.show({...fleet, registrations: [registration('r2#1', 'r1#0', 'rejected'), ...fleet.registrations]});
assert.equal(root.querySelector('#robot-filter'), select);
assert.deepEqual(kept(), parts);
parts[2].click();
assert.equal(chosen.at(-1), 4, 'with its new number');
panel.show(fleet);
assert.ok(root.querySelector('.scroll > .pairs'), 'many robots make no page that is wider than a phone');

// Long lists come a hundred at a time.
panel.show(
  state({
    registrations: Array.from({length: 250}, () => registration('r1#0', 'r2#0', 'accepted')),
    pairs: [pair('r1', 'r2', true)],
  }),
);
assert.equal(shown().length, 100);
root.querySelector('.more').click();
assert.equal(shown().length, 200);
assert.equal(textOf(root.querySelector('.more')), 'Show 50 more of 250');

const alone = new WhyPanel(document.createElement('div'), actions);
assert.doesNotThrow(() => alone.show(state({robots: [robot('r1')], pairs: []})));

// Candidates of the two robots, also those that were never registered; those of a robot that runs are the newer ones.
const waiting = document.createElement('div');
const candidates = new WhyPanel(waiting, actions);
const of = (by, other, sentence) => ({by, with: other, sentence});
const said = () => [...waiting.querySelectorAll('.candidates')].map((one) => one.textContent);
candidates.showNow(live([], {candidates: [of('r1', 'r2', '3 wait')]}));
candidates.show(
  state({candidates: [of('r1', 'r2', '9 waited'), of('r2', 'r1', '5 waited'), of('r2', 'r3', '7 waited')]}),
);
assert.deepEqual(said(), ['3 wait', '5 waited']);
candidates.showNow(live([], {candidates: [of('r1', 'r2', '2 wait')]}));
assert.deepEqual(said(), ['2 wait', '5 waited']);
