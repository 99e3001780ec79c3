// Shared by the tests of the page: headless Chromium, screenshots, and what holds for every page. Ends with exit code
// 77, skipped, where Chromium is missing.
import assert from 'node:assert/strict';
import {existsSync, mkdtempSync} from 'node:fs';
import {createRequire} from 'node:module';
import {tmpdir} from 'node:os';
import {join, resolve} from 'node:path';

export const [fleetmap, pageFolder, screenshots] = process.argv.slice(2);
const require = createRequire(resolve(pageFolder, 'package.json'));
const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!executablePath) {
  console.log('skipped: Chromium is not installed (apt install chromium)');
  process.exit(77);
}
const {chromium} = require('playwright-core');
export const folder = mkdtempSync(join(tmpdir(), 'fleetmap_page_'));

export function openBrowser() {
  const args = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'];
  return chromium.launch({executablePath, args});
}

export async function shot(page, name) {
  if (screenshots) await page.screenshot({path: join(screenshots, `${name}.png`)});
}

/** Every control has a name for screen readers; that of a button may be its text, that of a menu is not. */
export async function everythingIsNamed(page) {
  const nameless = await page.evaluate(() => {
    const text = (one) => one?.textContent.trim();
    const nameOf = (one) =>
      one.getAttribute('aria-label') ||
      text(document.getElementById(one.getAttribute('aria-labelledby'))) ||
      [...(one.labels ?? [])].some(text) ||
      (one.matches('button, [role=tab]') && text(one));
    return [...document.querySelectorAll('button, input, select, canvas, [role=tab]')]
      .filter((one) => !nameOf(one))
      .map((one) => one.outerHTML.slice(0, 80));
  });
  assert.deepEqual(nameless, []);
}

/** The text of an element with common spaces, also between numbers and their units. */
export const spaced = async (locator) => (await locator.textContent()).replaceAll('\u00a0', ' ');

/** All errors and warnings that the page causes from now on. */
export function noteErrors(page) {
  const said = [];
  // Software rendering makes Chromium warn of its own slowness.
  const isOwn = (text) => text.includes('GPU stall') || text.includes('swiftshader');
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type()) && !isOwn(message.text())) said.push(message.text());
  });
  page.on('pageerror', (error) => said.push(String(error)));
  return said;
}

/** Number of colours and of covered pixels in the map's middle. */
export async function pixelsOfMap(page) {
  return page.evaluate(
    () =>
      new Promise((done) =>
        requestAnimationFrame(() => {
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
            colours.add(((data[k] >> 4) << 8) | ((data[k + 1] >> 4) << 4) | (data[k + 2] >> 4));
          }
          done({covered: covered / (data.length / 4), colours: colours.size});
        }),
      ),
  );
}

/** The card lies wholly in the window and leaves the map's middle free, where what it describes is drawn. */
export async function cardIsBesideItsThing(page) {
  const at = await page.evaluate(() => {
    const card = document.getElementById('card').getBoundingClientRect(),
      map = document.getElementById('canvas').getBoundingClientRect();
    const inCard = (y) => y > card.top && y < card.bottom;
    const middle = (map.top + map.bottom) / 2;
    return {top: card.top, bottom: card.bottom, height: window.innerHeight, middle, covered: inCard(middle)};
  });
  assert.ok(at.top >= 0 && at.bottom <= at.height + 1, `the card is out of the window: ${JSON.stringify(at)}`);
  assert.ok(at.middle > 0 && at.middle < at.height && !at.covered, `what it describes is not: ${JSON.stringify(at)}`);
}
