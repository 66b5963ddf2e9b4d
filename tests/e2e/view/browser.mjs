// SPDX-License-Identifier: MIT
// A real browser without a screen: Debian's Chromium, whose processor plays the graphics card.
import assert from 'node:assert/strict';
import {mkdirSync, mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {chromium} from 'playwright-core';
import {root, sandboxed} from './program.mjs';

const kFlags = ['--no-sandbox', '--disable-gpu', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync', '--autoplay-policy=no-user-gesture-required'];
export const pictures = process.env.HAPTICD_VIEW_PICTURES ?? join(root, 'build', 'view-pictures');

export class Browser {
  static async open({width = 1280, height = 800, dark = false} = {}) {
    const browser = new Browser();
    browser.profile = mkdtempSync(join(tmpdir(), 'hapticd-chromium-'));
    browser.context = await chromium.launchPersistentContext(browser.profile, {
      executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, viewport: {width, height},
      colorScheme: dark ? 'dark' : 'light', args: kFlags,
    });
    browser.context.setDefaultTimeout(120e3); // a machine that is busy is slow, not wrong
    mkdirSync(pictures, {recursive: true});
    return browser;
  }

  /** A page with what went wrong in it. `before` may prepare it before it opens. */
  async page(url, before = async () => {}) {
    const page = await this.context.newPage();
    await before(page);
    page.wrong = [];
    page.on('pageerror', (error) => page.wrong.push(error.stack));
    page.on('console', (message) => { if (message.type() === 'error') page.wrong.push(message.text()); });
    await page.goto(url);
    return page;
  }

  /** Opens a browser for one test alone. */
  static async alone(how, use) {
    const browser = await Browser.open(how);
    try {
      await browser.sandboxed(use);
    } finally {
      await browser.close();
    }
  }

  /** Runs `use(sandbox, open, browser)` with programs and files of its own. open(url, before) gives a page, in which
   * nothing may go wrong. `picture` is the name of a picture of the last page if the test fails. */
  sandboxed(use, picture = '') {
    return sandboxed(async (sandbox) => {
      const pages = [];
      const open = async (url, before) => {
        pages.push(await this.page(url, before));
        return pages.at(-1);
      };
      try {
        await use(sandbox, open, this);
        for (const page of pages) assert.deepEqual(page.wrong, [], 'nothing went wrong in the page');
      } catch (error) {
        if (picture) await pages.at(-1)?.screenshot({path: join(pictures, `${picture}.png`)}).catch(() => {});
        throw error;
      } finally {
        for (const page of pages) await page.close();
      }
    });
  }

  async close() {
    await this.context.close();
    rmSync(this.profile, {recursive: true, force: true});
  }
}

/** Waits until the scene shows its models and the newest rows. */
export async function shown(page, models = 1) {
  await page.waitForFunction((count) => {
    const v = window.hapticdView;
    return v?.view?.frames > 3 && v.view.models.byIndex.size >= count && v.now?.tick.tick > 0;
  }, models);
}

/** What the page shows, in one look right after it drew: nothing moves between its parts. */
export function look(page) {
  return page.evaluate(async () => {
    await new Promise((resolve) => requestAnimationFrame(resolve));
    const {view, now, plots} = window.hapticdView;
    const project = (x, y, z) => {  // by the matrices alone, not by the page's own functions
      const e = view.orbit.camera.matrixWorldInverse.elements, p = view.orbit.camera.projectionMatrix.elements;
      const mul = (m, v) => [0, 1, 2, 3].map((r) => m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r] * v[3]);
      const c = mul(p, mul(e, [x, y, z, 1]));
      return [(c[0] / c[3] + 1) / 2 * view.canvas.clientWidth, (1 - c[1] / c[3]) / 2 * view.canvas.clientHeight];
    };
    const place = (i) => { // of the arm, or of the proxy of a ball that touches
      const best = now.current().filter((c) => c.probe === i).reduce((a, b) => (a?.depth >= b.depth ? a : b), null);
      return best?.depth > 0 && view.models.ball(best.model) ? best.point : now.arms[i].now.position;
    };
    return {
      frames: view.frames, tick: now.tick.tick, t: now.tick.t, depth: now.tick.depth,
      tips: view.probes.map((probe, i) => {
        if (!now.arms[i].now) return null; // a seek has just taken its row away
        const m = probe.tip.matrixWorld.elements;
        return {drawn: project(m[12], m[13], m[14]), row: project(...place(i)), visible: probe.tip.visible,
          sent: now.arms[i].now.sent, arrow: probe.shaft.visible, head: probe.head.position.toArray(), at: probe.tipPlace.toArray()};
      }),
      plots: plots.all.map((plot) => ({title: plot.root.querySelector('span').textContent, points: plot.extremes.times.length,
        painted: (() => {
          const {canvas} = plot.chart.ctx, data = plot.chart.ctx.getImageData(0, 0, canvas.width, canvas.height).data;
          let some = 0;
          for (let i = 3; i < data.length; i += 4) some += data[i] > 0;
          return some;
        })(), low: plot.extremes.low.at(-1), high: plot.extremes.high.at(-1)})),
      triangles: [...view.models.byIndex.values()].map((m) => m.triangles),
      status: document.querySelector('#status span').textContent,
    };
  });
}

/** Keeps each WebSocket of the page where a test can close it. */
export const keepSockets = (page) => page.addInitScript(() => {
  window.sockets = [];
  window.WebSocket = class extends WebSocket {
    constructor(...how) { super(...how); window.sockets.push(this); }
  };
});
