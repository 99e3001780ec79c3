// A module of the page, bundled for Node: `const {toGeo} = await pageModule(PAGE_FOLDER, 'geodesy')`; several are joined.
import {createRequire} from 'node:module';
import {join, resolve} from 'node:path';

export async function pageModule(pageFolder, ...names) {
  const folder = resolve(pageFolder);
  const {build} = createRequire(join(folder, 'package.json'))('esbuild');
  const contents = names.map((name) => `export * from './${name}';`).join('\n');
  const bundle = await build({stdin: {contents, resolveDir: folder}, bundle: true, format: 'esm', write: false});
  return import(`data:text/javascript;base64,${Buffer.from(bundle.outputFiles[0].contents).toString('base64')}`);
}
