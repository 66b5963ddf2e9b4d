// SPDX-License-Identifier: MIT
// The page over time: a recording, what a crash left, a connection or a daemon that ends and comes back.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {existsSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, keepSockets, look, pictures, shown} from './browser.mjs';
import {hapticd, root, scenes, until} from './program.mjs';

const kPatience = 120; // s: a machine that is busy is slow, not wrong
let browser;
before(async () => { browser = await Browser.open({width: 1000, height: 660}); }); // few pixels: a processor draws them
after(async () => { await browser.close(); });

test('a recording has a slider, and its rows are those of the file', () => browser.sandboxed(async (sandbox, open) => {
  const h5 = join(sandbox.folder, 'run.h5'), csv = join(sandbox.folder, 'ticks.csv');
  execFileSync(hapticd, ['run', scenes('button'), '--virtual-time', '--for', '6', '--record', h5], {stdio: 'ignore'});
  execFileSync(hapticd, ['export', h5, '--csv', csv, '--stream', 'ticks']);
  const [head, ...rows] = readFileSync(csv, 'utf8').trimEnd().split('\n').map((r) => r.split(','));
  const view = sandbox.start(['view', '--file', h5]);
  const [url] = await view.says(/http:\S+/);
  const page = await open(url);
  await shown(page, 1);
  await page.locator('#play').click(); // it plays by itself
  await page.waitForFunction(() => window.hapticdView.timeline.state.playing === false);
  for (const t of [4.5, 1.25, 5.9, 0]) {
    await page.locator('#seek').evaluate((slider, value) => { slider.value = value; slider.dispatchEvent(new Event('input')); }, t);
    const seen = await until(async () => {
      const s = await look(page);
      return Math.abs(s.t - t) < 2e-3 ? s : null;
    }, kPatience, `a row at ${t} s`);
    const row = rows.find((r) => Number(r[0]) === seen.tick), at = (name) => Number(row[head.indexOf(name)]);
    const depth = at('depth');
    assert.ok(Object.is(seen.depth, depth), `depth ${seen.depth}, in the file ${depth}`);
    const tip = await page.evaluate(() => window.hapticdView.now.arms[0].now.position);
    assert.deepEqual(tip, ['arm0_x', 'arm0_y', 'arm0_z'].map(at));
  }
  await page.locator('#speed').selectOption('4');
  await page.waitForFunction(() => window.hapticdView.timeline.state.playing);
  await until(async () => (await look(page)).t > 3, kPatience, 'three seconds, four times as fast');
  await page.screenshot({path: join(pictures, 'recording.png')});
  assert.equal(await page.locator('#run-tools').isVisible(), false, 'a recording cannot be changed');
  await page.setViewportSize({width: 390, height: 844}); // a phone
  const [slider, line] = await page.evaluate(() => ['#seek', '#timeline'].map((id) => document.querySelector(id).getBoundingClientRect().width));
  assert.ok(slider > 0.8 * line, `a finger has the whole line for the slider: ${slider} of ${line} pixels`);
  await page.setViewportSize({width: 1000, height: 660});
}));

test('a recording goes on where it was when the connection is back', () => browser.sandboxed(async (sandbox, open) => {
  const h5 = join(sandbox.folder, 'run.h5');
  execFileSync(hapticd, ['run', scenes('sphere'), '--virtual-time', '--for', '6', '--record', h5], {stdio: 'ignore'});
  const [url] = await sandbox.start(['view', '--file', h5]).says(/http:\S+/);
  const page = await open(url, keepSockets);
  await shown(page);
  await page.locator('#speed').selectOption('0.25');
  await page.locator('#loop').uncheck();
  await page.locator('#play').click();
  await page.waitForFunction(() => window.hapticdView.timeline.state.playing === false);
  await page.locator('#seek').evaluate((slider) => { slider.value = 4.5; slider.dispatchEvent(new Event('input')); });
  await until(async () => Math.abs((await look(page)).t - 4.5) < 2e-3, kPatience, 'a row at 4.5 s');
  await page.evaluate(() => window.sockets.at(-1).close());
  await until(() => page.evaluate(() => window.sockets.length === 2 && window.sockets[1].readyState === 1), kPatience, 'the connection');
  await until(async () => {
    const state = await page.evaluate(() => window.hapticdView.timeline.state);
    return !state.playing && !state.loop && state.speed === 0.25 && Math.abs(state.t - 4.5) < 5e-3;
  }, kPatience, 'the same place, paused');
  await page.waitForFunction(() => window.hapticdView.now?.arms.every((arm) => arm.now)); // rows come after the place
  await until(async () => Math.abs((await look(page)).t - 4.5) < 5e-3, kPatience, 'its row');
}));

test('what a crash left is shown, plays in a loop, and its events have times', () => browser.sandboxed(async (sandbox, open) => {
  const daemon = sandbox.start(['run', scenes('button'), '--name', 'test']);
  await until(() => existsSync(join(sandbox.folder, 'test.sock')), kPatience, 'a daemon');
  await new Promise((resolve) => setTimeout(resolve, 2000));
  execFileSync(hapticd, ['ctl', '--name', 'test', 'mark', 'trial <b>7</b> begins'], {env: {...process.env, ...sandbox.env}, stdio: 'ignore'});
  await new Promise((resolve) => setTimeout(resolve, 2000));
  await daemon.end('SIGKILL');
  const [url] = await sandbox.start(['view', '--file', join(sandbox.folder, 'test.blackbox.h5')]).says(/http:\S+/);
  const page = await open(url);
  await shown(page);
  const state = await page.evaluate(() => window.hapticdView.timeline.state);
  assert.ok(state.to - state.from > 2, `it holds ${state.to - state.from} s`);
  await page.locator('#speed').selectOption('4');
  const times = [];
  await until(async () => {
    times.push((await look(page)).t);
    return times.some((t, i) => i > 0 && t < times[i - 1] - 1);
  }, kPatience, 'its beginning after its end');
  await page.locator('#loop').uncheck();
  await until(() => page.evaluate(() => window.hapticdView.timeline.state.playing === false), kPatience, 'a stop at the end');
  await page.getByRole('tab', {name: 'Events'}).click();
  await page.getByText('button: click').first().waitFor();
  const mark = page.locator('#events li', {has: page.getByText('trial <b>7</b> begins', {exact: true})}); // as text
  await mark.first().waitFor();
  assert.equal(await mark.first().locator('i').getAttribute('class'), 'mark');
  assert.ok(await page.evaluate(() => window.hapticdView.plots.marks.some(({kind}) => kind === 'mark')), 'a line in the plots');
  assert.equal(await page.getByText('marked', {exact: true}).count(), 0, 'it is told once');
  await page.screenshot({path: join(pictures, 'crash.png')});
}));

const premium = join(root, 'config', 'devices', 'simulated-premium15.yaml');
/** A scene with one model of a shape that ships. */
function sceneOf(sandbox, name, geometry, x, parameters = '') {
  const file = join(sandbox.folder, `${name}-${geometry}.yaml`);
  writeFileSync(file, `hapticd: 1\ndevice: ${premium}\nmodels:\n  - {name: ${name}, plugin: nurbs_rigid, pose: {position: [${x}, 0, 0]},` +
    ` parameters: {geometry: ${join(root, 'config', 'models', `${geometry}.yaml`)}${parameters}}}\n`);
  return file;
}
/** What is drawn: the name, the number of triangles and the place of each model, and the ball that touches it. */
const drawing = (page) => page.evaluate(() => {
  const {models} = window.hapticdView.view;
  return [...models.byIndex].map(([index, {name, triangles, mesh}]) => ({name, triangles, x: mesh.position.x, ball: models.ball(index)})).sort((a, b) => (a.name < b.name ? -1 : 1));
});
const listed = (page) => page.locator('#models h3').evaluateAll((heads) => heads.map((head) => head.title).sort());

test('models that come and leave are drawn as they are now, live and of a recording', () => browser.sandboxed(async (sandbox, open) => {
  const h5 = join(sandbox.folder, 'run.h5');
  const {daemon, url} = await sandbox.show(sceneOf(sandbox, 'one', 'box', 0), {args: ['--record', h5]});
  const ctl = (...words) => execFileSync(hapticd, ['ctl', '--name', 'test', '--wait', '30', ...words], {env: {...process.env, ...sandbox.env}, stdio: 'ignore'});
  const page = await open(url), live = [], times = [];
  const models = async (count, seen) => {
    await until(async () => (await drawing(page)).length === count && seen(await drawing(page)), kPatience, `${count} models`);
    times.push(await page.evaluate(() => window.hapticdView.now.tick.t));
    live.push(await drawing(page));
  };
  await models(1, () => true);
  ctl('add', sceneOf(sandbox, 'two', 'sphere', 0.2, ', tip_radius: 0.004'));
  await models(2, ([, two]) => two.name === 'two');
  assert.deepEqual(live[1].map(({name, x, ball}) => [name, x, ball]), [['one', 0, 0], ['two', 0.2, 0.004]], 'a model that came has its ball');
  await page.getByRole('tab', {name: 'Events'}).click();
  await page.getByText('two: was added', {exact: true}).first().waitFor();
  ctl('remove', 'one');
  ctl('add', sceneOf(sandbox, 'one', 'torus', 0)); // the same name, perhaps the same number
  await models(2, ([one]) => one.triangles !== live[0][0].triangles);
  await page.evaluate(() => { window.hapticdView.now.tick.tick = -1; window.hapticdView.now.take = () => null; }); // no newer row comes
  ctl('reload'); // the scene at the start: one box
  await until(async () => (await drawing(page)).length === 1 && (await drawing(page))[0].triangles === live[0][0].triangles, kPatience, 'a model that the rows do not know yet');
  await page.close();
  ctl('stop');
  await daemon.ended;

  const [recorded] = await sandbox.start(['view', '--file', h5]).says(/http:\S+/);
  const past = await open(recorded);
  await shown(past);
  for (const i of [2, 0, 1]) {
    await past.evaluate(async (t) => { await window.hapticdView.ask({do: 'pause'}); await window.hapticdView.ask({do: 'seek', t}); }, times[i]);
    await until(async () => JSON.stringify(await drawing(past)) === JSON.stringify(live[i]), kPatience,
      `${JSON.stringify(live[i])} instead of ${JSON.stringify(await drawing(past))}`);
    assert.deepEqual(await listed(past), live[i].map(({name}) => name));
  }
}, 'come-and-go-failed'));

test('models that came during a recording have their names', () => browser.sandboxed(async (sandbox, open) => {
  const h5 = join(sandbox.folder, 'run.h5'), run = sandbox.start(['run', scenes('torus'), '--name', 'test', '--record', h5]);
  const ctl = (...words) => execFileSync(hapticd, ['ctl', '--name', 'test', '--wait', '30', ...words], {env: {...process.env, ...sandbox.env}, stdio: 'ignore'});
  ctl('add', scenes('sphere'));
  ctl('remove', 'sphere');
  ctl('add', scenes('teapot'));
  ctl('disable', 'teapot');
  ctl('stop');
  await run.ended;
  const [url] = await sandbox.start(['view', '--file', h5]).says(/http:\S+/);
  const page = await open(url);
  await shown(page);
  const last = await page.evaluate(() => window.hapticdView.timeline.state.to);
  await page.evaluate((t) => window.hapticdView.ask({do: 'seek', t}), last);
  await page.getByRole('tab', {name: 'Events'}).click();
  for (const text of ['sphere: was added', 'sphere: was removed', 'teapot: was added', 'teapot: disabled']) await page.getByText(text, {exact: true}).first().waitFor();
  assert.equal(await page.locator('#events li', {hasText: /\bmodel \d|\{/}).count(), 0, 'numbers or descriptions in the list');
}));

test('a daemon that ends and starts again is followed', () => browser.sandboxed(async (sandbox, open) => {
  const first = sandbox.start(['run', scenes('sphere'), '--name', 'test']);
  const view = sandbox.start(['view', '--name', 'test']);
  const [url] = await view.says(/http:\S+/);
  const page = await open(url);
  await shown(page);
  await first.end('SIGINT');
  await page.locator('#status', {hasText: 'ended'}).waitFor();
  sandbox.start(['run', scenes('torus'), '--name', 'test']);
  await page.locator('#scene-name', {hasText: 'torus.yaml'}).waitFor();
  await shown(page);
  assert.equal(await page.locator('#run-tools').isVisible(), false, 'without --control there is nothing to press');
}));
