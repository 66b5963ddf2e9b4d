// SPDX-License-Identifier: MIT
// What looking costs: the servo nothing, the view little, the browser what it must. Figures are printed; what is asserted
// are counts, sizes and ratios within a run, for machines are shared.
import assert from 'node:assert/strict';
import {execFileSync, spawnSync} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import {WebSocket} from 'ws';
import {Browser, shown} from './browser.mjs';
import {hapticd, sandboxed, scenes} from './program.mjs';

const kPages = 8;
const pause = (seconds) => new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
const median = (list) => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

/** Pages without a browser: they read what comes. */
async function readers(url, count) {
  const sockets = Array.from({length: count}, () => {
    const socket = new WebSocket(url.replace('http', 'ws'), ['hapticd.1']);
    socket.bytes = 0;
    socket.on('message', (data) => { socket.bytes += data.length; });
    socket.on('error', () => {});
    return socket;
  });
  await Promise.all(sockets.map((s) => new Promise((resolve, reject) => { s.on('open', resolve); s.on('error', reject); })));
  return sockets;
}

/** [s] of the processor that a process has had. */
function cpuOf(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ');
  return (Number(fields[11]) + Number(fields[12])) / Number(execFileSync('getconf', ['CLK_TCK'], {encoding: 'utf8'}));
}

/** [MB] of its own: the black box that it maps is the daemon's. */
function memoryOf(pid) {
  const status = readFileSync(`/proc/${pid}/status`, 'utf8');
  return ['RssAnon', 'RssFile'].reduce((sum, name) => sum + Number(status.match(new RegExp(`${name}:\\s+(\\d+)`))[1]), 0) / 1024;
}

test('eight pages cost the view at most 4 % of a core and 20 MB', () => sandboxed(async (sandbox) => {
  sandbox.start(['run', scenes('teapot'), '--name', 'test']);
  const view = sandbox.start(['view', '--name', 'test']), [url] = await view.says(/http:\S+/);
  const sockets = await readers(url, kPages);
  await pause(2);
  const shares = [];
  for (let i = 0; i < 3; ++i) {
    const before = cpuOf(view.child.pid), begun = performance.now();
    await pause(4);
    shares.push((cpuOf(view.child.pid) - before) / (performance.now() - begun) * 1e3);
  }
  const memory = memoryOf(view.child.pid);
  console.log(`view process, ${kPages} pages: ${shares.map((s) => `${(100 * s).toFixed(1)} %`).join(', ')} of a core, ${memory.toFixed(1)} MB`);
  assert.ok(sockets.every((s) => s.bytes > 1e6), 'each page gets its rows');
  assert.ok(Math.min(...shares) <= 0.04, `${shares} of a core`);
  assert.ok(memory <= 20, `${memory} MB`);
}));

/** So many views that wait for the run, and the socket of a page of each. */
async function readAlong(sandbox, views) {
  const watching = Array.from({length: views}, () => sandbox.start(['view', '--name', 'test']));
  return (await Promise.all(watching.map(async (view) => readers((await view.says(/http:\S+/))[0], 1)))).flat();
}

/** Instructions of the servo's loop, over ticks in virtual time, with so many views that read along. */
const instructions = (views, seconds) => sandboxed(async (sandbox) => {
  const out = join(sandbox.folder, 'callgrind');
  const sockets = await readAlong(sandbox, views);
  const run = spawnRun(sandbox, out, seconds);
  assert.equal(await run.ended, 0, run.output);
  assert.ok(sockets.every((s) => s.bytes > 1e5), 'every view read along');
  return Number(readFileSync(out, 'utf8').match(/^totals: (\d+)/m)?.[1] ?? 0);
});

function spawnRun(sandbox, out, seconds) {
  return sandbox.start(['--tool=callgrind', '--toggle-collect=hapticd::servo::Loop::run()', `--callgrind-out-file=${out}`, hapticd, 'run', scenes('teapot'),
    '--virtual-time', '--for', String(seconds), '--name', 'test'], 'valgrind');
}

test('the servo runs the same instructions with no view and with eight', async () => {
  const seconds = 1, alone = await instructions(0, seconds), watched = await instructions(kPages, seconds);
  console.log(`servo, ${seconds} s in virtual time: ${alone} instructions without a view, ${watched} with ${kPages}, ${(100 * (watched / alone - 1)).toFixed(4)} % more`);
  assert.ok(alone > 1e6, 'the loop was counted');
  assert.ok(Math.abs(watched / alone - 1) <= 0.01);
});

/** System calls of the servo's thread between its first tick and its last, {name: count}, with so many views that read along. */
const callsOfServo = (views, seconds) => sandboxed(async (sandbox) => {
  const out = join(sandbox.folder, 'strace');
  const sockets = await readAlong(sandbox, views);
  const run = sandbox.start(['-f', '-o', out, hapticd, 'run', scenes('teapot'), '--for', String(seconds), '--name', 'test'], 'strace');
  assert.equal(await run.ended, 0, run.output);
  assert.ok(sockets.every((s) => s.bytes > 1e4), 'every view read along');
  const calls = readFileSync(out, 'utf8').split('\n').map((line) => line.match(/^(\d+) +(\w+)\(/)).filter(Boolean);
  const servo = calls.find((call) => /^\d+ +sched_setscheduler\(\d+, SCHED_FIFO, \[80\]/.test(call.input))?.[1];
  const own = calls.filter((call) => call[1] === servo).map((call) => call[2]), counts = {};
  for (const name of own.slice(own.indexOf('clock_nanosleep'), own.lastIndexOf('clock_nanosleep') + 1)) counts[name] = (counts[name] ?? 0) + 1;
  return counts;
});

test('the servo makes the same system calls with no view and with eight: it sleeps', async () => {
  const alone = await callsOfServo(0, 3), watched = await callsOfServo(kPages, 3);
  console.log(`system calls of the servo's thread in 3 s: ${JSON.stringify(alone)} without a view, ${JSON.stringify(watched)} with ${kPages}`);
  const {clock_nanosleep: sleeps, ...others} = alone, {clock_nanosleep: watchedSleeps, ...watchedOthers} = watched;
  assert.ok(sleeps > 100 && watchedSleeps > 100, 'it sleeps from tick to tick');
  assert.deepEqual(watchedOthers, others, 'and does the same besides');
  assert.ok(Object.values(others).every((count) => count <= 1), 'once at most: when it has warmed up'); // getrusage
});

test('hapticd links no network library', () => {
  const libraries = spawnSync('ldd', [hapticd], {encoding: 'utf8'}).stdout;
  assert.doesNotMatch(libraries, /boost|ssl|curl|websocket/i);
});

/** CPU seconds of the browser's processes. */
function cpuOfBrowser(profile) {
  const lines = execFileSync('ps', ['-eo', 'pid=,args='], {encoding: 'utf8', maxBuffer: 1 << 24}).split('\n').filter((l) => l.includes(profile) && !l.includes('ps -eo'));
  return lines.reduce((sum, line) => { try { return sum + cpuOf(Number(line.trim().split(/\s+/)[0])); } catch { return sum; } }, 0);
}

/** Frames a second and CPU a frame of a page that shows a run. */
async function paceOf(page, browser, seconds) {
  const frames = () => page.evaluate(() => window.hapticdView.view.frames);
  const before = [await frames(), cpuOfBrowser(browser.profile), performance.now()];
  await pause(seconds);
  const drawn = (await frames()) - before[0];
  return {rate: 1e3 * drawn / (performance.now() - before[2]), cpu: (cpuOfBrowser(browser.profile) - before[1]) / drawn};
}

test('a scene costs a frame no more than three times an empty one, and is painted soon', () => Browser.alone({width: 1280, height: 720}, async (sandbox, open, browser) => {
  sandbox.start(['run', scenes('teapot'), '--name', 'test']);
  const view = sandbox.start(['view', '--name', 'test', '--control']), [url] = await view.says(/http:\S+/);
  const page = await open(url);
  await shown(page);
  await pause(2);
  const full = await paceOf(page, browser, 5), triangles = await page.evaluate(() => [...window.hapticdView.view.models.byIndex.values()].reduce((sum, m) => sum + m.triangles, 0));
  await page.evaluate(() => { window.hapticdView.view.models.group.visible = false; });
  const empty = await paceOf(page, browser, 5);
  const paints = [];
  for (let i = 0; i < 3; ++i) {
    await page.reload();
    await shown(page);
    paints.push(await page.evaluate(() => [performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? NaN, window.hapticdView.paints.scene]));
  }
  const [text, scene] = [0, 1].map((i) => median(paints.map((p) => p[i])));
  const load = readFileSync('/proc/loadavg', 'utf8').split(' ')[0];
  console.log(`page at 1280x720, ${triangles} triangles, load ${load}: ${full.rate.toFixed(1)} frames/s, ${(1e3 * full.cpu).toFixed(1)} ms of CPU a frame; without the model ` +
    `${empty.rate.toFixed(1)} frames/s, ${(1e3 * empty.cpu).toFixed(1)} ms; first paint ${text.toFixed(0)} ms, of the scene ${scene.toFixed(0)} ms (warm, median of 3)`);
  assert.ok(full.rate > 3, 'updates are seen');
  assert.ok(full.cpu < 3 * empty.cpu, 'a frame with the model costs little more than one without');
  assert.ok(text < scene, 'the page comes before the scene');
}));
