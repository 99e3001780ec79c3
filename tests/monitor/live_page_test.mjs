// The pages of a fleet that is under way, in headless Chromium: that of an agent beside another one (fleet and radio,
// hold and resume with a token, a robot that falls silent), and that of a run in virtual time.
//   node live_page_test.mjs FLEETMAP PAGE_FOLDER [SCREENSHOTS]     exit code 77: skipped, since Chromium is missing
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {rmSync, writeFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {everythingIsNamed, fleetmap, folder, noteErrors, openBrowser, pixelsOfMap, shot} from './browser.mjs';

/**
 * DDS domains that no other test has, as tests/bus/dds_domains.hpp gives them away; they are free again when the lock's
 * process ends.
 */
async function testDomain() {
  for (let group = 15; group >= 0; --group) {
    const lock = spawn(
      'flock',
      ['--nonblock', `/tmp/fleetmap-test-domains-${group}`, 'sh', '-c', 'echo mine; exec cat'],
      {stdio: ['pipe', 'pipe', 'inherit']},
    );
    const mine = await new Promise((found) => {
      lock.stdout.once('data', () => found(true));
      lock.once('exit', () => found(false));
      lock.once('error', () => found(false));
    });
    if (mine) return {lock, domain: 2 + 6 * group};
  }
  throw new Error('all test domains are taken');
}

const kToken = '0123456789abcdef';
const kLostAfter_s = 25;
const kPatience_ms = 120_000; // without a graphics card the map of a run that computes as fast as it can is slow

function agent(id, domain, more = []) {
  const cwd = fileURLToPath(new URL('../..', import.meta.url)); // qos/ is looked for there
  return spawn(
    fleetmap,
    [
      'agent',
      '-c',
      'config/fleets/farm_small.yaml',
      '--as',
      id,
      '--out',
      join(folder, 'live'),
      '--set',
      `dds.base_domain=${domain}`,
      ...more,
    ],
    {cwd, stdio: ['ignore', 'pipe', 'pipe']},
  );
}

/** The page's address, as the agent logs it. */
function addressOf(process) {
  return new Promise((found, failed) => {
    let said = '';
    const listen = (text) => {
      said += text;
      const match = said.match(/open (http:\S+) in a browser/);
      if (match) found(match[1]);
    };
    process.stdout.on('data', listen);
    process.stderr.on('data', listen);
    process.on('exit', (code) => failed(new Error(`fleetmap agent ended with ${code}: ${said}`)));
  });
}

const textIs = (page, selector, pattern) =>
  page.waitForFunction(
    ([where, what]) =>
      new RegExp(what, 's').test(document.querySelector(where)?.textContent.replaceAll('\u00a0', ' ') ?? ''),
    [selector, pattern.source],
    {timeout: kPatience_ms},
  );

async function watchLive(browser, url, width, height, check) {
  const context = await browser.newContext({
    viewport: {width, height},
    hasTouch: width < 500,
    isMobile: width < 500,
    deviceScaleFactor: 1,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience_ms);
  const said = noteErrors(page);
  await page.goto(url);
  await page.locator('#tab-radio').waitFor({timeout: kPatience_ms});
  await check(page);
  await everythingIsNamed(page);
  // Not window.innerWidth: on a phone it grows with a page that is too wide.
  const wider = (await page.evaluate(() => document.documentElement.scrollWidth)) - width;
  assert.ok(wider <= 0, `the live page is ${wider} px wider than the window`);
  assert.deepEqual(said, []);
  await context.close();
}

async function fleetAndRadio(page, name) {
  await page.locator('#tab-fleet').click();
  await textIs(page, '[data-robot=r2]', /in contact.*Last heard \d+ s ago by (radio|Wi-Fi)/);
  await textIs(page, '[data-robot=r1]', /r1 stands still: no scan comes/);
  await textIs(page, '[data-sensor=imu]', /none yet/);
  await shot(page, `${name}_fleet`);
  await page.locator('#tab-radio').click();
  await textIs(
    page,
    '#radio .headline',
    /r1 sends .*\/s of .*\/s that it may.*all robots together may send 18\.1 kB\/s/,
  );
  await textIs(page, '#radio [data-of=wifi]', /Wi-Fi: r1 sends .*B\/s and receives .*B\/s/);
  await textIs(page, '#radio [data-of=access]', /Anyone on the radios may join.* has no keys/);
  await textIs(page, '#radio [data-of=kinds]', /status.*radio/);
  await textIs(page, '#radio [data-of=peers]', /r2(radio|Wi-Fi)/);
  await page.locator('#radio canvas').first().waitFor();
  await shot(page, `${name}_radio`);
}

/** `whileHeld` is called with the page while r2 stands. */
async function holdAndResume(page, whileHeld) {
  await page.locator('#tab-fleet').click();
  const button = page.getByRole('button', {name: 'Hold r2'});
  await button.click();
  await textIs(page, '[data-robot=r2]', /r2 stands still: an operator holds it/);
  await shot(page, 'live_held');
  await whileHeld?.(page);
  await page.getByRole('button', {name: 'Resume all'}).click();
  // A later order for all replaces that for one.
  await page.getByRole('button', {name: 'Hold r2'}).waitFor({timeout: kPatience_ms});
}

/** Kills r2, which turns to lost when it was not heard for so long: neither earlier nor much later. */
async function turnsLostInTime(page, heard) {
  const killed = performance.now();
  heard.kill('SIGKILL');
  const text = await page.waitForFunction(
    () => {
      const said = document.querySelector('[data-robot=r2]').textContent;
      return /lost.*r2 is lost\. Known last: /s.test(said) && said;
    },
    null,
    {timeout: kPatience_ms, polling: 100},
  );
  const waited_s = (performance.now() - killed) / 1000;
  const silent_s = Number((await text.jsonValue()).match(/Last heard (\d+)\ss ago/)[1]);
  assert.ok(silent_s >= kLostAfter_s && silent_s <= kLostAfter_s + 5, `lost after ${silent_s} s of silence`);
  assert.ok(waited_s <= kLostAfter_s + 15, `lost ${waited_s} s after it was killed`);
}

const rowsOf = (page, robot) =>
  page
    .getByLabel(`Row of ${robot}`, {exact: true})
    .locator('option')
    .evaluateAll((options) => options.map((option) => option.value));

/** A row of r1 goes to r2, and r1 is called home and let go. */
async function giveAndCallHome(page) {
  await page.getByRole('group', {name: 'Give a row of r1 away'}).waitFor({timeout: kPatience_ms});
  const row = (await rowsOf(page, 'r1')).at(-1);
  assert.ok(!(await rowsOf(page, 'r2')).includes(row), `row ${row} is claimed twice`);
  await page.getByLabel('Row of r1', {exact: true}).selectOption(row);
  await page.getByLabel('Robot that drives the row of r1').selectOption('r2');
  await page.getByRole('group', {name: 'Give a row of r1 away'}).getByRole('button', {name: 'Give'}).click();
  await page.getByRole('button', {name: `Really give row ${row}?`}).click();
  await textIs(page, '#fleet', new RegExp(`Ordered: r1 gives row ${row} to r2\\.`));
  const options = ([name, value]) =>
    [...document.querySelectorAll(`[aria-label="Row of ${name}"] option`)].some((option) => option.value === value);
  await page.waitForFunction(options, ['r2', row], {timeout: kPatience_ms});
  await page.waitForFunction(
    ([name, value]) =>
      ![...document.querySelectorAll(`[aria-label="Row of ${name}"] option`)].some((option) => option.value === value),
    ['r1', row],
    {timeout: kPatience_ms},
  );
  await page.getByRole('button', {name: 'Call r1 home'}).click();
  await page.getByRole('button', {name: 'Really call home? Call r1 home'}).click();
  await textIs(
    page,
    '[data-robot=r1]',
    /r1 was called home and gave its rows away: (it is back at|\d+ m from) its start/,
  );
  await shot(page, 'called_home');
  await page.getByRole('button', {name: 'Resume r1'}).click();
  await page.getByRole('button', {name: 'Call r1 home'}).waitFor({timeout: kPatience_ms});
  await page.waitForFunction(() => !/called home/.test(document.querySelector('[data-robot=r1]').textContent), null, {
    timeout: kPatience_ms,
  });
}

const stateOf = (page) => page.evaluate(async () => (await fetch('/state.json')).json());

/** The summary counts more nodes, and the map has points of many colours. */
async function mapGrows(page) {
  const nodes = () =>
    page.evaluate(() => Number(document.getElementById('summary').textContent.match(/(\d+) node/)?.[1]));
  await textIs(page, '#summary', /2 robots · \d+ nodes? · \d+ alignments?/);
  const first = await nodes();
  await page.waitForFunction(
    (n) => Number(document.getElementById('summary').textContent.match(/(\d+) node/)?.[1]) > n,
    first,
    {timeout: kPatience_ms},
  );
  await page.waitForFunction(() => Number(document.getElementById('canvas').dataset.drawn) > 1000, null, {
    timeout: kPatience_ms,
  });
  let pixels;
  const end = Date.now() + kPatience_ms;
  do {
    await page.waitForFunction(() => !document.getElementById('map').classList.contains('coarse'));
    pixels = await pixelsOfMap(page);
  } while ((pixels.covered < 0.005 || pixels.colours < 10) && Date.now() < end);
  assert.ok(
    pixels.covered >= 0.005 && pixels.colours >= 10,
    `the map shows next to nothing: ${JSON.stringify(pixels)}`,
  );
}

/** While r1 drives on for 40 s no node of r2, which is held, lies apart from where it came to a halt. */
async function r2StaysWhereItIs(page) {
  const latest = ({nodes}, robot) => Math.max(0, ...nodes.filter((one) => one.robot === robot).map(({t}) => t));
  const newState = async () => {
    const before = await page.locator('#summary').textContent();
    const isOther = (text) => document.getElementById('summary').textContent !== text;
    await page.waitForFunction(isOther, before, {timeout: kPatience_ms});
  };
  // A reading of the store that had begun before r2 was held may end now; the next one begins after that.
  for (let k = 0; k < 2; ++k) await newState();
  const heldAt = latest(await stateOf(page), 'r1');
  let state;
  const end = Date.now() + kPatience_ms;
  do {
    await newState();
    state = await stateOf(page);
  } while (latest(state, 'r1') < heldAt + 40 && Date.now() < end);
  assert.ok(latest(state, 'r1') >= heldAt + 40, 'r1 does not drive on');
  const own = state.nodes.filter((one) => one.robot === 'r2').sort((a, b) => a.t - b.t);
  const halt = own.filter(({t}) => t <= heldAt + 10).at(-1);
  const apart = own.filter(({t}) => t > heldAt + 10).map(({T}) => Math.hypot(T[0] - halt.T[0], T[1] - halt.T[1]));
  assert.ok(
    apart.every((metres) => metres < 1.5),
    `r2 is held and moved ${apart.join(', ')} m`,
  );
}

/** `fleetmap run --monitor`: virtual time as it passes, with the same orders. */
async function testVirtual(browser) {
  const tokenFile = join(folder, 'token');
  writeFileSync(tokenFile, kToken);
  // So slow that rows are left when the page has done with the robots.
  const settings = ['max_time=1800', 'mission.speed=0.4'].flatMap((one) => ['--set', one]);
  const served = ['--monitor', '0', '--monitor-token-file', tokenFile];
  const farm = 'config/fleets/farm_small.yaml';
  const run = spawn(
    fleetmap,
    ['run', '-c', farm, '--agents', '2', ...settings, '--out', join(folder, 'virtual'), ...served],
    {cwd: fileURLToPath(new URL('../..', import.meta.url)), stdio: ['ignore', 'pipe', 'pipe']},
  );
  try {
    await watchLive(browser, await addressOf(run), 1366, 768, async (page) => {
      await page.locator('#tab-fleet').click();
      await textIs(page, '[data-robot=r1]', /r1 drives row \d+ \(\d+ % of it\), \d+ % of the rows are driven/);
      await textIs(page, '[data-robot=r2]', /in contact.*Last heard \d+ s ago by (radio|Wi-Fi).*position known to/);
      const held = () =>
        page
          .locator('[data-robot=r1]')
          .textContent()
          .then((text) => Number(text.match(/holds (\d+) nodes/)?.[1] ?? 0));
      const first = await held();
      await page.waitForFunction(
        (n) => Number(document.querySelector('[data-robot=r1]').textContent.match(/holds (\d+) nodes/)?.[1] ?? 0) > n,
        first,
        {timeout: kPatience_ms},
      );
      await page.locator('#tab-radio').click();
      await textIs(page, '#radio .headline', /r1 sends .*\/s of .*\/s that it may/);
      await textIs(page, '#radio [data-of=peers]', /r2(radio|Wi-Fi)/);
      await mapGrows(page);
      await holdAndResume(page, r2StaysWhereItIs);
      await giveAndCallHome(page);
      await shot(page, 'virtual');
    });
  } finally {
    run.kill('SIGKILL');
  }
}

/** The address with its token as somebody sends it: a link of another site, as localhost is for 127.0.0.1. */
async function opensFromALink(browser, url) {
  const mail = createServer((_, answer) => {
    answer.setHeader('Content-Type', 'text/html');
    answer.end(`<a href="${url}">the robot</a>`);
  });
  const port = await new Promise((listening) => mail.listen(0, '127.0.0.1', () => listening(mail.address().port)));
  const context = await browser.newContext();
  const page = await context.newPage();
  await page.goto(`http://localhost:${port}/`);
  await page.locator('a').click();
  await page.locator('#tab-radio').waitFor({timeout: kPatience_ms});
  await context.close();
  mail.close();
}

async function testLive(browser) {
  const {lock, domain} = await testDomain();
  const tokenFile = join(folder, 'token');
  writeFileSync(tokenFile, kToken);
  const others = ['--set', `mission.lost_after=${kLostAfter_s}`];
  const shown = agent('r1', domain, ['--monitor', '0', '--monitor-token-file', tokenFile, ...others]);
  const heard = agent('r2', domain, ['--monitor', '0', ...others]);
  try {
    const [url, readOnly] = await Promise.all([addressOf(shown), addressOf(heard)]);
    await watchLive(browser, url, 1366, 768, async (page) => {
      await fleetAndRadio(page, 'live_desk');
      // r2 has no sensors; what it lacks comes over the radio.
      await page.locator('#tab-fleet').click();
      await textIs(page, '[data-robot=r2]', /no scan comes from its LiDAR.*its pose is not known/);
      await holdAndResume(page);
    });
    await opensFromALink(browser, url);
    await watchLive(browser, readOnly, 1366, 768, async (page) => {
      await page.locator('#tab-fleet').click();
      await textIs(page, '[data-robot=r1]', /in contact/);
      assert.equal(await page.locator('.order:visible').count(), 0, 'buttons without a token');
      assert.equal((await fetch(new URL('operator/hold', readOnly), {method: 'POST'})).status, 403);
    });
    await watchLive(browser, url, 390, 844, async (page) => {
      await fleetAndRadio(page, 'live_phone');
      await page.locator('#tab-fleet').click();
      await turnsLostInTime(page, heard);
      await shot(page, 'live_phone_lost');
    });
  } finally {
    shown.kill('SIGKILL');
    heard.kill('SIGKILL');
    lock.stdin.end();
  }
}

try {
  const browser = await openBrowser();
  await testLive(browser);
  await testVirtual(browser);
  await browser.close();
  console.log('passed');
} finally {
  rmSync(folder, {recursive: true, force: true});
}
