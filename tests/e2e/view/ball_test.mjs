// SPDX-License-Identifier: MIT
// A tip with a radius is drawn as its ball, which rests on the surface while the arm goes into it.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, pictures, shown} from './browser.mjs';
import {hapticd, root} from './program.mjs';

let browser;
before(async () => { browser = await Browser.open({width: 900, height: 620}); });
after(() => browser.close());

const config = (...path) => join(root, 'config', ...path);
const scene = `hapticd: 1
device: ${config('devices', 'simulated-premium15.yaml')}
hand: {script: press, center: [0, 0, -0.04], normal: [0, 0, 1], radius: 0.006, approach: 0.01, rise: 0.003, rate: 0.5}
models:
  - {name: box, plugin: nurbs_rigid, parameters: {geometry: ${config('models', 'box.yaml')}, stiffness: 500, tip_radius: 0.008}}
`;

test('the ball about the tip stays on the surface', () => browser.sandboxed(async (sandbox, open) => {
  const file = join(sandbox.folder, 'ball.yaml'), h5 = join(sandbox.folder, 'ball.h5');
  writeFileSync(file, scene);
  execFileSync(hapticd, ['run', file, '--virtual-time', '--for', '4', '--record', h5], {stdio: 'ignore'});
  const page = await open((await sandbox.start(['view', '--file', h5]).says(/http:\S+/))[0]);
  await shown(page);
  const pressed = await (await page.waitForFunction(() => {
    const {now, view} = window.hapticdView, [probe] = view.probes;
    const depth = Math.max(...now.current().map((contact) => contact.depth));
    return depth > 1e-3 && probe.tip.position.distanceTo(probe.tipPlace) > 5e-4 && {depth, ball: probe.tip.scale.x, above: probe.tip.position.z - 0.05, tip: probe.tipPlace.z - 0.05};
  })).jsonValue();
  await page.screenshot({path: join(pictures, 'ball.png')});
  assert.equal(pressed.ball, 0.008);
  assert.ok(Math.abs(pressed.above - 0.008) < 1e-4, `the ball is ${pressed.above} m above the box`);
  assert.ok(pressed.tip < 0.0075, `the tip is ${pressed.tip} m above the box`);
}, 'ball-failed'));
