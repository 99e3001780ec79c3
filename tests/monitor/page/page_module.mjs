// Modules of the page, bundled for Node: `const {toGeo} = await pageModule(PAGE_FOLDER, 'geodesy')`; several are
// joined. three.js is the one of the page's packages, loaded once; uPlot, which draws on a canvas, is replaced by
// fake_uplot.mjs.
import {mkdirSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';
import {fileURLToPath, pathToFileURL} from 'node:url';

const kFakePlot = fileURLToPath(new URL('fake_uplot.mjs', import.meta.url));

export const pageModule = (pageFolder, ...names) => bundled(pageFolder, names, []);

/** The page's program, which runs when it is imported; `fakes` take the place of modules: {map: 'fake_map.mjs'}. */
export const pageProgram = (pageFolder, fakes) =>
  bundled(
    pageFolder,
    ['main'],
    [
      {
        name: 'fakes',
        setup(build) {
          for (const [module, file] of Object.entries(fakes))
            build.onResolve({filter: new RegExp(`^\\./${module}$`)}, () => ({
              path: fileURLToPath(new URL(file, import.meta.url)),
            }));
        },
      },
    ],
  );

async function bundled(pageFolder, names, plugins) {
  const folder = resolve(pageFolder);
  const {build} = createRequire(join(folder, 'package.json'))('esbuild');
  const contents = names.map((name) => `export * from './${name}';`).join('\n');
  const bundles = join(folder, 'unit_bundles');
  mkdirSync(bundles, {recursive: true});
  const outfile = join(bundles, `${names.join('+')}.mjs`);
  await build({
    stdin: {contents, resolveDir: folder},
    bundle: true,
    format: 'esm',
    target: 'es2022',
    external: ['three', 'three/*'],
    alias: {uplot: kFakePlot},
    plugins,
    outfile,
  });
  return import(pathToFileURL(outfile));
}

/** A package of the page, as its modules have it: `const {parseHTML} = await pagePackage(PAGE_FOLDER, 'linkedom')`. */
export async function pagePackage(pageFolder, file) {
  return import(pathToFileURL(join(resolve(pageFolder), 'node_modules', file)));
}

export const three = (pageFolder) => pagePackage(pageFolder, 'three/build/three.module.js');
