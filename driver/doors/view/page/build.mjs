// SPDX-License-Identifier: MIT
// Bundles the page into ../bundle, or into the given folder. The bundle contains the used parts of three.js and uPlot, no
// source maps, and nothing that depends on the machine.
import {build} from 'esbuild';
import {copyFileSync, mkdirSync, readFileSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, '..', 'bundle');
mkdirSync(out, {recursive: true});
/** Returns a package's licence as a comment, because copies must carry it. */
const licence = (name) => `/* ${name}\n${readFileSync(join(here, 'node_modules', name, 'LICENSE'), 'utf8').trim()}\n*/`;
await build({
  absWorkingDir: here,
  entryPoints: [{in: 'src/main.js', out: 'app'}, {in: 'src/style.css', out: 'app'}],
  outdir: out,
  bundle: true,
  minify: true,
  format: 'esm',
  target: ['chrome115', 'firefox115', 'safari17'],
  legalComments: 'none',
  footer: {js: `${licence('three')}\n${licence('uplot')}`, css: licence('uplot')},
  logLevel: 'warning',
});
for (const file of ['index.html', 'icon.svg']) copyFileSync(join(here, file), join(out, file));
