// Runs the tests of the page's modules, all of them or those that are named, one after the other in one process.
//   node run_units.mjs PAGE_FOLDER [NAME...]
import {readdirSync} from 'node:fs';

const suffix = '_test.mjs';
const all = readdirSync(new URL('.', import.meta.url))
  .filter((file) => file.endsWith(suffix))
  .map((file) => file.slice(0, -suffix.length));
const wanted = process.argv.slice(3);
let failed = 0;
for (const name of wanted.length > 0 ? wanted : all.sort()) {
  try {
    await import(`./${name}${suffix}`);
    console.log(`ok      ${name}`);
  } catch (error) {
    ++failed;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
process.exit(failed > 0 ? 1 : 0);
