// Cost of the page of `fleetmap monitor` on a large site, in headless Chromium with software GL:
//   bench_monitor_store DIR 2000 15000
//   node tests/bench/monitor_page.mjs FLEETMAP build/release/monitor_page DIR [BUDGET [WIDTHxHEIGHT]]
// Prints for the first visit to a store, and for two visits when the program is started anew (it then has a file of
// previews): seconds until points are seen and until every submap in view is drawn (the first picture), frames/s, the
// fewest points of a frame and CPU a frame of all the browser's processes while the map is dragged and turned, JS heap,
// and PSS of the page's and the GPU's process. Exit code 1: one of the later visits does not keep a bound.
import {existsSync, readdirSync, readFileSync, rmSync} from 'node:fs';
import {createRequire} from 'node:module';
import {loadavg} from 'node:os';
import {join, resolve} from 'node:path';
import {setTimeout as pause} from 'node:timers/promises';
import {serve} from '../monitor/shown_run.mjs';

const [fleetmap, pageFolder, run, budget = '300000', window_ = '1366x768'] = process.argv.slice(2);
const [width, height] = window_.split('x').map(Number);
const kBounds = {first_picture_s: 2, frames_per_s: 30, memory_mb: 1000};
const kMoving_ms = 5000;
const require = createRequire(resolve(pageFolder, 'package.json'));
const {chromium} = require('playwright-core');

/** Notes the times of frames in which WebGL drew, and how many points these had. */
function countFrames() {
  let drew = false;
  window.frameTimes = [];
  window.framePoints = [];
  for (const name of ['drawArrays', 'drawElements', 'drawArraysInstanced', 'drawElementsInstanced']) {
    const draw = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...args) {
      drew = true;
      return draw.apply(this, args);
    };
  }
  const tick = (now) => {
    if (drew) {
      window.frameTimes.push(now);
      window.framePoints.push(Number(document.getElementById('canvas').dataset.drawn));
    }
    drew = false;
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

/** The fields of /proc/PID/stat, from the parent's id on, of the browser and of all that it started. */
function processes(root) {
  const all = new Map();
  for (const pid of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      all.set(Number(pid), readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ').slice(1).map(Number));
    } catch {} // it has ended
  }
  const below = (pid) => pid === root || (all.has(pid) && below(all.get(pid)[0]));
  return new Map([...all].filter(([pid]) => below(pid)));
}

/** MB (PSS) of the browser's processes of one kind. */
function memory(root, kind) {
  let kb = 0;
  for (const pid of processes(root).keys()) {
    try {
      if (readFileSync(`/proc/${pid}/cmdline`, 'utf8').includes(`--type=${kind}`))
        kb += Number(readFileSync(`/proc/${pid}/smaps_rollup`, 'utf8').match(/^Pss:\s+(\d+)/m)[1]);
    } catch {}
  }
  return kb / 1000;
}

/** ms of CPU that the browser has used; a tick is 10 ms. */
const cpu = (root) => 10 * [...processes(root).values()].reduce((sum, stat) => sum + stat[10] + stat[11], 0);

const drawn = (page, min, loaded) =>
  page.waitForFunction(
    ([min, loaded]) => {
      const {drawn, loading} = document.getElementById('canvas').dataset;
      return Number(drawn) >= min && (!loaded || loading === 'false');
    },
    [min, loaded],
    {timeout: 300_000, polling: 20},
  );

/**
 * While the pointer drags: frames/s, the 95th percentile of the time between two frames and CPU a frame, both ms, and
 * the fewest points of a frame.
 */
async function move(page, root, button) {
  await page.evaluate(() => (window.frameTimes.length = window.framePoints.length = 0));
  const box = await page.locator('#canvas').boundingBox();
  const x = box.x + box.width / 2,
    y = box.y + box.height / 2;
  await page.mouse.move(x, y);
  await page.mouse.down({button});
  const before = cpu(root);
  for (const end = Date.now() + kMoving_ms, begin = Date.now(); Date.now() < end;) {
    const angle = (Date.now() - begin) / 1500;
    await page.mouse.move(x + 150 * Math.sin(angle), y + 80 * Math.sin(2 * angle));
  }
  const times = await page.evaluate(() => [...window.frameTimes]);
  const points = await page.evaluate(() => Math.min(...window.framePoints));
  const used = cpu(root) - before;
  await page.mouse.up({button});
  const steps = times
    .slice(1)
    .map((time, k) => time - times[k])
    .sort((a, b) => a - b);
  return {
    rate: (1000 * steps.length) / (times.at(-1) - times[0]),
    p95: steps[Math.floor(0.95 * steps.length)],
    cpu: used / times.length,
    points,
  };
}

async function visit(browser, pid, url) {
  const context = await browser.newContext({viewport: {width, height}, deviceScaleFactor: 1});
  const page = await context.newPage();
  await page.addInitScript(countFrames);
  const begin = performance.now();
  const seconds = () => (performance.now() - begin) / 1000;
  await page.goto(url, {waitUntil: 'commit'});
  await page.locator('#budget-value', {hasText: /./}).waitFor({state: 'attached'}); // the page has chosen its own
  await page.locator('#budget').evaluate((slider, points) => {
    slider.value = String(Math.log10(points));
    slider.dispatchEvent(new Event('input'));
  }, Number(budget));
  const result = {};
  await drawn(page, 1, false);
  result.first_points_s = seconds();
  await drawn(page, Number(budget) / 8, false);
  result.eighth_of_submaps_s = seconds(); // spread over the whole site
  await drawn(page, 1, true);
  result.first_picture_s = seconds();
  await drawn(page, 0.8 * Number(budget), true);
  result.whole_budget_s = seconds();
  await page.waitForTimeout(1000);
  for (const [name, button] of [
    ['pan', 'left'],
    ['turn', 'right'],
  ]) {
    const {rate, p95, cpu, points} = await move(page, pid, button);
    Object.assign(result, {
      [`${name}_frames_per_s`]: rate,
      [`${name}_p95_ms`]: p95,
      [`${name}_cpu_ms`]: cpu,
      [`${name}_points`]: points,
    });
  }
  result.points = Number(await page.locator('#canvas').getAttribute('data-drawn'));
  result.heap_mb = await page.evaluate(() => performance.memory.usedJSHeapSize / 1e6);
  result.page_mb = memory(pid, 'renderer');
  result.gpu_mb = memory(pid, 'gpu-process');
  await context.close();
  return result;
}

const keeps = (result) =>
  result.first_picture_s < kBounds.first_picture_s &&
  Math.min(result.pan_frames_per_s, result.turn_frames_per_s) >= kBounds.frames_per_s &&
  Math.min(result.pan_points, result.turn_points) >= 0.9 * Number(budget) &&
  result.page_mb + result.gpu_mb < kBounds.memory_mb;

const previews = join(run, 'monitor.previews');
rmSync(previews, {force: true});
const browserServer = await chromium.launchServer({
  executablePath: '/usr/bin/chromium',
  args: [
    '--no-sandbox',
    '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader',
    '--ignore-gpu-blocklist',
    '--enable-precise-memory-info',
  ],
});
let kept = true;
try {
  const browser = await chromium.connect(browserServer.wsEndpoint());
  for (const visits of [['first visit'], ['after a start', 'next visit']]) {
    const {server, url} = await serve(resolve(fleetmap), run);
    for (const name of visits) {
      const load = loadavg()[0].toFixed(1);
      // All points in each frame, however long it takes.
      const result = await visit(browser, browserServer.process().pid, new URL('?share=all', url).href);
      console.log(
        `${name} (load ${load}): ${Object.entries(result)
          .map(([key, value]) => `${key} ${Number(value.toPrecision(3))}`)
          .join(', ')}`,
      );
      kept &&= visits.length === 1 || keeps(result);
    }
    while (!existsSync(previews)) await pause(100);
    server.kill('SIGINT');
    await new Promise((ended) => server.on('exit', ended));
  }
  await browser.close();
} finally {
  await browserServer.close();
}
process.exit(kept ? 0 : 1);
