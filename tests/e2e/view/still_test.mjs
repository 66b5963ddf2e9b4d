// SPDX-License-Identifier: MIT
// The page of models that are only looked at.
import assert from 'node:assert/strict';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import {Browser, pictures} from './browser.mjs';
import {root, scenes} from './program.mjs';

const open = async (sandbox, show, file) => {
  const [url] = await sandbox.start(['view', file]).says(/http:\S+/, 120);
  const page = await show(url);
  await page.waitForFunction(() => window.hapticdView?.view?.frames > 0 && window.hapticdView.view.models.byIndex.size > 0 &&
    document.getElementById('read-size').value !== '–');
  return page;
};

test('a part is shown with its size, and without what belongs to a run', () => Browser.alone({width: 900, height: 660}, async (sandbox, show) => {
  const page = await open(sandbox, show, join(root, 'config', 'models', 'sphere.yaml'));
  const size = await page.locator('#read-size').inputValue().catch(() => page.locator('#read-size').textContent());
  const lengths = size.split(' × ').map(Number);
  assert.ok(lengths.length === 3 && Math.max(...lengths) - Math.min(...lengths) < 0.01 * Math.max(...lengths), `a ball is as wide as high: ${size}`);
  for (const id of ['timeline', 'plots', 'run-tools', 'read-depth', 'tab-events', 'hint'])
    assert.equal(await page.locator(`#${id}`).isVisible(), false, `${id} is hidden`);
  assert.match(await page.locator('#status').innerText(), /no arm/);
  assert.match(await page.locator('#models').innerText(), /sphere/);
  await page.locator('#tab-show').click();
  assert.equal(await page.locator('[data-show=wire]').isVisible(), true);
  assert.equal(await page.locator('[data-show=arm]').isVisible(), false);
  const before = await page.evaluate(() => window.hapticdView.view.orbit.camera.position.toArray());
  await page.keyboard.press('7');
  await page.waitForFunction((old) => Math.abs(window.hapticdView.view.orbit.camera.position.y - old) > 1e-3, before[1]);
  await page.keyboard.press(' ');
  assert.equal(await page.locator('#notice').isVisible(), false, 'space has nothing to hold');
  await page.screenshot({path: join(pictures, 'still.png')});
}));

test('a scene is shown with all its models, and without its arms', () => Browser.alone({width: 900, height: 660}, async (sandbox, show) => {
  const page = await open(sandbox, show, scenes('two-arms'));
  const seen = await page.evaluate(() => ({probes: window.hapticdView.view.probes.length, models: [...window.hapticdView.view.models.byIndex.values()].map((m) => m.name)}));
  assert.equal(seen.probes, 0);
  assert.ok(seen.models.length >= 1, `${seen.models}`);
}));

test('what is larger than a metre has its size in metres', () => Browser.alone({width: 900, height: 660}, async (sandbox, show) => {
  const page = await open(sandbox, show, join(root, 'config', 'models', 'teapot.bpt')); // some metres: its unit is its own
  const lengths = (await page.locator('#read-size').textContent()).split(' × ').map(Number);
  assert.equal(await page.locator('#read-size-unit').textContent(), 'm');
  assert.ok(lengths.every((length) => length > 1 && length < 10), `${lengths}`);
}));

/** A sheet of two halves in mm. The right one has its own corners along their common edge, every other one beside it. */
function crackedSheet(cracks) {
  const lines = ['v -50 -50 0', 'v 0 -50 0', 'v 0 50 0', 'v -50 50 0', 'f 1 2 3 4', 'v 50 0 0'];
  for (let i = 0; i <= cracks; ++i) lines.push(`v ${i % 2 ? 0.2 : 0} ${-50 + 100 * i / cracks} 0`);
  for (let i = 0; i < cracks; ++i) lines.push(`f 5 ${7 + i} ${6 + i}`);
  return lines.join('\n');
}

test('cracks between faces that were cut apart do not show', () => Browser.alone({width: 900, height: 660}, async (sandbox, show) => {
  const file = join(sandbox.folder, 'sheet.obj');
  writeFileSync(file, crackedSheet(60));
  const [url] = await sandbox.start(['view', file, '--scale', '0.001']).says(/http:\S+/, 120);
  const page = await show(url);
  await page.waitForFunction(() => window.hapticdView?.view?.frames > 0 && window.hapticdView.view.models.byIndex.get(0)?.seams);
  const [without, filled] = await page.evaluate(() => {
    const {view} = window.hapticdView, gl = view.renderer.getContext(), {drawingBufferWidth: width, drawingBufferHeight: height} = gl;
    view.show('grid', false);
    const specks = (seams) => { // pixels that differ from both neighbours, which are alike
      view.models.byIndex.get(0).seams.visible = seams;
      view.renderer.render(view.scene, view.orbit.camera);
      const pixels = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      const differ = (a, b) => Math.abs(pixels[4 * a] - pixels[4 * b]) > 20;
      let count = 0;
      for (let i = 1; i < width * height - 1; ++i) count += differ(i, i - 1) && differ(i, i + 1) && !differ(i - 1, i + 1);
      return count;
    };
    return [specks(false), specks(true)];
  });
  assert.ok(without > 20, `the sheet has cracks: ${without} pixels`);
  assert.ok(filled < without / 4, `${filled} of ${without} pixels are left`);
}));
