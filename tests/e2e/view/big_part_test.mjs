// SPDX-License-Identifier: MIT
// A part of a million triangles on the page: live, of a recording, and in Foxglove's protocol; and how large things are.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import protocol from '@foxglove/ws-protocol';
import {WebSocket} from 'ws';
import {Browser, look, pictures, shown} from './browser.mjs';
import {hapticd, root, Sandbox, scenes, until} from './program.mjs';

const kRings = 500, kFull = 4 * kRings * (kRings - 1), kPatience = 120;
let browser, sandbox, scene;

before(async () => {
  browser = await Browser.open({width: 1000, height: 660});
  sandbox = new Sandbox();
  const file = (name) => join(sandbox.folder, name);
  execFileSync('/usr/bin/python3', ['-c', `import sys; sys.path.insert(0, ${JSON.stringify(join(root, 'tests', 'support'))}); import bumpy_ball
bumpy_ball.write_stl(${JSON.stringify(file('ball.stl'))}, *bumpy_ball.mesh(${kRings}))`]);
  execFileSync(hapticd, ['import', file('ball.stl'), '-o', file('ball.hpart')], {stdio: 'ignore'});
  scene = file('ball.yaml');
  writeFileSync(scene, `hapticd: 1\nservo: {rate: 1000}\ndevice: ${join(root, 'config', 'devices', 'simulated-premium15.yaml')}\n` +
    'hand: {radius: 0.038}\nmodels:\n  - {name: ball, plugin: nurbs_rigid, parameters: {geometry: ball.hpart, stiffness: 600}}\n');
});
after(async () => {
  await browser.close();
  await sandbox.close();
});

/** What the page says about the drawing of the ball, and what it drew. */
const drawn = (page) => page.evaluate(() => ({
  words: document.querySelector('[data-model="ball"] .drawing').textContent, triangles: window.hapticdView.view.models.byIndex.get(0).triangles,
  notice: document.querySelector('#notice').hidden ? '' : document.querySelector('#notice').textContent,
}));

/** The page draws the ball coarser, and says so. */
async function checkDrawing(page, picture) {
  await shown(page);
  await page.locator('[data-model="ball"] .drawing').waitFor();
  const {words, triangles, notice} = await drawn(page);
  assert.ok(triangles > 62500 && triangles <= 125000, `a browser without a graphics card draws ${triangles} triangles`);
  const [, some, all, off] = words.match(/^Drawn with ([\d\s]+) of ([\d\s]+) triangles, at most ([\d.]+) mm off. It is felt exactly.$/) ?? assert.fail(words);
  assert.deepEqual([some, all].map((count) => Number(count.replace(/\s/g, ''))), [triangles, kFull]);
  assert.ok(Number(off) > 0 && Number(off) < 2, words);
  assert.equal(notice, '');
  await page.screenshot({path: join(pictures, picture)});
  assert.deepEqual(page.wrong, []);
}

test('a part of a million triangles is drawn, live and of a recording, and the page says that it is felt finer', async () => {
  const h5 = join(sandbox.folder, 'run.h5');
  const run = sandbox.start(['run', scene, '--name', 'test', '--record', h5]);
  let page;
  try {
    const [url] = await sandbox.start(['view', '--name', 'test']).says(/http:\S+/);
    page = await browser.page(url);
    await checkDrawing(page, 'big-part.png');
    await until(async () => (await look(page)).depth > 0, kPatience, 'a contact');
    await page.close();
    const frames = [], errors = [], socket = new WebSocket(url.replace('http', 'ws'), ['foxglove.sdk.v1']), client = new protocol.FoxgloveClient({ws: socket});
    client.on('error', (error) => errors.push(error));
    client.on('advertise', (channels) => client.subscribe(channels.find((c) => c.topic === '/scene').id));
    client.on('message', ({data}) => frames.push(JSON.parse(new TextDecoder().decode(data))));
    await until(() => frames.length > 0, kPatience, 'the triangles in /scene');
    const [{points, indices}] = frames[0].entities[0].triangles;
    assert.ok(indices.length > 3 * 100000 && indices.length <= 3 * 200000, `${indices.length / 3} triangles`);
    assert.ok(indices.every((i) => i < points.length));
    assert.deepEqual(errors, []);
    client.close();
    await run.end('SIGINT');
    const [recorded] = await sandbox.start(['view', h5]).says(/http:\S+/);
    page = await browser.page(recorded);
    await checkDrawing(page, 'big-part-recorded.png');
  } finally {
    await page?.close();
    await run.end();
  }
});

test('axes with letters and the width of the grid tell how large things are, at every zoom, also in a saved picture', () => browser.sandboxed(async (sandbox, open) => {
  const {url} = await sandbox.show(scenes('teapot'));
  const page = await open(url);
  await shown(page);
  /** The label, and how many pixels a square of the grid is wide in the middle of the picture. */
  const ruler = () => page.evaluate(async () => {
    await new Promise((resolve) => requestAnimationFrame(resolve));
    const {view} = window.hapticdView, {grid, orbit, ruler: {pitch}} = view, place = orbit.center.clone(), right = orbit.right();
    const at = [0, pitch].map((way) => view.project(place.clone().addScaledVector(right, way)).x);
    const lines = grid.geometry.getAttribute('position'), xs = new Set();
    for (let i = 0; i < lines.count; ++i) xs.add(Math.round((lines.getX(i) + grid.position.x) / pitch * 1e3) / 1e3);
    return {label: document.querySelector('#ruler').getAttribute('aria-label'), pitch, pixels: at[1] - at[0], whole: [...xs].every(Number.isInteger), lines: xs.size};
  });
  const first = await ruler();
  assert.match(first.label, /^Axes x, y, z; grid (10|20|50) mm$/);
  assert.equal(first.label.match(/(\d+) mm/)[1], String(Math.round(first.pitch * 1e3)));
  const seen = [];
  for (const step of [0.35, 0.35, 0.35, 0.35, 1 / 0.35, 1 / 0.35, 30]) {
    await page.evaluate((factor) => { const {view} = window.hapticdView; view.orbit.zoom(factor); view.dirty = true; }, step);
    const now = await ruler();
    seen.push(now.label);
    assert.ok(now.pixels >= 27.9 && now.pixels <= 70.1, `a square is ${now.pixels} pixels wide`);
    assert.ok(now.whole, 'lines are at multiples of the width');
    assert.ok(now.lines >= 3 && now.lines <= 122, `${now.lines} lines`);
  }
  assert.ok(new Set(seen).size >= 4 && seen.some((label) => /grid [125]00 mm|grid \d m/.test(label)) && seen.some((label) => /grid [125] mm/.test(label)), seen.join());
  await page.locator('#fit').click();
  await page.locator('[data-show="grid"]').evaluate((box) => box.click());
  assert.match((await ruler()).label, /z; \d+ mm$/, 'without the floor it is a plain scale');
  // pixels of the letters' and axes' colours, on the page and in the picture that a user saves
  const painted = await page.evaluate(async () => {
    const {view} = window.hapticdView, image = await createImageBitmap(await view.picture());
    const count = (source, x, y, width, height) => {
      const copy = Object.assign(document.createElement('canvas'), {width, height}), context = copy.getContext('2d');
      context.drawImage(source, -x, -y);
      const {data} = context.getImageData(0, 0, width, height);
      let red = 0, green = 0, blue = 0;
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b, a] = data.subarray(i, i + 4);
        if (a < 200) continue;
        red += r > 150 && g < 120 && b < 120;
        green += g > 120 && r < 100 && b < 140;
        blue += b > 150 && r < 100 && g < 140;
      }
      return [red, green, blue];
    };
    const page = view.ruler.canvas;
    return {page: count(page, 0, 0, page.width, page.height), saved: count(image, 0, image.height - 90, 170, 90)};
  });
  for (const [where, colours] of Object.entries(painted)) assert.ok(colours.every((pixels) => pixels > 12), `${where}: ${colours} pixels of x, y, z`);
}));
