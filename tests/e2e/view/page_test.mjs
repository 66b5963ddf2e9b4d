// SPDX-License-Identifier: MIT
// Every scene that ships, looked at in a real browser; the form, the slider, narrow windows and the keyboard.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readdirSync, readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, look, pictures, shown} from './browser.mjs';
import {hapticd, root, scenes, until} from './program.mjs';

const kHardware = ['sarcos']; // scenes whose device is no simulated one
const all = readdirSync(join(root, 'config', 'scenes'), {recursive: true}).filter((f) => f.endsWith('.yaml')).map((f) => f.replace('.yaml', '')).filter((s) => !kHardware.includes(s));
const kPatience = 120; // s: a machine that is busy is slow, not wrong
let browser;
before(async () => { browser = await Browser.open({width: 1000, height: 660}); }); // few pixels: a processor draws them
after(async () => { await browser.close(); });

/** A page on a daemon whose hand follows its script. */
const scripted = (scene, use, models) => browser.sandboxed(async (sandbox, open) => {
  sandbox.start(['run', scenes(scene), '--name', 'test']);
  const view = sandbox.start(['view', '--name', 'test', '--control']);
  const [url] = await view.says(/http:\S+/);
  const page = await open(url);
  await shown(page, models);
  await use(page, sandbox);
}, `${scene}-failed`);

for (const scene of all) {
  test(`${scene}: the tip is where its row says, the plots are drawn, no error`, async () => {
    const names = readFileSync(scenes(scene), 'utf8').match(/^ *- (\{)?name:/gm)?.length ?? 1;
    await scripted(scene, async (page) => {
      await until(async () => (await look(page)).plots.every((p) => p.points > 20), kPatience, 'half a second of plots');
      const first = await look(page);
      await until(async () => (await look(page)).frames > first.frames + 5, kPatience, 'five more frames');
      const seen = await look(page);
      assert.ok(seen.tick > first.tick, 'rows go on');
      for (const tip of seen.tips) {
        assert.ok(tip.visible, 'the tip is drawn');
        assert.ok(Math.hypot(tip.drawn[0] - tip.row[0], tip.drawn[1] - tip.row[1]) <= 2, `tip at ${tip.drawn}, row at ${tip.row}`);
        const size = Math.hypot(...tip.sent);
        if (size > 0.1) {
          assert.ok(tip.arrow, 'a force has an arrow');
          const along = tip.head.map((h, i) => h - tip.at[i]), dot = along.reduce((sum, a, i) => sum + a * tip.sent[i], 0);
          assert.ok(dot > 0.98 * size * Math.hypot(...along), 'which points where it acts');
        }
      }
      for (const plot of seen.plots) assert.ok(plot.painted > 300, `${plot.title} has ${plot.painted} painted pixels`);
      assert.ok(seen.triangles.every((t) => t >= 2), 'every model has triangles');
      await page.screenshot({path: join(pictures, `${scene}.png`)});
    }, names);
  });
}

/** An OBJ file of a ball [m], for a part with as many triangles as a CAD model has. */
function ball(radius, rings) {
  const lines = [], sides = 2 * rings, at = (ring, side) => ring * sides + (side % sides) + 1;
  for (let i = 0; i <= rings; ++i)
    for (let k = 0; k < sides; ++k) {
      const polar = 0.02 + i / rings * (Math.PI - 0.04), turn = k / sides * 2 * Math.PI;
      lines.push(`v ${radius * Math.sin(polar) * Math.cos(turn)} ${radius * Math.cos(polar)} ${radius * Math.sin(polar) * Math.sin(turn)}`);
    }
  for (let i = 0; i < rings; ++i)
    for (let k = 0; k < sides; ++k) lines.push(`f ${at(i, k)} ${at(i, k + 1)} ${at(i + 1, k + 1)}`, `f ${at(i, k)} ${at(i + 1, k + 1)} ${at(i + 1, k)}`);
  for (const ring of [0, rings]) {
    const caps = Array.from({length: sides}, (_, k) => at(ring, k));
    for (let k = 1; k + 1 < sides; ++k) lines.push(ring === 0 ? `f ${caps[0]} ${caps[k + 1]} ${caps[k]}` : `f ${caps[0]} ${caps[k]} ${caps[k + 1]}`);
  }
  return `${lines.join('\n')}\n`;
}

test('a part file of 20 000 triangles is drawn with its normals', () => browser.sandboxed(async (sandbox, open) => {
  const file = (name) => join(sandbox.folder, name);
  writeFileSync(file('ball.obj'), ball(0.04, 70));
  execFileSync(hapticd, ['import', file('ball.obj'), '-o', file('ball.hpart'), '--smooth-angle', '30'], {stdio: 'ignore'});
  writeFileSync(file('ball.yaml'), `hapticd: 1\nservo: {rate: 1000}\ndevice: ${join(root, 'config', 'devices', 'simulated-premium15.yaml')}\n` +
    'hand: {radius: 0.046}\nmodels:\n  - {name: ball, plugin: nurbs_rigid, parameters: {geometry: ball.hpart, stiffness: 600}}\n');
  sandbox.start(['run', file('ball.yaml'), '--name', 'test']);
  const [url] = await sandbox.start(['view', '--name', 'test']).says(/http:\S+/);
  const page = await open(url);
  await shown(page);
  const drawn = await page.evaluate(() => {
    const model = window.hapticdView.view.models.byIndex.get(0), normal = model.mesh.geometry.getAttribute('normal'), place = model.mesh.geometry.getAttribute('position');
    let worst = 1;
    for (let i = 0; i < normal.count; ++i) {
      const n = [normal.getX(i), normal.getY(i), normal.getZ(i)], p = [place.getX(i), place.getY(i), place.getZ(i)];
      if (Math.abs(p[1]) < 0.039) worst = Math.min(worst, n.reduce((sum, v, k) => sum + v * p[k], 0) / Math.hypot(...p) / Math.hypot(...n));
    }
    return {triangles: model.triangles, worst};
  });
  assert.ok(drawn.triangles > 19000, `${drawn.triangles} triangles`);
  assert.ok(drawn.worst > 0.99, `normals point out of the ball within ${drawn.worst}`);
  await page.screenshot({path: join(pictures, 'part.png')});
}));

test('the parts of an assembly can be told apart, and an arm at the end of its range says so', () => browser.sandboxed(async (sandbox, open) => {
  const file = join(sandbox.folder, 'far.yaml'), sphere = join(root, 'config', 'models', 'sphere.yaml');
  // The hand pulls the tip toward the base of the arm, to where joint 3 ends.
  writeFileSync(file, `hapticd: 1\ndevice: ${join(root, 'config', 'devices', 'simulated-premium15.yaml')}\n` +
    'hand: {script: hold, center: [0, 0.09, -0.14], radius: 0.011, approach: 0.06}\nmodels:\n' +
    ['one', 'two'].map((name, i) => `  - {name: ${name}, plugin: nurbs_rigid, pose: {position: [${0.2 * i}, -0.2, 0]}, parameters: {geometry: ${sphere}}}\n`).join(''));
  sandbox.start(['run', file, '--name', 'test']);
  const [url] = await sandbox.start(['view', '--name', 'test']).says(/http:\S+/);
  const page = await open(url);
  await shown(page, 2);
  const colors = await page.evaluate(() => [0, 1].map((i) => window.hapticdView.view.models.byIndex.get(i).mesh.material.color.getHexString()));
  assert.notEqual(colors[0], colors[1]);
  const said = () => page.locator('#foot').textContent();
  await until(async () => /joint 3 is at the end of the range/.test(await said()), kPatience, 'a word about joint 3');
}));

test('beside a model without triangles stands why it is not drawn, for as long as it is there', () => browser.sandboxed(async (sandbox, open) => {
  const file = (name) => join(sandbox.folder, name);
  execFileSync('gcc', ['-shared', '-fPIC', '-DVERSIONED_NAME=c_ball', '-I', join(root, 'driver/include/hapticd'),
    join(root, 'tests/abi/plugins/versioned_sphere.c'), '-o', file('c_ball.so'), '-lm']);
  writeFileSync(file('unseen.yaml'), `hapticd: 1\ndevice: ${join(root, 'config', 'devices', 'simulated-premium15.yaml')}\n` +
    'models:\n  - {name: unseen, plugin: c_ball}\n  - {name: seen, plugin: template, pose: {position: [0.2, 0, 0]}}\n');
  sandbox.start(['--plugin-path', sandbox.folder, 'run', file('unseen.yaml'), '--name', 'test', '--allow-non-rt']);
  const [url] = await sandbox.start(['view', '--name', 'test', '--control']).says(/http:\S+/);
  const page = await open(url);
  const told = (name) => page.evaluate((model) => {
    const words = document.querySelector(`[data-model="${model}"] .drawing`);
    return words ? {hidden: words.hidden, text: words.textContent} : null;
  }, name);
  await until(async () => (await told('unseen'))?.hidden === false, kPatience, 'a word beside the model');
  assert.match((await told('unseen')).text, /hsp\.geometry\/1.*can still be felt/);
  await new Promise((resolve) => setTimeout(resolve, 7000)); // a notice is gone after 6 s
  await page.evaluate(() => document.querySelector('[data-model="seen"] header button').click()); // the list is made anew
  await until(() => page.evaluate(() => document.querySelector('[data-model="seen"] header button').textContent === 'Enable'), kPatience, 'a new list');
  assert.equal((await told('unseen')).hidden, false);
  assert.equal((await told('seen')).hidden, true, 'what is drawn has no such word');
  await page.screenshot({path: join(pictures, 'unseen.png')});
}));

/** [m] Of compliance control the rows have the virtual mass; the arm follows it, by 0.9 mm at most in 4 s of that scene. */
const kBehind = {compliance: 5e-3};

for (const scene of ['teapot', 'compliance', 'two-arms']) {
  test(`${scene}: the arms are drawn from their joints, and end at the tip`, async () => {
    await scripted(scene, async (page) => {
      await until(() => page.evaluate(() => window.hapticdView.view.probes.every((p) => p.links.some((l) => l.bar.visible))), kPatience, 'links');
      const far = await page.evaluate(() => {
        const {armModels, now} = window.hapticdView;
        return armModels.map((arm, i) => {
          const {joints, position} = now.arms[i].now, links = arm.links(joints, position);
          return Math.min(...links.map(({to}) => Math.hypot(to.x - position[0], to.y - position[1], to.z - position[2])));
        });
      });
      for (const distance of far) assert.ok(distance < (kBehind[scene] ?? 1e-9), `a link ends ${distance} m from the tip`);
      const spaces = await page.evaluate(() => window.hapticdView.armModels.map((arm) => arm.workspace()));
      for (const box of spaces) assert.ok(box && box.max.x - box.min.x > 0.1, 'what it can reach is a box');
    });
  });
}

/** Joints [rad] and tips [m] of the Falcon's delta, as devices/support/kinematics gives them. */
const kDeltaTips = [
  {joints: [0.5, 0.5, 0.5], tip: [0, 0, 0.110337842]},
  {joints: [0.2, 0.7, 0.4], tip: [-0.004936758, 0.017036968, 0.102964281]},
  {joints: [0.9, 0.3, 0.6], tip: [0.002129390, -0.024981554, 0.114477546]},
  {joints: [-0.1, 0.4, 0.8], tip: [0.024740025, 0.019855247, 0.093639604]},
];

test('a delta is drawn from its joints and its row: its rods keep their length and end at the tip', async () => {
  await scripted('teapot', async (page) => {
    const drawn = await page.evaluate((rows) => {
      const {armModels, view} = window.hapticdView, Arm = armModels[0].constructor;
      const parameters = [{id: 'arm.kind', number: 1}], falcon = new Arm({module: 'usb_bulk', parameters, mount: {position: [0, 0, -0.06], orientation: [1, 0, 0, 0]}}, {joint_count: 3});
      const away = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
      return rows.map(({joints, tip: [x, y, z]}) => {
        const links = falcon.links(joints, [x, y, z - 0.06]);
        view.probes[0].setLinks(links);
        return Array.from({length: 3}, (_, i) => {
          const [, arm, rod, platform] = links.slice(4 * i, 4 * i + 4), phi = [105, -15, -135][i] * Math.PI / 180;
          const aside = (rod.to.x - rod.from.x) * -Math.sin(phi) + (rod.to.y - rod.from.y) * Math.cos(phi);
          return {arm: away(arm.from, arm.to), rod: Math.hypot(Math.sqrt(away(rod.from, rod.to) ** 2 - aside ** 2) - 0.0225, aside), end: away(platform.to, {x, y, z: z - 0.06})};
        });
      });
    }, kDeltaTips);
    for (const arms of drawn)
      for (const {arm, rod, end} of arms) {
        assert.ok(Math.abs(arm - 0.06) < 1e-9, `a driven arm of ${arm} m`);
        assert.ok(Math.abs(rod - 0.1025) < 1e-7, `a parallelogram of ${rod} m`); // between two hinges of 11.25 mm
        assert.ok(end < 1e-9, 'the platform is at the tip');
      }
  });
});

test('a soft body deforms live', async () => {
  await scripted('soft-leaf', async (page) => {
    const places = () => page.evaluate(() => [...window.hapticdView.view.models.byIndex.get(0).live.getAttribute('position').array]);
    const first = await places();
    await until(async () => (await places()).some((x, i) => Math.abs(x - first[i]) > 1e-3), kPatience, 'a vertex a millimetre from where it was');
    const wrong = await page.evaluate(() => window.hapticdView.view.models.byIndex.get(0).mesh.geometry.getAttribute('normal').array.some(Number.isNaN));
    assert.equal(wrong, false, 'every normal is one');
  });
});

test('what moves is drawn where its rows say, also for a page that comes later', async () => {
  await scripted('moving-box', async (page) => {
    const far = () => page.evaluate(() => {
      const {view, now} = window.hapticdView, mesh = view.models.byIndex.get(0).mesh, pose = now.poses.get(0);
      return pose ? Math.hypot(...pose.position.map((p, i) => p - mesh.position.getComponent(i))) : NaN;
    });
    await until(async () => !Number.isNaN(await far()), kPatience, 'a pose');
    for (let i = 0; i < 5; ++i) assert.ok((await far()) < 0.02, 'the mesh follows its rows');
  });
});

test('a parameter that a hand may feel suddenly asks for consent, and then the force follows', async () => {
  await scripted('sphere', async (page) => {
    const field = page.locator('[data-parameter="stiffness"]');
    const force = () => page.evaluate(() => Math.hypot(...window.hapticdView.now.arms[0].now.sent));
    await until(async () => (await force()) > 0.3, kPatience, 'a contact');
    await field.locator('input[type=number]').fill('1e9');
    await field.locator('input[type=number]').press('Enter');
    assert.match(await field.locator('.wrong').textContent(), /expected/, 'a value out of range is refused before anybody is asked');
    assert.equal(await page.locator('#consent').evaluate((d) => d.open), false);

    await field.locator('input[type=number]').fill('100');
    await field.locator('input[type=number]').press('Enter');
    await page.locator('#consent button[value=no]').click();
    const orders = () => page.evaluate(() => window.hapticdView.now.table('orders').end);
    assert.equal(await orders(), 0, 'without consent nothing is asked of the daemon');

    const before = await force();
    await field.locator('input[type=number]').fill('100');
    await field.locator('input[type=number]').press('Enter');
    await page.locator('#consent button[value=yes]').click();
    await until(async () => (await orders()) > 0, kPatience, 'the order in the rows');
    await until(async () => (await force()) < 0.5 * before, kPatience, `a force below half of ${before} N`);
    await page.getByRole('tab', {name: 'Events'}).click();
    await page.getByText('parameter set to 100').waitFor();
  });
});

test('space holds and clears, and the events tell', async () => {
  await scripted('sphere', async (page) => {
    const force = () => page.evaluate(() => Math.hypot(...window.hapticdView.now.arms[0].now.sent));
    await until(async () => (await force()) > 0.3, kPatience, 'a contact');
    await page.locator('#canvas').focus();
    await page.keyboard.press('Space');
    await until(async () => (await force()) === 0, kPatience, 'no force');
    await page.locator('#hold b', {hasText: 'Clear'}).waitFor();
    assert.equal(await page.locator('#run-tools button:visible', {hasText: 'Clear'}).count(), 1, 'one button clears the hold');
    await page.keyboard.press('Space');
    await until(async () => (await force()) > 0.1, kPatience, 'the force again');
    await page.getByRole('tab', {name: 'Events'}).click();
    assert.ok((await page.locator('#events li').count()) >= 2);
  });
});

test('a model is added and removed by file', async () => {
  await scripted('teapot', async (page) => {
    await page.locator('#add-file').fill(scenes('torus'));
    await page.getByRole('button', {name: 'Add', exact: true}).click();
    await shown(page, 2);
    await page.getByRole('button', {name: 'Remove torus'}).click();
    await page.waitForFunction(() => window.hapticdView.view.models.byIndex.size === 1);
    await page.locator('#add-file').fill('/nowhere.yaml');
    await page.getByRole('button', {name: 'Add', exact: true}).click();
    await page.locator('#notice', {hasText: 'nowhere.yaml'}).waitFor();
  });
});

for (const dark of [false, true]) {
  test(`a window of 360 pixels, ${dark ? 'dark' : 'light'}: nothing sticks out, everything can be reached`, () => Browser.alone({width: 360, height: 740, dark}, async (sandbox, open) => {
    const {url} = await sandbox.show(scenes('teapot'));
    const page = await open(url);
    await shown(page);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 360), 'no sideways scrolling');
    for (const name of ['Hold', 'Fit', 'Models', 'Events', 'Show']) {
      const box = await page.locator(`button:has-text("${name}")`).first().boundingBox();
      assert.ok(box && box.x >= 0 && box.x + box.width <= 360, `${name} is within the window: ${JSON.stringify(box)}`);
    }
    const reached = new Set();
    for (let i = 0; i < 40; ++i) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.textContent.trim().slice(0, 12)));
    }
    for (const id of ['hold', 'theme', 'canvas', 'fit', 'tab-models']) assert.ok(reached.has(id), `Tab reaches ${id}: ${[...reached]}`);
    await page.screenshot({path: join(pictures, `narrow-${dark ? 'dark' : 'light'}.png`)});
  }));
}
