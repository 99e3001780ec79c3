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

/** Every control has a name for screen readers. */
export async function everythingIsNamed(page) {
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('button, input, select, canvas, [role=tab]')]
      .filter((one) => !(one.getAttribute('aria-label') || one.textContent.trim() || one.labels?.length))
      .map((one) => one.outerHTML.slice(0, 80)),
  );
  assert.deepEqual(nameless, []);
}
