// SPDX-License-Identifier: MIT
// A tip with a radius is drawn as its ball, which rests on the surface while the arm goes into it.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, pictures, shown} from './browser.mjs';
import {hapticd, root, until} from './program.mjs';

let browser;
before(async () => { browser = await Browser.open({width: 900, height: 620}); });
after(() => browser.close());

const config = (...path) => join(root, 'config', ...path);
const box = (name, x, tip) => `  - {name: ${name}, plugin: nurbs_rigid, pose: {position: [${x}, 0, 0]}, parameters: {geometry: ${config('models', 'box.yaml')}, stiffness: 500${tip}}}\n`;
const scene = (radius) => `hapticd: 1
device: ${config('devices', 'simulated-premium15.yaml')}
hand: {script: press, center: [0, 0, -0.04], normal: [0, 0, 1], radius: ${radius}, approach: 0.01, rise: 0.003, rate: 0.5}
models:
`;

/** Presses models from `radius` in front of the box at the origin, and gives how the tip is drawn while it is pressed. */
async function drawn(sandbox, open, name, radius, models) {
  const file = join(sandbox.folder, `${name}.yaml`), h5 = join(sandbox.folder, `${name}.h5`);
  writeFileSync(file, scene(radius) + models);
  execFileSync(hapticd, ['run', file, '--virtual-time', '--for', '4', '--record', h5], {stdio: 'ignore'});
  const page = await open((await sandbox.start(['view', '--file', h5]).says(/http:\S+/))[0]);
  await shown(page);
  await page.waitForFunction(() => window.hapticdView.fitted); // the radius is known
  await page.waitForFunction(() => Math.max(...window.hapticdView.now.current().map((contact) => contact.depth)) > 1e-3);
  const found = await page.evaluate(async () => {
    for (let i = 0; i < 2; ++i) await new Promise((drawn) => requestAnimationFrame(drawn)); // with these contacts
    const {view: {probes: [probe]}} = window.hapticdView;
    return {ball: probe.tip.scale.x, above: probe.tip.position.z - 0.05, tip: probe.tipPlace.z - 0.05};
  });
  await page.screenshot({path: join(pictures, `${name}.png`)});
  return found;
}

test('the ball about the tip stays on the surface', () => browser.sandboxed(async (sandbox, open) => {
  const pressed = await drawn(sandbox, open, 'ball', 0.006, box('box', 0, ', tip_radius: 0.008'));
  assert.equal(pressed.ball, 0.008);
  assert.ok(Math.abs(pressed.above - 0.008) < 1e-4, `the ball is ${pressed.above} m above the box`);
  assert.ok(pressed.tip < 0.0075, `the tip is ${pressed.tip} m above the box`);
}, 'ball-failed'));

test('a model that is touched by a point beside one that is touched by a ball shows the tip itself', () => browser.sandboxed(async (sandbox, open) => {
  const pressed = await drawn(sandbox, open, 'point', 0, box('far', 0.3, ', tip_radius: 0.008') + box('box', 0, ''));
  assert.ok(pressed.ball < 0.008, `the tip has ${pressed.ball} m`);
  assert.equal(pressed.above, pressed.tip);
}, 'point-failed'));

test('the mouse presses with a ball no deeper than with a point', () => browser.sandboxed(async (sandbox, open) => {
  const file = join(sandbox.folder, 'mouse.yaml');
  writeFileSync(file, scene(0.03) + box('box', 0, ', tip_radius: 0.01'));
  const page = await open((await sandbox.show(file)).url);
  await shown(page);
  await page.waitForFunction(() => window.hapticdView.fitted && !window.hapticdView.fitWhenTip);
  await page.keyboard.press('1'); // from the front: the pointer looks along -z
  const [tip, middle] = await page.evaluate(() => {
    const {view} = window.hapticdView, {left, top} = view.canvas.getBoundingClientRect(), front = view.models.box().max.z;
    const places = [view.probes[0].tipPlace, view.probes[0].tipPlace.clone().set(0, 0, front)];
    return places.map((place) => view.project(place)).map(({x, y}) => ({x: x + left, y: y + top}));
  });
  await page.mouse.move(tip.x, tip.y);
  await page.mouse.down();
  await page.mouse.move(middle.x + 30, middle.y + 30, {steps: 5});
  await page.mouse.move(middle.x, middle.y);
  const wish = await until(() => page.evaluate(() => window.hapticdView.hand.wish(0)?.z), 60, 'a wish of the hand');
  const deep = 0.05 + 0.01 - wish; // behind the surface that the centre of the ball feels
  assert.ok(deep > 0.002 && deep < 0.006, `the mouse wants the tip ${deep} m deep`);
}, 'mouse-failed'));
