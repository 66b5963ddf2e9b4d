// SPDX-License-Identifier: MIT
// Nothing that a person must read is cut or covered in a window of ordinary width.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import {test} from 'node:test';
import {Browser, pictures, shown} from './browser.mjs';
import {scenes} from './program.mjs';

const kRead = '#status span, .field label, .model h3, .model small, .plot h3 span, .plot h3 small, .readouts dt, .readouts small, .tools button';

/** Texts that are cut, and pairs of texts of the picture that lie on each other. */
function mistakes(page) {
  return page.evaluate((read) => {
    const seen = [...document.querySelectorAll(read)].filter((e) => e.getClientRects().length > 0);
    const cut = seen.filter((e) => e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== 'inline').map((e) => e.textContent);
    const boxes = [...document.querySelectorAll('.readouts > div, .views button, .ruler, .hint')].map((e) => ({text: e.textContent, box: e.getBoundingClientRect()}));
    const covered = [];
    for (const [i, a] of boxes.entries())
      for (const b of boxes.slice(i + 1))
        if (a.box.left < b.box.right && b.box.left < a.box.right && a.box.top < b.box.bottom && b.box.top < a.box.bottom) covered.push(`${a.text} / ${b.text}`);
    return {cut, covered};
  }, kRead);
}

for (const scene of ['teapot', 'two-arms'])
  test(`${scene}: in windows of three sizes no text is cut or covered`, () => Browser.alone({width: 800, height: 900}, async (sandbox, open) => {
    const {url} = await sandbox.show(scenes(scene));
    const page = await open(url);
    await shown(page);
    await page.locator('.field').first().waitFor();
    await page.waitForFunction(() => /missed/.test(document.querySelector('#status span').textContent));
    for (const [width, height] of [[800, 900], [1400, 900], [1000, 660]]) {
      await page.setViewportSize({width, height});
      await page.waitForTimeout(500);
      assert.deepEqual(await mistakes(page), {cut: [], covered: []}, `${width} x ${height}`);
      await page.screenshot({path: join(pictures, `${scene}-${width}x${height}.png`)});
    }
  }));

test('a page of a daemon that does not run says so, and how to start it', () => Browser.alone({width: 800, height: 600}, async (sandbox, open) => {
  const [url] = await sandbox.start(['view', '--name', 'nobody']).says(/http:\S+/);
  const page = await open(url);
  await page.waitForFunction(() => document.querySelector('#status span').textContent.includes('nobody'));
  assert.match(await page.locator('#status span').textContent(), /No daemon named nobody runs yet.*hapticd run SCENE --name nobody/);
  assert.deepEqual((await mistakes(page)).cut, []);
}));
