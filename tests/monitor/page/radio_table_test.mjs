// Tables of the Radio panel (src/monitor/page/radio_table.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(process.argv[2], '<div id="root"></div>');
const {radioTable} = await pageModule(process.argv[2], 'radio_table');
const root = document.getElementById('root');
root.append(...radioTable('By robot', ['from', 'lost'], [['r2', '3 %']], 'peers'));
assert.equal(textOf(root.querySelector('h2')), 'By robot');
const region = root.querySelector('[data-of=peers]');
assert.deepEqual(
  ['role', 'aria-label', 'tabindex'].map((name) => region.getAttribute(name)),
  ['region', 'By robot', '0'],
  'it can be scrolled by keys, and has a name',
);
assert.deepEqual([...region.querySelectorAll('thead th')].map(textOf), ['from', 'lost']);
assert.deepEqual([...region.querySelectorAll('tbody tr > *')].map(textOf), ['r2', '3 %']);
root.replaceChildren(...radioTable('By robot', ['from'], [], 'peers'));
assert.equal(textOf(root.querySelector('[data-of=peers]')), 'None now.');
root.replaceChildren(...radioTable('By robot', ['from'], [], 'peers', 'Not known.'));
assert.equal(textOf(root.querySelector('[data-of=peers]')), 'Not known.');
