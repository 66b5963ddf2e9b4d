// SPDX-License-Identifier: MIT
// The mouse and the keys as a hand: they press what is there, and the servo goes on as if nobody looked.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, before, test} from 'node:test';
import {Browser, keepSockets, pictures, shown} from './browser.mjs';
import {hapticd, scenes, until} from './program.mjs';

let browser;
before(async () => { browser = await Browser.open({width: 900, height: 620}); }); // few pixels: a processor draws them
after(async () => { await browser.close(); });

const kPatience = 120; // s: a machine that is busy is slow, not wrong

/** A page on `hapticd run SCENE --view`. `before` may prepare it before it opens. */
const guided = (scene, use, before) => browser.sandboxed(async (sandbox, open) => {
  const {daemon, url} = await sandbox.show(scenes(scene));
  const page = await open(url, before);
  await shown(page);
  await page.waitForFunction(() => window.hapticdView.fitted && !window.hapticdView.fitWhenTip); // the camera rests
  await use(page, sandbox, daemon);
}, `hand-${scene}-failed`);

/** Where the tip of an arm, and the middle of everything, are on the page. */
const places = (page, arm = 0) => page.evaluate((index) => {
  const {view} = window.hapticdView, box = view.canvas.getBoundingClientRect();
  const at = (place) => { const p = view.project(place); return {x: p.x + box.left, y: p.y + box.top}; };
  const middle = view.models.box();
  return {tip: at(view.probes[index].tipPlace), middle: at(middle.min.clone().add(middle.max).multiplyScalar(0.5))};
}, arm);
/** [N] Where the machine was too busy for a tick, the servo has taken the force away until somebody clears: so do we. */
const force = (page, arm = 0) => page.evaluate((i) => {
  const kLate = 6, kStuck = 9, {arms} = window.hapticdView.now;
  if (arms.some(({now}) => now.fault === kLate || now.fault === kStuck)) document.getElementById('clear').click();
  return Math.hypot(...arms[i].now.sent);
}, arm);

/** Drags the tip to the middle of the scene, until it is pressed with that force [N]. */
async function press(page, newtons, arm = 0) {
  const {tip, middle} = await places(page, arm);
  await page.mouse.move(tip.x, tip.y);
  await page.mouse.down();
  for (let part = 0.05; part < 1; part += 0.05) {
    await page.mouse.move(tip.x + part * (middle.x - tip.x), tip.y + part * (middle.y - tip.y));
    await new Promise((resolve) => setTimeout(resolve, 60));
    if ((await force(page, arm)) >= newtons) return;
  }
  await until(async () => (await force(page, arm)) >= newtons, kPatience, `${newtons} N`);
}

/** The rows of a stream as objects, out of the black box that the daemon dumps. */
function rowsOf(sandbox, stream, columns) {
  const folder = mkdtempSync(join(tmpdir(), 'hapticd-rows-'));
  try {
    const env = {...process.env, ...sandbox.env};
    const said = execFileSync(hapticd, ['ctl', '--name', 'test', 'dump'], {env, encoding: 'utf8'});
    const [file] = said.match(/\/[^"\s]+\.h5/);
    execFileSync(hapticd, ['export', file, '--csv', join(folder, 'rows.csv'), '--stream', stream]);
    const [head, ...rows] = readFileSync(join(folder, 'rows.csv'), 'utf8').trimEnd().split('\n').map((line) => line.split(','));
    return rows.map((row) => Object.fromEntries(columns.map((name) => [name, Number(row[head.indexOf(name)])])));
  } finally {
    rmSync(folder, {recursive: true, force: true});
  }
}

test('the mouse presses the teapot, bounded as every leader is, and no row is missing', async () => {
  await guided('teapot', async (page, sandbox) => {
    await page.keyboard.press('3'); // from the right: the hand comes from the front
    await press(page, 1.0);
    await page.screenshot({path: join(pictures, 'mouse-press.png')});
    const ticks = rowsOf(sandbox, 'ticks', ['tick', 'depth']);
    assert.ok(ticks.every((row, i) => i === 0 || row.tick === ticks[i - 1].tick + 1), 'a row of every tick');
    const leads = rowsOf(sandbox, 'leads', ['tick', 'x', 'y', 'z']), events = rowsOf(sandbox, 'events', ['tick', 'kind']);
    assert.ok(leads.length > 3, 'the wishes of the mouse are recorded');
    const touch = events.filter((e) => e.kind === 2 && e.tick > leads[0].tick)[0];
    assert.ok(touch, 'the touch is an event');
    const {missed_ticks: missed, seconds} = await page.evaluate(() => window.hapticdView.status);
    console.log(`missed ticks with a page that presses: ${missed} in ${seconds} s`); // how many there are without one is the machine's

    // the wish pulled out again: it is not felt, wherever the tip was
    const {tip, middle} = await places(page);
    await page.mouse.move(tip.x + 3 * (tip.x - middle.x), tip.y);
    await until(async () => (await force(page)) === 0, kPatience, 'no force');
    await page.mouse.up();
  });
});

test('what a new user does presses: the tip is dragged onto the teapot, in the view that the page begins with', async () => {
  await guided('teapot', async (page) => {
    await press(page, 0.3);
    await page.screenshot({path: join(pictures, 'first-press.png')});
    await page.mouse.up();
  });
});

test('Space holds wherever the focus is, and presses no button', async () => {
  await guided('teapot', async (page) => {
    const held = () => page.evaluate(() => window.hapticdView.held === true);
    for (const button of ['[data-view=front]', '#fit', '#stop', '#models input[type=number]']) {
      await page.locator(button).first().focus();
      await page.keyboard.press('Space');
      await until(held, kPatience, `a hold with the focus on ${button}`);
      await page.keyboard.press('Space');
      await until(async () => !(await held()), kPatience, 'no hold any more');
    }
    assert.equal(await page.locator('#stop').textContent(), 'Stop', 'the run was not asked to end');
  });
});

test('Stop asks first, and takes the question back', async () => {
  await guided('sphere', async (page) => {
    await page.evaluate(() => {
      const view = window.hapticdView;
      view.asked = [];
      view.ask = (request) => { view.asked.push(request.do); return Promise.resolve({ok: true}); };
    });
    const asked = () => page.evaluate(() => window.hapticdView.asked), words = () => page.locator('#stop').textContent();
    await page.locator('#stop').click();
    assert.equal(await words(), 'End the run?');
    await until(async () => (await words()) === 'Stop', kPatience, 'the question is taken back');
    assert.deepEqual(await asked(), []);
    await page.locator('#stop').dblclick();
    assert.deepEqual(await asked(), ['stop']);
    assert.equal(await words(), 'Stop');
  });
});

test('a list of models that comes before the scene can be drawn is shown', async () => {
  await guided('teapot', async (page) => {
    await page.locator('#models article').waitFor({timeout: 1000 * kPatience});
    assert.ok(await page.locator('#models input[type=number]').count() > 0, 'its parameters may be changed');
  }, (page) => page.addInitScript(() => {
    const draw = window.requestAnimationFrame.bind(window); // as where a processor draws and is busy
    let late = 2000;
    window.requestAnimationFrame = (use) => { const wait = late; late = 0; return wait > 0 ? setTimeout(() => draw(use), wait) : draw(use); };
  }));
});

test('one jump of the mouse into the teapot is felt within 100 ms of the wish', async () => {
  await guided('teapot', async (page, sandbox) => {
    await page.keyboard.press('3');
    const {tip, middle} = await places(page);
    await page.mouse.move(tip.x, tip.y);
    await page.mouse.down();
    // to a place 2 mm before the surface, and from there 7 mm deeper than it at once
    const {depth: before, pixels} = await page.evaluate(() => {
      const {view, now} = window.hapticdView;
      return {depth: now.tick.depth, pixels: 1 / view.orbit.metresPerPixel(view.probes[0].tipPlace, view.canvas.clientHeight)};
    });
    assert.ok(before < -0.004, 'it begins outside');
    const way = Math.sign(middle.x - tip.x);
    let x = tip.x;
    await until(async () => {
      const gap = (await page.evaluate(() => window.hapticdView.now.tick.depth)) + 0.002;
      if (Math.abs(gap) < 0.0007) return true;
      x -= way * Math.max(-3, Math.min(3, 0.3 * gap * pixels));
      await page.mouse.move(x, tip.y);
      await new Promise((resolve) => setTimeout(resolve, 60));
      return false;
    }, kPatience, 'a tip just before the surface');
    await new Promise((resolve) => setTimeout(resolve, 300)); // it rests
    const asked = await page.evaluate(() => window.hapticdView.now.tick.tick);
    await page.mouse.move(x + way * 0.009 * pixels, tip.y);
    await until(async () => (await force(page)) > 0.1, kPatience, 'a force');
    // the wish is told again and again: the jump is where it is another
    const leads = rowsOf(sandbox, 'leads', ['tick', 'x', 'y', 'z']), far = (a, b) => Math.hypot(a.x - b.x, a.y - b.y, a.z - b.z);
    const lead = leads.find((row, i) => row.tick > asked && i > 0 && far(row, leads[i - 1]) > 0.004), touch = rowsOf(sandbox, 'ticks', ['tick', 'depth']).find((row) => row.tick > asked && row.depth > 0);
    assert.ok(touch.tick - lead.tick <= 100, `touched ${touch.tick - lead.tick} ms after the wish`);
    await page.mouse.up();
  });
});

test('the keys alone press the teapot', async () => {
  await guided('teapot', async (page) => {
    for (let i = 0; i < 40 && (await page.evaluate(() => document.activeElement.id)) !== 'canvas'; ++i) await page.keyboard.press('Tab');
    await page.keyboard.press('1'); // from the front: Page Up moves the hand away from the viewer, into the teapot
    for (let i = 0; i < 60 && (await force(page)) < 0.5; ++i) {
      await page.keyboard.press('PageUp');
      await new Promise((resolve) => setTimeout(resolve, 30));
    }
    await until(async () => (await force(page)) > 0.5, kPatience, '0.5 N');
    await page.keyboard.press('Space');
    await until(async () => (await force(page)) === 0, kPatience, 'no force while it is held');
    await page.keyboard.press('Space');
    await until(async () => (await force(page)) > 0.3, kPatience, 'the force again');
  });
});

/** Whether each arm is marked as the one that the keys move. */
const keyed = (page) => page.locator('.of-arm').evaluateAll((all) => all.map((one) => Boolean(one.querySelector('kbd')?.getClientRects().length)));

test('each of two hands is led by itself, by the mouse and by the keys', async () => {
  await guided('two-arms', async (page) => {
    const marked = (arms, what) => until(async () => String(await keyed(page)) === String(arms), kPatience, what);
    const colours = () => page.evaluate(() => window.hapticdView.view.probes.map(({tip}) => tip.material.color.getHex()));
    await marked([true, false], 'a mark of the arm that the keys move');
    const first = await colours();
    assert.notEqual(first[0], first[1], 'its tip has a colour of its own');
    await page.keyboard.press('3');
    await press(page, 0.5, 1);
    assert.ok((await force(page, 0)) < 0.3, 'the other one rests');
    await page.screenshot({path: join(pictures, 'two-hands.png')});
    await page.mouse.up();
    await marked([false, true], 'the mark at the arm that the mouse has led');
    await page.locator('#canvas').focus();
    await page.keyboard.press('n');
    await marked([true, false], 'the mark at the next arm');
    assert.deepEqual(await colours(), first, 'and the colours with it');
    const before = await page.evaluate(() => window.hapticdView.now.arms[0].now.position[1]);
    for (let i = 0; i < 10; ++i) await page.keyboard.press('ArrowUp');
    await until(async () => (await page.evaluate(() => window.hapticdView.now.arms[0].now.position[1])) > before + 0.006, kPatience, 'the first arm 10 mm up');
    assert.deepEqual(await keyed(page), [true, false], 'the mark lasts');
  });
});

test('the speed beside the name of an arm is that of this arm', async () => {
  await guided('two-arms', async (page) => {
    const speeds = await page.evaluate(() => { // rows in which only the second arm moves, between two frames
      const {now, readouts} = window.hapticdView, rest = now.arms.map((arm) => arm.now);
      for (let i = 0; i < 4; ++i) readouts.update(rest.map((row, k) => ({...row, position: [k === 1 ? 0.001 * i : 0, 0, 0]})), now.tick.t + 0.1 * i);
      return [...document.querySelectorAll('.of-arm')].map((one) => [one.querySelector('dt').title, Number(one.querySelector('[title="Speed of the tip"]').value)]);
    });
    const [first, second] = await page.evaluate(() => window.hapticdView.now.arms.map(({name}) => name));
    assert.deepEqual(speeds, [[first, 0], [second, 10]]); // 1 mm in 0.1 s
  });
});

test('a second page may not take a hand that is led, and gets it when the first has gone', async () => {
  await guided('sphere', async (page, sandbox, daemon) => {
    const [url] = await daemon.says(/http:\S+/);
    const other = await browser.page(url);
    await shown(other);
    await page.locator('#canvas').focus();
    await page.keyboard.press('ArrowUp');
    await until(() => page.evaluate(() => window.hapticdView.hand.leads), kPatience, 'the lead');
    await other.bringToFront();
    await other.locator('#canvas').focus();
    await other.keyboard.press('ArrowUp');
    await other.locator('#notice').waitFor();
    assert.match(await other.locator('#notice').textContent(), /lead|led/);
    await page.goto('about:blank');
    await until(async () => {
      await other.keyboard.press('ArrowUp');
      await new Promise((resolve) => setTimeout(resolve, 300));
      return other.evaluate(() => window.hapticdView.hand.leads);
    }, kPatience, 'the lead of the page that has gone');
    assert.deepEqual(other.wrong, []);
    await other.close();
  });
});

test('a connection that is lost comes back: what the pointer holds is led on, a hand that was let go waits', async () => {
  await guided('teapot', async (page) => {
    await page.keyboard.press('3');
    const drop = () => page.evaluate(() => window.sockets.at(-1).close());
    const back = (count) => until(() => page.evaluate((n) => window.sockets.length === n && window.sockets.at(-1).readyState === 1, count), kPatience, 'the connection');
    const leads = () => page.evaluate(() => window.hapticdView.hand.leads);
    const radius = () => page.evaluate(() => window.hapticdView.view.orbit.spherical.radius);
    const {tip} = await places(page);
    await page.mouse.move(tip.x, tip.y);
    await page.mouse.down();
    await page.mouse.move(tip.x, tip.y - 20);
    await until(leads, kPatience, 'the lead');
    const before = await radius();
    await drop();
    await page.locator('#status', {hasText: 'lost'}).waitFor();
    await page.mouse.move(tip.x, tip.y - 24); // without a connection
    await back(2);
    await until(leads, kPatience, 'the lead again');
    assert.equal(await radius(), before, 'the camera stays');

    await page.mouse.up();
    await drop();
    await page.locator('#hint', {hasText: 'drag the tip again'}).waitFor();
    await back(3);
    await shown(page);
    assert.equal(await leads(), false, 'nothing is led by itself');
    const {tip: again} = await places(page);
    await page.mouse.move(again.x, again.y);
    await page.mouse.down();
    await until(leads, kPatience, 'the lead of who dragged again');
    await until(() => page.locator('#hint').isHidden(), kPatience, 'no advice any more');
    await page.mouse.up();
  }, keepSockets);
});

test('a lead that comes after its hand was left is given back, and does not move the other hand', async () => {
  await guided('two-arms', async (page) => {
    await page.locator('#canvas').focus();
    await page.evaluate(() => {
      const {connection} = window.hapticdView, ask = connection.ask.bind(connection);
      window.givenBack = [];
      connection.ask = async (request) => {
        const answer = await ask(request);
        if (request.do === 'lead') await new Promise((resolve) => setTimeout(resolve, 500)); // a slow daemon
        if (request.do === 'unlead') window.givenBack.push(answer.ok);
        return answer;
      };
    });
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('n');
    await until(() => page.evaluate(() => window.givenBack.includes(true)), kPatience, 'the lead given back');
    assert.equal(await page.evaluate(() => window.hapticdView.hand.leads), false, 'the other hand is not led');
  });
});
