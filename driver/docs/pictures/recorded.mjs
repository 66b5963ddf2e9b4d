// SPDX-License-Identifier: MIT
// The page of a recorded run, to be photographed at any time of the run: a slow machine makes the same picture.
import {execFileSync} from 'node:child_process';
import {join} from 'node:path';
import {Browser, shown} from '../../../tests/e2e/view/browser.mjs';
import {hapticd, Sandbox, scenes} from '../../../tests/e2e/view/program.mjs';

/** Runs a scene for some seconds of virtual time and calls `photograph(page, at)`; at(t) shows second t of the run. */
export async function recorded(scene, seconds, size, photograph) {
  const sandbox = new Sandbox(), browser = await Browser.open(size);
  try {
    const run = join(sandbox.folder, 'run.h5');
    execFileSync(hapticd, ['run', scenes(scene), '--virtual-time', '--for', String(seconds), '--record', run], {stdio: 'ignore'});
    const [url] = await sandbox.start(['view', '--file', run]).says(/http:\S+/);
    const page = await browser.page(url);
    await shown(page);
    await page.locator('#play').click();
    await page.evaluate(() => {
      const {view} = window.hapticdView;
      view.pace = () => {}; // as fine as it can be: nobody waits
      view.ratio = 1;
      view.resize();
      document.getElementById('timeline').style.display = 'none';
      document.getElementById('scene-mode').textContent = '';
    });
    await photograph(page, async (t) => {
      await page.evaluate((to) => window.hapticdView.ask({do: 'seek', t: to}), t);
      await page.waitForFunction((to) => Math.abs(window.hapticdView.now.tick.t - to) < 2e-3, t);
      await page.evaluate(async () => {
        window.hapticdView.plots.next = 0;
        for (let k = 0; k < 3; ++k) await new Promise((resolve) => requestAnimationFrame(resolve));
      });
    });
  } finally {
    await browser.close();
    await sandbox.close();
  }
}

/** Looks at the scene from there. @param theta round the vertical, phi from it [rad] @param zoom below 1: nearer */
export const look = (page, theta, phi, zoom) => page.evaluate((from) => {
  const {view} = window.hapticdView;
  view.orbit.spherical.theta = from.theta;
  view.orbit.spherical.phi = from.phi;
  view.orbit.zoom(from.zoom);
  view.dirty = true;
}, {theta, phi, zoom});
