// Bundles the page and writes it, compressed, as C++ source: node build.mjs OUT.cpp
import {build} from 'esbuild';
import {readFileSync, writeFileSync} from 'node:fs';
import {gzipSync} from 'node:zlib';

const out = process.argv[2];
const bundled = await build({
  entryPoints: ['main.ts', 'style.css'],
  bundle: true,
  minify: true,
  format: 'esm',
  target: 'es2020',
  outdir: 'bundle',
  write: false,
  legalComments: 'eof', // the licences of three.js and uPlot
});
const contentOf = (name) => bundled.outputFiles.find((file) => file.path.endsWith(name)).contents;
const files = [
  ['/index.html', 'text/html; charset=utf-8', readFileSync('index.html')],
  ['/main.js', 'text/javascript; charset=utf-8', contentOf('main.js')],
  ['/style.css', 'text/css; charset=utf-8', contentOf('style.css')],
];

const lines = [
  '#include <array>',
  '',
  '#include "fleetmap/monitor/server.hpp"',
  '',
  'namespace fleetmap::monitor {',
  'namespace {',
  '',
];
files.forEach(([, , content], k) => {
  const bytes = gzipSync(content, {level: 9});
  lines.push(`constexpr std::uint8_t kFile${k}[] = {${bytes.join(',')}};`);
});
lines.push('', `constexpr std::array<PageFile, ${files.length}> kPage{{`);
files.forEach(([path, type], k) => lines.push(`    {"${path}", "${type}", kFile${k}},`));
lines.push(
  '}};',
  '',
  '}  // namespace',
  '',
  'std::span<const PageFile> built_in_page() { return kPage; }',
  'std::string why_no_page() { return {}; }',
  '',
  '}  // namespace fleetmap::monitor',
  '',
);
writeFileSync(out, lines.join('\n'));
