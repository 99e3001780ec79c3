// Elements of the page (src/monitor/page/dom.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';
import {state} from './states.mjs';

await openPage(process.argv[2]);
const {dot, el} = await pageModule(process.argv[2], 'dom');

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

// Names come from the radio: they are text.
assert.equal(el('p', {}, '<img src=x onerror=alert(1)>').children.length, 0);
assert.equal(dot(state(), 'r2').getAttribute('aria-hidden'), 'true');
assert.notEqual(dot(state(), 'r2').style.background, dot(state(), 'r1').style.background);
