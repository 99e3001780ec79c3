// The page with made-up fleets in headless Chromium, without the program: twelve robots on a phone, what a refresh each
// second leaves alone, links on the plan, a run's radio, keys, and the reasons of a refusal.
//   node made_up_page_test.mjs FLEETMAP PAGE_FOLDER [SCREENSHOTS]     exit code 77: skipped, since Chromium is missing
import assert from 'node:assert/strict';
import {readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {cardIsBesideItsThing, everythingIsNamed, folder, openBrowser, pageFolder, shot} from './browser.mjs';
import {
  heardLink,
  live,
  node,
  pair,
  radioHistory,
  registration,
  robot,
  robotNow,
  state,
} from './page/states.mjs';

const {build} = createRequire(resolve(pageFolder, 'package.json'))('esbuild');
const {outputFiles} = await build({
  absWorkingDir: resolve(pageFolder),
  entryPoints: ['main.ts', 'style.css'],
  bundle: true,
  format: 'esm',
  target: 'es2020',
  outdir: 'bundle',
  write: false,
});
const files = Object.fromEntries(outputFiles.map(({path, text}) => [path.slice(path.lastIndexOf('/')), text]));
files['/'] = readFileSync(join(pageFolder, 'index.html'), 'utf8');
const types = {'/': 'text/html', '/main.js': 'text/javascript', '/style.css': 'text/css'};

const names = Array.from({length: 12}, (_, k) => `robot-${k + 1}`);
const pairs = names.flatMap((b, k) => names.slice(0, k).map((a) => pair(a, b, false, {attempts: 1})));
/** Twelve robots on rows of their own; `n` registrations, the newest first, as when another robot's log grows. */
const fleet = (n) =>
  state({
    self: names[0],
    robots: names.map((id) => robot(id, {last_node: `${id}#1`, covariance_m2: [1, 0.3, 0.5]})),
    nodes: names.flatMap((id, k) =>
      [0, 1].map((t) => node(id, t, [20 * t, 6 * k, 0], {submap: undefined, session: 0})),
    ),
    registrations: Array.from({length: n}, (_, k) => registration('robot-1#0', `robot-2#${n - k}`, 'rejected')),
    pairs,
  });
function now() {
  const heard = (k) => (k > 0 ? {heard: [{link: 'long_range', seconds_ago: 7 * k}]} : {});
  const status = live(
    names.map((id, k) => robotNow(id, heard(k))),
    {self: names[0], lost_after_s: 60},
  );
  status.radio.kinds.push({link: 'long_range', kind: 'long'.repeat(60), sent: 1, received: 2});
  return status;
}

/** A page that the made-up program answers; `send` passes messages on. Without `messages` it opens no WebSocket. */
async function open(browser, width, height, messages = [fleet(30), {live: now()}]) {
  const context = await browser.newContext({viewport: {width, height}, isMobile: width < 500, hasTouch: width < 500});
  const page = await context.newPage();
  const errors = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  await page.route('http://robot.test/**', (route) => {
    const {pathname} = new URL(route.request().url());
    if (pathname === '/live') return route.fulfill({status: 503, body: 'too many pages are open; close one\n'});
    return route.fulfill({contentType: types[pathname] ?? 'text/plain', body: files[pathname] ?? ''});
  });
  let socket;
  await page.routeWebSocket('ws://robot.test/live', (one) => {
    socket = one;
    if (!messages) one.close();
  });
  await page.goto('http://robot.test/');
  const send = (...messages) => messages.forEach((one) => socket.send(JSON.stringify(one)));
  if (messages) send(...messages);
  const end = async () => {
    assert.deepEqual(errors, []);
    await context.close();
  };
  return {page, send, end};
}

async function narrowerThanTheWindow(page, width) {
  const wider = (await page.evaluate(() => document.documentElement.scrollWidth)) - width;
  assert.ok(wider <= 0, `the page is ${wider} px wider than the window`);
}

/** Focus, scrolling and an open menu stay where they are while states and statuses come. */
async function refreshLeavesAlone(page, send) {
  const chosen = page.locator('.registration').nth(1);
  const who = await chosen.locator('.who').textContent();
  await chosen.focus();
  for (let k = 31; k < 34; ++k) send(fleet(k), {live: now()});
  await page.waitForFunction(() => document.querySelector('#verdict-all b').textContent === '33');
  assert.equal(await page.evaluate(() => document.activeElement.querySelector('.who')?.textContent), who);
  await page.locator('#tab-radio').click();
  const kinds = page.locator('#radio [data-of=kinds]');
  await kinds.evaluate((one) => (one.scrollLeft = 50));
  const status = now();
  send({live: {...status, radio: {...status.radio, sent: 901}}});
  await page.waitForFunction(() => /sends 901\sB/.test(document.querySelector('#radio .headline').textContent));
  assert.equal(await kinds.evaluate((one) => one.scrollLeft), 50);
  await page.locator('#tab-why').click();
}

/** The first press asks, and the focus stays for the second. */
async function callsHomeByKeyboard(page) {
  await page.locator('#tab-fleet').click();
  await page.getByRole('button', {name: 'Call all home'}).focus();
  const orders = page.waitForRequest('**/operator/home');
  await page.keyboard.press('Enter');
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Really call all home?');
  await page.keyboard.press('Enter');
  assert.equal((await orders).method(), 'POST');
  await page.waitForFunction(() => /Ordered: call all robots home/.test(document.getElementById('fleet').textContent));
  await page.locator('#tab-why').click();
}

async function onADesk(page, send) {
  await page.waitForFunction(() => document.querySelectorAll('#robots line.link').length === 11);
  const count = (selector) => page.locator(`#robots ${selector}`).count();
  assert.deepEqual(
    [await count('.robot-mark'), await count('line.good'), await count('line.poor'), await count('line.silent')],
    [12, 1, 7, 3],
  );
  assert.equal(await count('.ellipse'), 12);
  await refreshLeavesAlone(page, send);
  // Every node and a measurement's first step by keys alone.
  await page.locator('#canvas').focus();
  for (const id of ['robot-1#0', 'robot-1#1', 'robot-10#0']) {
    await page.keyboard.press('n');
    assert.match(await page.locator('#card').textContent(), new RegExp(`Node ${id}made`));
  }
  assert.ok(await page.locator('.cross').isVisible());
  await callsHomeByKeyboard(page);
  await page.locator('#canvas').focus();
  await page.keyboard.press('m');
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('#said').textContent(), 'No point is at the cross.');
  await shot(page, 'made_up_desk');
}

/** A run of 100 s that is over: robot-1 and robot-2 met in its middle, robot-3 was heard at the end. */
function run() {
  const links = [
    heardLink('robot-2', 'robot-1', 'short_range', 100, {bytes: 3e6, loss_in: {50: 0.3}, received: {50: 3e6}}),
    heardLink('robot-3', 'robot-1', 'long_range', 100, {bytes: 900, loss_in: {98: 0}, received: {98: 900}}),
  ];
  const kinds = [{link: 'long_range', kind: 'node', sent: 900, received: 900}];
  const nodes = names
    .slice(0, 3)
    .flatMap((id, k) => [0, 99].map((t) => node(id, t, [20, 20 * k, 0], {submap: undefined})));
  return {...fleet(0), nodes, radio: radioHistory({begin_s: 0, steps: 100, links, kinds, traces: ['robot-1']})};
}

/** Sums, charts and tables; on the plan the links of the time that the slider shows. */
async function radioOfARun(page) {
  const drawn = (count) =>
    page.waitForFunction((n) => document.querySelectorAll('#robots line.link').length === n, count);
  const slideTo = (share) =>
    page.locator('#time').evaluate((slider, share) => {
      slider.value = String(1000 * share);
      slider.dispatchEvent(new Event('input'));
    }, share);
  await drawn(1);
  assert.equal(await page.locator('#robots line.link.good').count(), 1);
  await page.waitForFunction(() =>
    /heard then/.test(document.getElementById('legend').textContent),
  );
  await slideTo(0.1);
  await drawn(0);
  await slideTo(0.52);
  await drawn(1);
  assert.equal(await page.locator('#robots line.link.poor').count(), 1);
  await page.locator('#tab-radio').click();
  assert.match(await page.locator('#radio').textContent(), /robot-1 heard 900\sB.*3\.0\sMB.*at 0:50/s);
  assert.equal(await page.locator('#radio canvas').count(), 2);
  await shot(page, 'made_up_run_radio');
}

/** Everything that a finger is to hit is at least 36 px wide and high; the label of a checkbox is part of it. */
async function targetsAreLarge(page) {
  await page.locator('.layers summary').click();
  const small = await page.evaluate(() =>
    [...document.querySelectorAll('#theme, .menu label, .close, .order, .group button, .chip')]
      .map((one) => [one.outerHTML.slice(0, 60), one.getBoundingClientRect()])
      .filter(([, box]) => box.width > 0 && Math.min(box.width, box.height) < 36)
      .map(([html, box]) => `${html} ${box.width} x ${box.height}`),
  );
  assert.deepEqual(small, []);
  await page.locator('.layers summary').click();
}

/** A registration or node that is tapped in a list is described and seen; the list comes back with the close. */
async function onAPhone(page) {
  await page.locator('#tab-why').click();
  const row = page.locator('.registration').nth(20);
  await row.tap();
  await cardIsBesideItsThing(page);
  await targetsAreLarge(page);
  await shot(page, 'made_up_phone_card');
  await page.locator('#card .close').tap();
  const top = await row.evaluate((one) => one.getBoundingClientRect().top);
  assert.ok(top > 0 && top < 844, `the row that was tapped is at ${top} px`);
  await page.locator('#tab-fleet').tap();
  await targetsAreLarge(page);
  await page.locator('.robot .link').last().tap();
  await cardIsBesideItsThing(page);
}

try {
  const browser = await openBrowser();
  const desk = await open(browser, 1366, 768);
  await onADesk(desk.page, desk.send);
  await everythingIsNamed(desk.page);
  await desk.end();
  const phone = await open(browser, 390, 844);
  await phone.page.locator('.pairs').waitFor();
  for (const tab of ['why', 'fleet', 'radio']) {
    await phone.page.locator(`#tab-${tab}`).click();
    await narrowerThanTheWindow(phone.page, 390);
    await shot(phone.page, `made_up_phone_${tab}`);
  }
  await onAPhone(phone.page);
  await phone.end();
  const over = await open(browser, 1366, 768, [run()]);
  await radioOfARun(over.page);
  await everythingIsNamed(over.page);
  await over.end();
  const refused = await open(browser, 390, 844, null);
  await refused.page.waitForFunction(() =>
    /Refused: too many pages are open; close one\./.test(document.getElementById('connection').textContent),
  );
  await narrowerThanTheWindow(refused.page, 390);
  await refused.end();
  await browser.close();
  console.log('passed');
} finally {
  rmSync(folder, {recursive: true, force: true});
}
