// SPDX-License-Identifier: MIT
// Makes view.gif, the moving picture that the README begins with: a run is recorded, and its page is photographed at equal
// steps of the run's own time, so that a slow machine makes the same picture.
//
// Usage: node driver/docs/pictures/view.mjs [OUT.gif]     after `npm ci` in tests/e2e/view; needs the packages of
// `driver/install-packages picture`
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readdirSync, rmSync, statSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {Browser, shown} from '../../../tests/e2e/view/browser.mjs';
import {hapticd, Sandbox, scenes} from '../../../tests/e2e/view/program.mjs';

const here = dirname(fileURLToPath(import.meta.url)), out = process.argv[2] ?? join(here, 'view.gif');
const kFrom = 3, kSeconds = 6.6, kRate = 12; // s of the run; frames a second
const kWidth = 1120, kHeight = 700, kMostBytes = 2e6;

const frames = mkdtempSync(join(tmpdir(), 'hapticd-picture-'));
const sandbox = new Sandbox(), browser = await Browser.open({width: kWidth, height: kHeight});
try {
  const run = join(frames, 'run.h5');
  execFileSync(hapticd, ['run', scenes('teapot'), '--virtual-time', '--for', String(kFrom + kSeconds + 1), '--record', run], {stdio: 'ignore'});
  const [url] = await sandbox.start(['view', '--file', run]).says(/http:\S+/);
  const page = await browser.page(url);
  await shown(page);
  await page.locator('#play').click();
  await page.evaluate(() => {
    const {view} = window.hapticdView;
    view.pace = () => {}; // as fine as it can be: nobody waits
    view.ratio = 1;
    view.resize();
    view.orbit.spherical.theta = 0.25;
    view.orbit.spherical.phi = 1.2;
    view.orbit.zoom(0.8);
    view.dirty = true;
    document.getElementById('timeline').hidden = true;
    document.getElementById('scene-mode').textContent = '';
  });
  for (let i = 0; i < kSeconds * kRate; ++i) {
    const t = kFrom + i / kRate;
    await page.evaluate((at) => window.hapticdView.ask({do: 'seek', t: at}), t);
    await page.waitForFunction((at) => Math.abs(window.hapticdView.now.tick.t - at) < 2e-3, t);
    await page.evaluate(async () => {
      window.hapticdView.plots.next = 0;
      for (let k = 0; k < 3; ++k) await new Promise((resolve) => requestAnimationFrame(resolve));
    });
    await page.screenshot({path: join(frames, `${String(i).padStart(4, '0')}.png`)});
  }
  const shots = readdirSync(frames).filter((name) => name.endsWith('.png')).sort().map((name) => join(frames, name));
  execFileSync(join(here, 'gif.py'), [out, '880', String(kRate), ...shots], {stdio: 'inherit'});
  const {size} = statSync(out);
  console.log(`${out}: ${size} bytes`);
  if (size > kMostBytes) throw new Error(`more than ${kMostBytes} bytes: show less`);
} finally {
  await browser.close();
  await sandbox.close();
  rmSync(frames, {recursive: true});
}
