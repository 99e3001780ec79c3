// Opens report.html of a run in headless Chromium, from the disk as a person would: at 1366 px and at 390 px it is no
// wider than the window, warnings stand first, the map is there, nothing is loaded and the console is silent.
//   node report_page_test.mjs FLEETMAP PAGE_FOLDER [SCREENSHOTS]   exit code 77: skipped, since Chromium is missing
import assert from 'node:assert/strict';
import {rmSync} from 'node:fs';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';
import {fleetmap, folder, openBrowser, shot} from './browser.mjs';
import {makeRun} from './shown_run.mjs';

async function visit(browser, url, width, height) {
  const context = await browser.newContext({viewport: {width, height}, isMobile: width < 500, hasTouch: width < 500});
  const page = await context.newPage();
  const said = [];
  const asked = [];
  page.on('console', (message) => said.push(message.text()));
  page.on('pageerror', (error) => said.push(String(error)));
  page.on('request', (request) => request.url().startsWith('data:') || asked.push(request.url()));
  await page.goto(url);
  const sizes = await page.evaluate(() => ({
    // A phone's window.innerWidth grows with a page that is too wide.
    width: document.documentElement.scrollWidth,
    headings: [...document.querySelectorAll('h2')].map((one) => one.textContent),
    picture: document.querySelector('img')?.naturalWidth ?? 0,
    // Sentences must be read without scrolling a table sideways for each line: no wider than the window.
    sentences: Math.max(0, ...[...document.querySelectorAll('td.sentence, li, p')].map((one) => one.offsetWidth)),
  }));
  assert.ok(sizes.width <= width, `at ${width} px the page is ${sizes.width} px wide`);
  assert.ok(sizes.sentences <= width, `at ${width} px a sentence is ${sizes.sentences} px wide`);
  assert.equal(sizes.headings[0], 'Warnings');
  for (const heading of ['Map', 'Is it georeferenced?', 'Which robots are joined?', 'Sensors', 'Radio'])
    assert.ok(sizes.headings.includes(heading), `${heading} is missing`);
  assert.ok(sizes.picture > 500, 'the map is not drawn');
  assert.deepEqual(said, []);
  assert.deepEqual(asked, [url]);
  await shot(page, `report_${width}`);
  await context.close();
}

const browser = await openBrowser();
try {
  const run = process.env.FLEETMAP_RUN ?? makeRun(fleetmap, folder);
  const url = pathToFileURL(join(run, 'report.html')).href;
  await visit(browser, url, 1366, 768);
  await visit(browser, url, 390, 844);
} finally {
  await browser.close();
  rmSync(folder, {recursive: true, force: true});
}
