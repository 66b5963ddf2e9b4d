// SPDX-License-Identifier: MIT
// The page of models that are only looked at.
import assert from 'node:assert/strict';
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
