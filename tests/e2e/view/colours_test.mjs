// SPDX-License-Identifier: MIT
// Models on the page have the colours of their files: of CAD parts, of the materials of OBJ, and of the vertices of PLY.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, pictures, shown} from './browser.mjs';
import {hapticd, root, scenes} from './program.mjs';

let browser;
before(async () => { browser = await Browser.open({width: 1000, height: 660}); });
after(() => browser.close());

/** How many colours the swatch of each model has. */
async function swatches(page) {
  const backgrounds = await page.evaluate(() => [...document.querySelectorAll('[data-model] .swatch')].map((swatch) => swatch.style.background));
  return backgrounds.map((background) => new Set(background.match(/rgb\([^)]*\)/g)).size);
}

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

const kCorners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
const kFaces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/** A cube, each face with a material. */
const obj = () => ['mtllib cube.mtl', ...kCorners.map((p) => `v ${p.join(' ')}`), ...kFaces.flatMap((face, i) => [`usemtl m${i}`, `f ${face.map((k) => k + 1).join(' ')}`])].join('\n');
const mtl = () => [[1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 1, 0], [0, 0, 1]].map((kd, i) => `newmtl m${i}\nKd ${kd.join(' ')}\n`).join('');
/** A cube whose corners have the colour of their place. */
const ply = () => ['ply', 'format ascii 1.0', 'element vertex 8', ...['x', 'y', 'z'].map((axis) => `property float ${axis}`), ...['red', 'green', 'blue'].map((c) => `property uchar ${c}`),
  'element face 6', 'property list uchar int vertex_indices', 'end_header', ...kCorners.map((p) => `${p.join(' ')} ${p.map((x) => 255 * x).join(' ')}`), ...kFaces.map((face) => `4 ${face.join(' ')}`), ''].join('\n');

test('a mesh has the colours of its file, and so has the swatch of its model', () => browser.sandboxed(async (sandbox, open) => {
  const file = (name) => join(sandbox.folder, name);
  for (const [name, text] of [['cube.obj', obj()], ['cube.mtl', mtl()], ['blend.ply', ply()]]) writeFileSync(file(name), text);
  for (const [from, to] of [['cube.obj', 'cube.hpart'], ['blend.ply', 'blend.hpart']])
    execFileSync(hapticd, ['import', file(from), '--scale', '0.06', '--center', '-o', file(to)], {stdio: 'ignore'});
  writeFileSync(file('cubes.yaml'), `hapticd: 1\ndevice: ${join(root, 'config', 'devices', 'simulated-premium15.yaml')}\nmodels:\n` +
    ['cube', 'blend'].map((name, i) => `  - {name: ${name}, plugin: nurbs_rigid, pose: {position: [${0.1 * i - 0.05}, 0, 0], orientation: [0.8681355, 0.2494642, 0.4290785, 0]}, parameters: {geometry: ${name}.hpart, stiffness: 600}}\n`).join(''));
  const {url} = await sandbox.show(file('cubes.yaml'));
  const page = await open(url);
  await shown(page, 2);
  await page.screenshot({path: join(pictures, 'mesh-colours.png')});
  const words = await page.evaluate(() => [0, 1].map((i) => {
    const {array} = window.hapticdView.view.models.byIndex.get(i).mesh.geometry.getAttribute('color'), words = new Set();
    for (let k = 0; k < array.length; k += 3) words.add([...array.subarray(k, k + 3)].map((x) => Math.round(8 * x)).join());
    return words.size;
  }));
  assert.deepEqual(words, [3, 8], 'colours of the vertices');
  assert.deepEqual(await swatches(page), [3, 4]);
}));

test('a CAD part has the colours of its file, and so has the swatch of its model', () => browser.sandboxed(async (sandbox, open) => {
  const {url} = await sandbox.show(scenes('as1'));
  const page = await open(url);
  await shown(page, 4);
  await page.screenshot({path: join(pictures, 'part-colours.png')});
  const {blue, red, green} = await pixels(page);
  assert.ok(blue > 200 && red > 500 && green > 3000, `bolts ${blue}, rod ${red}, plate and brackets ${green} pixels`);
  assert.deepEqual(await swatches(page), [1, 3, 3, 2]);
}));
