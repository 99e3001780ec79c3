// Opens a finished run with `fleetmap monitor` in headless Chromium, as a person would: map, counts, a rejected
// registration that explains itself, measuring, keyboard, and no error on the console; at 1366 px and at 390 px.
//   node page_test.mjs FLEETMAP PAGE_FOLDER [SCREENSHOTS]     exit code 77: skipped, since Chromium is missing
// FLEETMAP_RUN of the environment is a run to open instead of a new one.
import assert from 'node:assert/strict';
import {rmSync} from 'node:fs';
import {
  cardIsBesideItsThing,
  everythingIsNamed,
  fleetmap,
  folder,
  noteErrors,
  openBrowser,
  pixelsOfMap,
  shot,
  spaced,
} from './browser.mjs';
import {makeRun, serve} from './shown_run.mjs';

async function mapIsDrawn(page) {
  await page.waitForFunction(
    () => {
      const {drawn, loading} = document.getElementById('canvas').dataset;
      return Number(drawn) > 20_000 && loading === 'false';
    },
    null,
    {timeout: 100_000},
  );
  // A view that has just moved is coarse until it stands still.
  let pixels;
  const end = Date.now() + 20_000;
  do {
    await page.waitForFunction(() => !document.getElementById('map').classList.contains('coarse'));
    pixels = await pixelsOfMap(page);
  } while ((pixels.covered <= 0.1 || pixels.colours <= 30) && Date.now() < end);
  assert.ok(pixels.covered > 0.1, `only ${pixels.covered} of the map's pixels are drawn`);
  assert.ok(pixels.colours > 30, `only ${pixels.colours} colours: the points are not shaded`);
}

async function visit(browser, url, width, height, state, check) {
  const context = await browser.newContext({
    viewport: {width, height},
    hasTouch: width < 500,
    isMobile: width < 500,
    deviceScaleFactor: 1,
  });
  const page = await context.newPage();
  const said = noteErrors(page);
  const site = new URL('/', url).href;
  const isAllowed = (to) => [site, site.replace(/^http/, 'ws'), 'data:'].some((one) => to.startsWith(one));
  for (const kind of ['request', 'websocket'])
    page.on(kind, (one) => assert.ok(isAllowed(one.url()), `asked another site: ${one.url()}`));
  await page.goto(url);
  await mapIsDrawn(page);
  assert.equal(
    await page.locator('#summary').textContent(),
    `${state.robots.length} robots · ${state.nodes.length} nodes · ${state.alignments.length} alignments`,
  );
  // Not window.innerWidth: on a phone it grows with a page that is too wide.
  const wider = (await page.evaluate(() => document.documentElement.scrollWidth)) - width;
  assert.ok(wider <= 0, `the page is ${wider} px wider than the window`);
  await check(page);
  assert.deepEqual(said, []);
  await context.close();
}

async function rejectedExplainsItself(page, state) {
  const robotOf = (node) => node.split(/[#/]/)[0];
  // The page begins with the first pair that is not joined.
  const {a, b} = state.pairs.find((pair) => !pair.joined);
  const rejected = state.registrations.filter(
    (one) => one.verdict === 'rejected' && [a, b].join() === [robotOf(one.target), robotOf(one.source)].sort().join(),
  );
  assert.ok(rejected.length > 0, `the run has no rejected registration of ${a} and ${b} to show`);
  const answer = await spaced(page.locator('.answer'));
  const why = new RegExp(`Why are ${a} and ${b} not joined\\?.*and none was accepted.*because inlier RMSE is`, 's');
  assert.match(answer, why);
  await page.locator('#verdict-rejected').click();
  await page.waitForFunction((n) => document.querySelectorAll('.registration').length === n, rejected.length);
  const row = page.locator('.registration').first();
  assert.match(await spaced(row), /rejected, because inlier RMSE is 0\.\d+ m, at most 0\.05 m is good/);
  await row.click();
  assert.match(await page.locator('#card').textContent(), /Rejected registration.*because inlier RMSE/s);
}

async function onADesk(page, state) {
  await shot(page, 'desk');
  await rejectedExplainsItself(page, state);
  await shot(page, 'desk_rejected');
  await page.locator('#verdict-all').click();
  await page.keyboard.press('Escape');
  await comparesTheClouds(page);
  await planByKeyboard(page);
  await nodeTellsWhatItIs(page, state);
  await measuresWhatTheScaleSays(page);
  await radioHasTheKinds(page);
}

/** A run in virtual time logs no second of a link, and its report counts what each kind sent. */
async function radioHasTheKinds(page) {
  await page.locator('#tab-radio').click();
  assert.match(await spaced(page.locator('#radio .headline')), /a run in virtual time writes none/);
  assert.match(await spaced(page.locator('#radio [data-of=kinds]')), /noderadio\d+\.\d kB/);
  await shot(page, 'desk_radio');
}

/** The two clouds of a registration alone, before it and as placed. */
async function comparesTheClouds(page) {
  const picture = () =>
    page
      .locator('#canvas')
      .evaluate(
        (canvas) =>
          new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(canvas.toDataURL())))),
      );
  const pictures = [],
    all = Number(await page.locator('#canvas').getAttribute('data-drawn'));
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
}

async function planByKeyboard(page) {
  await page.locator('#canvas').focus();
  await page.keyboard.press('Escape');
  await page.keyboard.press('p');
  assert.equal(await page.locator('#view-plan').getAttribute('aria-pressed'), 'true');
  await page.keyboard.press('f');
  for (const [mode, ends] of [
    ['age', /\d:\d\d\d:\d\d/],
    ['sigma', /1 sigma, horizontal: 0\.00\sm\d+\.\d\d\sm/],
    ['height', /-?\d+\.\d\sm-?\d+\.\d\sm/],
  ]) {
    await page.locator(`[data-colour=${mode}]`).click();
    await mapIsDrawn(page);
    await page.waitForFunction(
      ([text]) => new RegExp(text).test(document.querySelector('#legend .ramp')?.textContent ?? ''),
      [ends.source],
    );
  }
}

async function nodeTellsWhatItIs(page, state) {
  await page.locator('#tab-fleet').click();
  const node = page.locator('.robot .link').first();
  const name = await node.textContent();
  await node.click();
  assert.match(
    await page.locator('#card').textContent(),
    new RegExp(`Node ${name}.*WGS84(38\\.999|39\\.000)\\d+°, -(2\\.999|3\\.000)\\d+°, (5|6)\\d\\d\\.`, 's'),
  );
  assert.match(await page.locator('#fleet').textContent(), new RegExp(`${state.robots[0].nodes} nodes on \\d+`));
  await shot(page, 'desk_plan');

  // It is in the middle of the map now: a click there finds it again.
  await page.locator('#card .close').click();
  const box = await page.locator('#canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(await page.locator('#card').textContent(), new RegExp(`Node ${name}`));
}

/** A measurement across 200 pixels. */
async function measuresWhatTheScaleSays(page) {
  const box = await page.locator('#canvas').boundingBox();
  await page.keyboard.press('Escape');
  await page.locator('#measure').click();
  for (const x of [-100, 100]) await page.mouse.click(box.x + box.width / 2 + x, box.y + box.height / 2 + 30);
  const measured = await spaced(page.locator('#card'));
  const plan = Number(measured.match(/on the plan([\d.]+) m/)[1]);
  const expected = await page.evaluate(() => {
    const bar = document.querySelector('#scale i').getBoundingClientRect().width,
      text = document.querySelector('#scale span').textContent;
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
  return page.evaluate(
    () =>
      new Promise((done) =>
        requestAnimationFrame(() =>
          requestAnimationFrame(() => {
            const canvas = document.getElementById('canvas'),
              copy = document.createElement('canvas');
            Object.assign(copy, {width: canvas.width, height: canvas.height});
            copy.getContext('2d').drawImage(canvas, 0, 0);
            done([...copy.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data]);
          }),
        ),
      ),
  );
}

/**
 * The CPU draws points as WebGL does, so what the other tests see of one is true of the other. So small a screen asks
 * for few points.
 */
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
  let covered = 0,
    both = 0,
    difference = 0;
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
  await cardIsBesideItsThing(page);
  await shot(page, 'phone_rejected');
  await page.locator('#tab-fleet').click();
  assert.equal(await page.locator('.robot').count(), state.robots.length);
  await page.locator('.robot').first().scrollIntoViewIfNeeded();
  await shot(page, 'phone_fleet');
  await page.locator('.robot .link').first().click();
  await cardIsBesideItsThing(page);
}

let server;
try {
  // E must be smaller than it ever is, so that their registrations are rejected.
  const made = process.env.FLEETMAP_RUN ?? makeRun(fleetmap, folder, ['registration.max_rmse=0.05'], 3);
  let url;
  ({server, url} = await serve(fleetmap, made));
  const state = await (await fetch(new URL('state.json', url))).json();
  assert.ok(process.env.FLEETMAP_RUN || state.robots.length === 3, 'the fleet of the demo has three robots');
  const browser = await openBrowser();
  await visit(browser, url, 1366, 768, state, async (page) => {
    await everythingIsNamed(page);
    await onADesk(page, state);
  });
  await visit(browser, url, 390, 844, state, (page) => onAPhone(page, state));
  await bothWaysDrawAlike(browser, url, state);
  await lostAnswersAreAskedForAgain(browser, url);
  await browser.close();
  console.log(`passed: ${state.nodes.length} nodes, ${state.registrations.length} registrations`);
} finally {
  server?.kill('SIGINT');
  rmSync(folder, {recursive: true, force: true});
}
