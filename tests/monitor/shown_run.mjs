// Shared by the tests of `fleetmap monitor`: a short run of the twin, and the program that shows it.
import assert from 'node:assert/strict';
import {spawn, spawnSync} from 'node:child_process';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';

/** Robots on a small farm for 30 s; `settings` are more of --set. Returns the run's folder. */
export function makeRun(fleetmap, folder, settings = [], robots = 2) {
  const out = join(folder, 'run');
  const source = join(fileURLToPath(new URL('../..', import.meta.url)), 'config/fleets/farm_small.yaml');
  const run = spawnSync(
    fleetmap,
    [
      'run',
      '-c',
      source,
      '--agents',
      String(robots),
      '--set',
      'max_time=30',
      ...settings.flatMap((one) => ['--set', one]),
      '--out',
      out,
    ],
    {encoding: 'utf8', timeout: 200_000},
  );
  assert.equal(run.status, 0, run.stderr);
  return out;
}

/** Opens a run on any free port; `url` is where, with the token if there is one. */
export async function serve(fleetmap, out, options = []) {
  const server = spawn(fleetmap, ['monitor', '--run', out, '--port', '0', ...options], {
    stdio: ['ignore', 'pipe', 'inherit'],
  });
  const url = await new Promise((found, failed) => {
    let said = '';
    server.stdout.on('data', (text) => {
      said += text;
      const match = said.match(/http:\S+/);
      if (match) found(match[0]);
    });
    server.on('exit', (code) => failed(new Error(`fleetmap monitor ended with ${code}: ${said}`)));
  });
  return {server, url};
}
