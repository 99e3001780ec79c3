// Opens a finished run with `fleetmap monitor` in headless Chromium, as a person would: map, counts, a rejected registration
// that explains itself, measuring, keyboard, and no error on the console; at 1366 px and at 390 px. Then the page of an agent
// beside another one: fleet and radio, hold and resume with a token, a robot that falls silent; and that of a run under way.
//   node page_test.mjs FLEETMAP PAGE_FOLDER [SCREENSHOTS]     exit code 77: skipped, since Chromium is missing
// FLEETMAP_RUN of the environment is a run to open instead of a new one.
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {existsSync, mkdtempSync, rmSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';
import {makeRun, serve} from './shown_run.mjs';

const [fleetmap, pageFolder, screenshots] = process.argv.slice(2);
const require = createRequire(resolve(pageFolder, 'package.json'));
const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((file) => existsSync(file));
if (!executablePath) {
  console.log('skipped: Chromium is not installed (apt install chromium)');
  process.exit(77);
}
const {chromium} = require('playwright-core');
const folder = mkdtempSync(join(tmpdir(), 'fleetmap_page_'));

/** Number of colours and of covered pixels in the map's middle. */
async function pixelsOfMap(page) {
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => {
    const canvas = document.getElementById('canvas');
    const copy = document.createElement('canvas');
    Object.assign(copy, {width: canvas.width, height: canvas.height});
    const context = copy.getContext('2d');
    context.drawImage(canvas, 0, 0);
    const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const colours = new Set();
    let covered = 0;
    for (let k = 0; k < data.length; k += 4) {
      if (data[k + 3] < 128) continue;
      ++covered;
      colours.add((data[k] >> 4 << 8) | (data[k + 1] >> 4 << 4) | (data[k + 2] >> 4));
    }
    done({covered: covered / (data.length / 4), colours: colours.size});
  })));
}

async function mapIsDrawn(page) {
  await page.waitForFunction(() => {
    const {drawn, loading} = document.getElementById('canvas').dataset;
    return Number(drawn) > 20_000 && loading === 'false';
  }, null, {timeout: 100_000});
  const pixels = await pixelsOfMap(page);
  assert.ok(pixels.covered > 0.1, `only ${pixels.covered} of the map's pixels are drawn`);
  assert.ok(pixels.colours > 50, `only ${pixels.colours} colours: the points are not shaded`);
}

async function shot(page, name) {
  if (screenshots) await page.screenshot({path: join(screenshots, `${name}.png`)});
}

async function visit(browser, url, width, height, state, check) {
  const context = await browser.newContext({viewport: {width, height}, hasTouch: width < 500, isMobile: width < 500, deviceScaleFactor: 1});
  const page = await context.newPage();
  const said = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && said.push(message.text()));
  page.on('pageerror', (error) => said.push(String(error)));
  const site = new URL('/', url).href;
  page.on('request', (request) => assert.ok(request.url().startsWith(site) || request.url().startsWith('data:') || request.url().startsWith('ws:'), `asked another site: ${request.url()}`));
  await page.goto(url);
  await mapIsDrawn(page);
  assert.equal(await page.locator('#summary').textContent(), `${state.robots.length} robots · ${state.nodes.length} nodes · ${state.alignments.length} alignments`);
  const wider = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
  assert.ok(wider <= 0, `the page is ${wider} px wider than the window`);
  await check(page);
  // Software rendering makes Chromium warn of its own slowness.
  assert.deepEqual(said.filter((text) => !text.includes('GPU stall') && !text.includes('swiftshader')), []);
  await context.close();
}

async function rejectedExplainsItself(page, state) {
  const robotOf = (node) => node.split(/[#/]/)[0];
  const rejected = state.registrations.filter((one) => one.verdict === 'rejected' && robotOf(one.target) !== robotOf(one.source));
  assert.ok(rejected.length > 0, 'the run has no rejected registration to show');
  const answer = await page.locator('.answer').textContent();
  assert.match(answer, /Why are r1 and r2 not joined\?.*and none was accepted.*because inlier RMSE is/s);
  await page.locator('#verdict-rejected').click();
  await page.waitForFunction((n) => document.querySelectorAll('.registration').length === n, rejected.length);
  const row = page.locator('.registration').first();
  assert.match(await row.textContent(), /rejected, because inlier RMSE is 0\.\d+ m, at most 0\.05 m is good/);
  await row.click();
  assert.match(await page.locator('#card').textContent(), /Rejected registration.*because inlier RMSE/s);
}

async function onADesk(page, state) {
  await shot(page, 'desk');
  await rejectedExplainsItself(page, state);
  await shot(page, 'desk_rejected');
  await page.locator('#verdict-all').click();
  await page.keyboard.press('Escape');

  // Its two clouds alone, before the registration and as placed.
  const picture = () => page.locator('#canvas').evaluate((canvas) => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(canvas.toDataURL())))));
  const pictures = [], all = Number(await page.locator('#canvas').getAttribute('data-drawn'));
  await page.locator('.registration').first().click();
  for (const place of ['gps', 'placed', 'rejected']) {
    await page.locator(`[data-compare=${place}]`).click();
    assert.equal(await page.locator(`[data-compare=${place}]`).getAttribute('aria-pressed'), 'true');
    await page.waitForFunction((all) => {
      const {drawn, loading} = document.getElementById('canvas').dataset;
      return Number(drawn) > 1000 && Number(drawn) < all && loading === 'false';
    }, all);
    pictures.push(await picture());
    await shot(page, `desk_compare_${place}`);
  }
  assert.equal(new Set(pictures).size, 3, 'GPS, placement and the rejected pose show the clouds alike');

  // The map by keyboard, in plan view, with a node that tells what it is.
  await page.locator('#canvas').focus();
  await page.keyboard.press('Escape');
  await page.keyboard.press('p');
  assert.equal(await page.locator('#view-plan').getAttribute('aria-pressed'), 'true');
  await page.keyboard.press('f');
  for (const [mode, ends] of [['age', /\d:\d\d\d:\d\d/], ['sigma', /\d+\.\d\d m\d+\.\d\d m/], ['height', /-?\d+\.\d m-?\d+\.\d m/]]) {
    await page.locator(`[data-colour=${mode}]`).click();
    await mapIsDrawn(page);
    await page.waitForFunction(([text]) => new RegExp(text).test(document.querySelector('#legend .ramp')?.textContent ?? ''), [ends.source]);
  }
  await page.locator('#tab-fleet').click();
  const node = page.locator('.robot .link').first();
  const name = await node.textContent();
  await node.click();
  assert.match(await page.locator('#card').textContent(), new RegExp(`Node ${name}.*WGS84(38\\.999|39\\.000)\\d+°, -(2\\.999|3\\.000)\\d+°, (5|6)\\d\\d\\.`, 's'));
  assert.match(await page.locator('#fleet').textContent(), new RegExp(`${state.robots[0].nodes} nodes on \\d+`));
  await shot(page, 'desk_plan');

  // It is in the middle of the map now: a click there finds it again.
  await page.locator('#card .close').click();
  const box = await page.locator('#canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(await page.locator('#card').textContent(), new RegExp(`Node ${name}`));

  // A measurement across 200 pixels is what the scale makes of them.
  await page.keyboard.press('Escape');
  await page.locator('#measure').click();
  for (const x of [-100, 100]) await page.mouse.click(box.x + box.width / 2 + x, box.y + box.height / 2 + 30);
  const measured = await page.locator('#card').textContent();
  const plan = Number(measured.match(/on the plan([\d.]+) m/)[1]);
  const expected = await page.evaluate(() => {
    const bar = document.querySelector('#scale i').getBoundingClientRect().width, text = document.querySelector('#scale span').textContent;
    return (200 / bar) * (text.endsWith('cm') ? parseFloat(text) / 100 : parseFloat(text));
  });
  assert.ok(Math.abs(plan / expected - 1) < 0.12, `measured ${plan} m, the scale says ${expected} m`);
  assert.match(measured, /A(38\.999|39\.000)\d+°.*B(38\.999|39\.000)\d+°/s);
  // 3° W is the middle of zone 30.
  assert.match(measured, /UTM 30N (4999|5000)\d\d\.\d\d 431(6|7)\d{3}\.\d\d/);
  await shot(page, 'desk_measure');
}

/** The map's picture of points alone, in plan view: R, G, B, A of each pixel. */
async function pointsAlone(page) {
  await page.locator('#view-plan').click();
  await page.locator('.layers summary').click();
  for (const layer of ['paths', 'nodes', 'used', 'unused', 'rejected']) await page.locator(`#layer-${layer}`).uncheck();
  await mapIsDrawn(page);
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => {
    const canvas = document.getElementById('canvas'), copy = document.createElement('canvas');
    Object.assign(copy, {width: canvas.width, height: canvas.height});
    copy.getContext('2d').drawImage(canvas, 0, 0);
    done([...copy.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data]);
  }))));
}

/** The CPU draws points as WebGL does, so what the other tests see of one is true of the other. So small a screen asks for few points. */
async function bothWaysDrawAlike(browser, url, state) {
  const pictures = [];
  for (const way of ['gl', 'cpu']) {
    await visit(browser, new URL(`?points=${way}`, url).href, 700, 590, state, async (page) => {
      pictures.push(await pointsAlone(page));
      await shot(page, `points_${way}`);
    });
  }
  const [gl, cpu] = pictures;
  assert.equal(gl.length, cpu.length);
  let covered = 0, both = 0, difference = 0;
  for (let k = 0; k < gl.length; k += 4) {
    const [a, b] = [gl[k + 3] > 127, cpu[k + 3] > 127];
    covered += a || b;
    if (!a || !b) continue;
    ++both;
    difference += Math.abs(gl[k] - cpu[k]) + Math.abs(gl[k + 1] - cpu[k + 1]) + Math.abs(gl[k + 2] - cpu[k + 2]);
  }
  assert.ok(covered > 20_000 && both / covered > 0.95, `${both} of ${covered} pixels are covered both ways`);
  assert.ok(difference / both < 20, `colours differ by ${difference / both} of 765`);
}

/** As when the robot is out of reach for a while: the map is whole all the same. */
async function lostAnswersAreAskedForAgain(browser, url) {
  const page = await browser.newPage({viewport: {width: 700, height: 590}});
  let lost = 0;
  await page.route('**/submap*', (route) => (++lost, route.abort()), {times: 2});
  await page.goto(url);
  await mapIsDrawn(page);
  assert.equal(lost, 2);
  await page.close();
}

async function onAPhone(page, state) {
  await shot(page, 'phone');
  await page.locator('.layers summary').click();
  await page.locator('#layer-nodes').uncheck();
  await shot(page, 'phone_layers');
  await page.locator('#layer-nodes').check();
  await page.locator('.layers summary').click();
  await rejectedExplainsItself(page, state);
  await page.locator('#tab-fleet').click();
  assert.equal(await page.locator('.robot').count(), state.robots.length);
  await page.locator('.robot').first().scrollIntoViewIfNeeded();
  await shot(page, 'phone_fleet');
}

/** Every control has a name for screen readers. */
async function everythingIsNamed(page) {
  const nameless = await page.evaluate(() => [...document.querySelectorAll('button, input, select, canvas, [role=tab]')].filter((one) =>
    !(one.getAttribute('aria-label') || one.textContent.trim() || one.labels?.length)).map((one) => one.outerHTML.slice(0, 80)));
  assert.deepEqual(nameless, []);
}

// A live fleet: agents of two robots without sensors, so they cost nothing and stand still.

/** DDS domains that no other test has, as tests/bus/dds_domains.hpp gives them away; they are free again when the lock's process ends. */
async function testDomain() {
  for (let group = 15; group >= 0; --group) {
    const lock = spawn('flock', ['--nonblock', `/tmp/fleetmap-test-domains-${group}`, 'sh', '-c', 'echo mine; exec cat'], {stdio: ['pipe', 'pipe', 'inherit']});
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

function agent(id, domain, more = []) {
  const cwd = fileURLToPath(new URL('../..', import.meta.url));  // qos/ is looked for there
  return spawn(fleetmap, ['agent', '-c', 'config/fleets/farm_small.yaml', '--as', id, '--out', join(folder, 'live'), '--set', `dds.base_domain=${domain}`, ...more],
    {cwd, stdio: ['ignore', 'pipe', 'pipe']});
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

const textIs = (page, selector, pattern) => page.waitForFunction(([where, what]) => new RegExp(what, 's').test(document.querySelector(where)?.textContent ?? ''),
  [selector, pattern.source], {timeout: 60_000});

async function watchLive(browser, url, width, height, check) {
  const context = await browser.newContext({viewport: {width, height}, hasTouch: width < 500, isMobile: width < 500, deviceScaleFactor: 1});
  const page = await context.newPage();
  const said = [];
  page.on('pageerror', (error) => said.push(String(error)));
  await page.goto(url);
  await page.locator('#tab-radio').waitFor({timeout: 60_000});
  await check(page);
  await everythingIsNamed(page);
  const wider = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
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
  await textIs(page, '#radio .headline', /Sends .*\/s of .*\/s that it may.*all robots together may send 18\.1 kB\/s/);
  await textIs(page, '#radio [data-of=access]', /Anyone on the radios may join.* has no keys/);
  await textIs(page, '#radio [data-of=kinds]', /status.*radio/);
  await textIs(page, '#radio [data-of=peers]', /r2(radio|Wi-Fi)/);
  await page.locator('#radio canvas').first().waitFor();
  await shot(page, `${name}_radio`);
}

async function holdAndResume(page) {
  await page.locator('#tab-fleet').click();
  const button = page.getByRole('button', {name: 'Hold r2'});
  await button.click();
  await textIs(page, '[data-robot=r2]', /r2 stands still: an operator holds it/);
  await shot(page, 'live_held');
  await page.getByRole('button', {name: 'Resume all'}).click();
  // A later order for all replaces that for one.
  await page.getByRole('button', {name: 'Hold r2'}).waitFor({timeout: 60_000});
}

const rowsOf = (page, robot) => page.getByLabel(`Row of ${robot}`).locator('option').evaluateAll((options) => options.map((option) => option.value));

/** A row of r1 goes to r2, and r1 is called home and let go. */
async function giveAndCallHome(page) {
  await page.getByRole('group', {name: 'Give a row of r1 away'}).waitFor({timeout: 60_000});
  const row = (await rowsOf(page, 'r1')).at(-1);
  assert.ok(!(await rowsOf(page, 'r2')).includes(row), `row ${row} is claimed twice`);
  await page.getByLabel('Row of r1').selectOption(row);
  await page.getByLabel('Robot that drives the row of r1').selectOption('r2');
  await page.getByRole('group', {name: 'Give a row of r1 away'}).getByRole('button', {name: 'Give'}).click();
  await textIs(page, '#fleet', new RegExp(`Ordered: r1 gives row ${row} to r2\\.`));
  const options = ([name, value]) => [...document.querySelectorAll(`[aria-label="Row of ${name}"] option`)].some((option) => option.value === value);
  await page.waitForFunction(options, ['r2', row], {timeout: 60_000});
  await page.waitForFunction(([name, value]) => ![...document.querySelectorAll(`[aria-label="Row of ${name}"] option`)].some((option) => option.value === value), ['r1', row], {timeout: 60_000});
  await page.getByRole('button', {name: 'Call r1 home'}).click();
  await textIs(page, '[data-robot=r1]', /r1 was called home and gave its rows away/);
  await shot(page, 'called_home');
  await page.getByRole('button', {name: 'Resume r1'}).click();
  await page.getByRole('button', {name: 'Call r1 home'}).waitFor({timeout: 60_000});
  await page.waitForFunction(() => !/called home/.test(document.querySelector('[data-robot=r1]').textContent), null, {timeout: 60_000});
}

/** `fleetmap run --monitor`: virtual time as it passes, with the same orders. */
async function testVirtual(browser) {
  const tokenFile = join(folder, 'token');
  writeFileSync(tokenFile, kToken);
  const run = spawn(fleetmap, ['run', '-c', 'config/fleets/farm_small.yaml', '--agents', '2', '--set', 'max_time=1800', '--out', join(folder, 'virtual'), '--monitor', '0',
    '--monitor-token-file', tokenFile], {cwd: fileURLToPath(new URL('../..', import.meta.url)), stdio: ['ignore', 'pipe', 'pipe']});
  try {
    await watchLive(browser, await addressOf(run), 1366, 768, async (page) => {
      await page.locator('#tab-fleet').click();
      await textIs(page, '[data-robot=r1]', /r1 drives row \d+ \(\d+ % of it\), \d+ % of the rows are driven/);
      await textIs(page, '[data-robot=r2]', /in contact.*Last heard \d+ s ago by (radio|Wi-Fi).*position known to/);
      const held = () => page.locator('[data-robot=r1]').textContent().then((text) => Number(text.match(/holds (\d+) nodes/)?.[1] ?? 0));
      const first = await held();
      await page.waitForFunction((n) => Number(document.querySelector('[data-robot=r1]').textContent.match(/holds (\d+) nodes/)?.[1] ?? 0) > n, first, {timeout: 60_000});
      await page.locator('#tab-radio').click();
      await textIs(page, '#radio .headline', /Sends .*\/s of .*\/s that it may/);
      await textIs(page, '#radio [data-of=peers]', /r2(radio|Wi-Fi)/);
      await holdAndResume(page);
      await giveAndCallHome(page);
      await shot(page, 'virtual');
    });
  } finally {
    run.kill('SIGKILL');
  }
}

async function testLive(browser) {
  const {lock, domain} = await testDomain();
  const tokenFile = join(folder, 'token');
  writeFileSync(tokenFile, kToken);
  const others = ['--set', 'mission.lost_after=25'];
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
    await watchLive(browser, readOnly, 1366, 768, async (page) => {
      await page.locator('#tab-fleet').click();
      await textIs(page, '[data-robot=r1]', /in contact/);
      assert.equal(await page.locator('.order:visible').count(), 0, 'buttons without a token');
      assert.equal((await fetch(new URL('operator/hold', readOnly), {method: 'POST'})).status, 403);
    });
    await watchLive(browser, url, 390, 844, async (page) => {
      await fleetAndRadio(page, 'live_phone');
      heard.kill('SIGKILL');
      await page.locator('#tab-fleet').click();
      await textIs(page, '[data-robot=r2]', /lost.*r2 is lost\. Known last: /);
      await shot(page, 'live_phone_lost');
    });
  } finally {
    shown.kill('SIGKILL');
    heard.kill('SIGKILL');
    lock.stdin.end();
  }
}

let server;
try {
  // E must be smaller than it ever is, so that their registrations are rejected.
  const made = process.env.FLEETMAP_RUN ?? makeRun(fleetmap, folder, ['registration.max_rmse=0.05']);
  let url;
  ({server, url} = await serve(fleetmap, made));
  const state = await (await fetch(new URL('state.json', url))).json();
  const browser = await chromium.launch({executablePath, args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist']});
  await visit(browser, url, 1366, 768, state, async (page) => {
    await everythingIsNamed(page);
    await onADesk(page, state);
  });
  await visit(browser, url, 390, 844, state, (page) => onAPhone(page, state));
  await bothWaysDrawAlike(browser, url, state);
  await lostAnswersAreAskedForAgain(browser, url);
  await testLive(browser);
  await testVirtual(browser);
  await browser.close();
  console.log(`passed: ${state.nodes.length} nodes, ${state.registrations.length} registrations`);
} finally {
  server?.kill('SIGINT');
  rmSync(folder, {recursive: true, force: true});
}
