// node script_functions.mjs SOURCES PAGE: functions of the page and of the tests that Node runs stay so short that they
// are read at once. PAGE: the folder with the page's packages, of which TypeScript parses the files.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';

const kMaxFunctionLines = 50;

const [sources, page] = process.argv.slice(2);
const ts = createRequire(join(page, 'package.json'))('typescript');

const files = ['src', 'tests'].flatMap((root) =>
  readdirSync(join(sources, root), {recursive: true, withFileTypes: true})
    .filter((entry) => entry.isFile() && /\.(ts|mjs)$/.test(entry.name))
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name)),
);
assert.ok(files.length > 50, 'the scan found hardly any script');

let functions = 0;
const long = [];
for (const file of files) {
  const source = ts.createSourceFile(file, readFileSync(file, 'utf8'), ts.ScriptTarget.Latest, true);
  const line = (at) => source.getLineAndCharacterOfPosition(at).line + 1;
  const visit = (node) => {
    if (ts.isFunctionLike(node) && node.body) {
      ++functions;
      const lines = line(node.end) - line(node.getStart(source)) + 1;
      if (lines > kMaxFunctionLines) long.push(`${file}:${line(node.getStart(source))} has ${lines} lines`);
    }
    ts.forEachChild(node, visit);
  };
  visit(source);
}
assert.ok(functions > 500, 'the scan found hardly any function');
assert.deepEqual(long, []);
