// Buttons that order robots (src/monitor/page/order_button.ts).
import assert from 'node:assert/strict';
import {openPage, textOf} from './fake_page.mjs';
import {pageModule} from './page_module.mjs';

await openPage(process.argv[2]);
let clock = 0;
const real = globalThis.performance;
Object.defineProperty(globalThis, 'performance', {configurable: true, value: {now: () => clock}});
try {
  const {OrderButton} = await pageModule(process.argv[2], 'order_button');
  const said = [];
  let orders = 0,
    works = true,
    question = 'Really call home?';
  const button = new OrderButton(
    async () => (++orders, works),
    () => question,
    (text) => said.push(text),
  );
  button.label('Call home', 'Call r1 home');
  const press = async () => {
    button.root.click();
    await undefined;
    await undefined;
  };
  const shown = () => [textOf(button.root), button.root.getAttribute('aria-label')];

  // A question that changes between the presses is asked again.
  await press();
  question = 'Really call home now?';
  await press();
  assert.equal(orders, 0);
  assert.equal(shown()[0], 'Really call home now?');
  question = 'Really call home?';
  button.refresh();
  assert.equal(shown()[0], 'Call home');
  said.length = 0;

  // The first press asks, the second orders, then none does until the next status.
  await press();
  assert.equal(orders, 0);
  assert.deepEqual(shown(), ['Really call home?', 'Really call home? Call r1 home']);
  assert.deepEqual(said, ['Press again within 5 s: Call r1 home.']);
  button.label('Call home', 'Call r1 home');
  assert.equal(shown()[0], 'Really call home?', 'a status that changes nothing leaves the question');
  clock += 4000;
  await press();
  assert.deepEqual([orders, button.root.disabled], [1, true]);
  assert.deepEqual(shown(), ['Call home', 'Call r1 home']);
  button.answered();
  assert.equal(button.root.disabled, false);

  // The question ends by itself, and where the order is another one now.
  await press();
  clock += 5001;
  button.refresh();
  assert.equal(shown()[0], 'Call home');
  await press();
  assert.equal(orders, 1);
  question = undefined;
  button.label('Resume', 'Resume r1');
  assert.deepEqual(shown(), ['Resume', 'Resume r1']);
  await press();
  assert.equal(orders, 2, 'an order without a question needs one press');

  // One that fails can be given again at once.
  button.answered();
  works = false;
  await press();
  assert.deepEqual([orders, button.root.disabled], [3, false]);
} finally {
  Object.defineProperty(globalThis, 'performance', {configurable: true, value: real});
}
