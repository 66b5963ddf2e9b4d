// SPDX-License-Identifier: MIT
// Makes view.gif, the moving picture that the README begins with.
//
// Usage: node driver/docs/pictures/view.mjs [OUT.gif]     after `npm ci` in tests/e2e/view; needs the packages of
// `driver/install-packages picture`
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readdirSync, rmSync, statSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {look, recorded} from './recorded.mjs';

const here = dirname(fileURLToPath(import.meta.url)), out = process.argv[2] ?? join(here, 'view.gif');
const kFrom = 3, kSeconds = 6.6, kRate = 12; // s of the run; frames a second
const kMostBytes = 2e6;

const frames = mkdtempSync(join(tmpdir(), 'hapticd-picture-'));
try {
  await recorded('teapot', kFrom + kSeconds + 1, {width: 1120, height: 700}, async (page, at) => {
    await look(page, 0.25, 1.2, 0.8);
    for (let i = 0; i < kSeconds * kRate; ++i) {
      await at(kFrom + i / kRate);
      await page.screenshot({path: join(frames, `${String(i).padStart(4, '0')}.png`)});
    }
  });
  const shots = readdirSync(frames).sort().map((name) => join(frames, name));
  execFileSync(join(here, 'gif.py'), [out, '880', String(kRate), ...shots], {stdio: 'inherit'});
  const {size} = statSync(out);
  console.log(`${out}: ${size} bytes`);
  if (size > kMostBytes) throw new Error(`more than ${kMostBytes} bytes: show less`);
} finally {
  rmSync(frames, {recursive: true});
}
