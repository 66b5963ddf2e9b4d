// SPDX-License-Identifier: MIT
// Makes as1.png: the assembly as1 on the page, while the hand pushes its rod.
//
// Usage: node driver/docs/pictures/as1.mjs [OUT.png]     after `npm ci` in tests/e2e/view; needs the packages of
// `driver/install-packages view`
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {look, recorded} from './recorded.mjs';

const out = process.argv[2] ?? join(dirname(fileURLToPath(import.meta.url)), 'as1.png');
await recorded('as1', 6, {width: 1120, height: 640}, async (page, at) => {
  await look(page, 0.5, 1.15, 0.75);
  await at(4.6);
  await page.screenshot({path: out});
});
