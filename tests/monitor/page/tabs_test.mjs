// Tabs and their panels (src/monitor/page/tabs.ts).
import assert from 'node:assert/strict';
import {openPage} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(
  process.argv[2],
  ['a', 'b', 'c'].map((id) => `<button id="tab-${id}" aria-controls="${id}"></button><div id="${id}"></div>`).join(''),
);
const {joinTabs} = await pageModule(process.argv[2], 'tabs');
const tabs = ['a', 'b', 'c'].map((id) => document.getElementById(`tab-${id}`));
tabs[1].hidden = true;
let changes = 0;
joinTabs(tabs, () => ++changes);
/** Which tab is selected, and which one the tabulator reaches and whose panel is open, which must be the same. */
const open = () => {
  const is = (have) => ['a', 'b', 'c'].filter((_, k) => have(tabs[k]));
  const selected = is((tab) => tab.getAttribute('aria-selected') === 'true');
  assert.deepEqual(
    is((tab) => tab.getAttribute('tabindex') === '0'),
    selected,
  );
  assert.deepEqual(
    is((tab) => !document.getElementById(tab.getAttribute('aria-controls')).hidden),
    selected,
  );
  return selected.join();
};
tabs[0].onclick();
assert.equal(open(), 'a');
const key = (name) => document.activeElement.onkeydown({key: name});
tabs[0].focus();
key('ArrowRight');
assert.equal(open(), 'c', 'a hidden tab is passed over');
assert.ok(document.activeElement === tabs[2]);
key('ArrowRight');
assert.equal(open(), 'a', 'after the last one comes the first');
key('ArrowLeft');
assert.equal(open(), 'c');
tabs[1].hidden = false;
key('ArrowLeft');
assert.equal(open(), 'b');
const before = changes;
key('Enter');
assert.equal(open(), 'b');
assert.equal(changes, before);
assert.equal(changes, 5);
