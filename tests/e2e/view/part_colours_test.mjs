// SPDX-License-Identifier: MIT
// A CAD part on the page has the colours of its file.
import assert from 'node:assert/strict';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, pictures, shown} from './browser.mjs';
import {Sandbox, scenes} from './program.mjs';

let browser, sandbox;
before(async () => {
  browser = await Browser.open({width: 1000, height: 660});
  sandbox = new Sandbox();
});
after(async () => {
  await browser.close();
  await sandbox.close();
});

/** How many pixels of the page's own picture have the colours of the bodies of as1. */
const pixels = (page) => page.evaluate(async () => {
  const picture = await createImageBitmap(await window.hapticdView.view.picture());
  const canvas = new OffscreenCanvas(picture.width, picture.height), context = canvas.getContext('2d');
  context.drawImage(picture, 0, 0);
  const {data} = context.getImageData(0, 0, canvas.width, canvas.height), count = {blue: 0, red: 0, green: 0};
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b] = data.subarray(i, i + 3);
    if (b > 1.6 * r && b > 1.6 * g && b > 60) ++count.blue;
    if (r > 1.6 * g && r > 1.6 * b && r > 60) ++count.red;
    if (g > 1.3 * r && g > 1.6 * b && g > 60) ++count.green;
  }
  return count;
});

test('a CAD part has the colours of its file, and so has the swatch of its model', async () => {
  const {url} = await sandbox.show(scenes('as1'));
  const page = await browser.page(url);
  await shown(page, 4);
  await page.screenshot({path: join(pictures, 'part-colours.png')});
  const {blue, red, green} = await pixels(page);
  assert.ok(blue > 200 && red > 500 && green > 3000, `bolts ${blue}, rod ${red}, plate and brackets ${green} pixels`);
  const swatches = await page.evaluate(() => [...document.querySelectorAll('[data-model] .swatch')].map((swatch) => swatch.style.background));
  assert.deepEqual(swatches.map((background) => new Set(background.match(/rgb\([^)]*\)/g)).size), [1, 3, 3, 2], swatches.join('\n'));
  assert.deepEqual(page.wrong, []);
});
