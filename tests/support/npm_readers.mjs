// Shared by tests that read what the program writes with packages of npm, which package.json and package-lock.json
// beside the test name. Ends with exit code 77, skipped, where npm cannot install them.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import {copyFileSync, mkdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

export const [fleetmap, installed] = process.argv.slice(2);

/** Installs the packages of the test at `url` into the folder that the command line names; returns their `require`. */
export function installReaders(url) {
  mkdirSync(installed, {recursive: true});
  for (const file of ['package.json', 'package-lock.json'])
    copyFileSync(join(dirname(fileURLToPath(url)), file), join(installed, file));
  const quiet = ['--ignore-scripts', '--no-audit', '--no-fund'],
    brief = ['--prefer-offline', '--fetch-retries=1', '--fetch-timeout=20000'];
  const npm = spawnSync('npm', ['ci', ...quiet, ...brief], {cwd: installed, encoding: 'utf8', timeout: 120_000});
  if (npm.status !== 0) {
    console.log(`skipped: npm cannot install the readers: ${npm.stderr}`);
    process.exit(77);
  }
  return createRequire(resolve(installed, 'package.json'));
}

/** Runs the program, which must end well; returns its output. */
export function run(...args) {
  const done = spawnSync(fleetmap, args, {encoding: 'utf8', timeout: 300_000});
  assert.equal(done.status, 0, `${args.join(' ')}: ${done.stderr}`);
  return done.stdout;
}
