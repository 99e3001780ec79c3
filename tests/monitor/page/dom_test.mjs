// Elements of the page (src/monitor/page/dom.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {state} from './states.mjs';

await openPage(process.argv[2]);
const {dot, el, unbroken} = await pageModule(process.argv[2], 'dom');

const made = el(
  'p',
  {class: 'a b', 'aria-label': 'x', style: 'width:3px'},
  'one ',
  el('b', {}, 'two'),
  null,
  false,
  undefined,
  '',
);
assert.equal(made.tagName, 'P');
assert.equal(made.className, 'a b');
assert.equal(made.getAttribute('aria-label'), 'x');
assert.equal(made.style.width, '3px');
assert.equal(made.innerHTML, 'one <b>two</b>', 'what is not there leaves nothing');

// No line breaks between a number and its unit; words that follow a number are free to go on.
for (const text of ['0.75 m', '97 %', '3 s', '120 ms', '1.2 kB', '18.1 kB/s', '1 σ', '1.50 M', '4:10 min'])
  assert.equal(unbroken(`in ${text}.`), `in ${text.replace(' ', '\u00a0')}.`);
for (const text of ['3 nodes', 'row 7 has', '2 more', '3 s-curves', '1 meeting']) assert.equal(unbroken(text), text);
assert.equal(el('p', {}, '5 m').textContent, '5\u00a0m');

// Names come from the radio: they are text.
assert.equal(el('p', {}, '<img src=x onerror=alert(1)>').children.length, 0);
assert.equal(dot(state(), 'r2').getAttribute('aria-hidden'), 'true');
assert.notEqual(dot(state(), 'r2').style.background, dot(state(), 'r1').style.background);
