// SPDX-License-Identifier: MIT
// The official Foxglove client on a live daemon: every tick comes, and its bits are those of the recording of the run.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {readFileSync, writeFileSync} from 'node:fs';
import {join} from 'node:path';
import {test} from 'node:test';
import protocol from '@foxglove/ws-protocol';
import {parse} from '@foxglove/rosmsg';
import {MessageReader} from '@foxglove/rosmsg2-serialization';
import {WebSocket} from 'ws';
import {hapticd, root, sandboxed, scenes, until} from './program.mjs';

/** Subscribes to some topics and keeps what comes. */
class Listener {
  constructor(url, name, topics) {
    this.channels = new Map();
    this.messages = new Map(topics.map((t) => [t, []]));
    this.errors = [];
    const socket = new WebSocket(url.replace('http', 'ws'), [name]);
    this.client = new protocol.FoxgloveClient({ws: socket});
    this.client.on('error', (error) => this.errors.push(error));
    this.client.on('advertise', (channels) => channels.forEach((c) => this.channels.set(c.topic, c)));
    this.client.on('advertise', () => topics.forEach((topic) => this.#subscribe(topic)));
    this.topics = new Map();
    this.client.on('message', ({subscriptionId, timestamp, data}) => this.messages.get(this.topics.get(subscriptionId)).push({timestamp, data}));
  }

  #subscribe(topic) { this.topics.set(this.client.subscribe(this.channels.get(topic).id), topic); }

  decoded(topic) {
    const reader = new MessageReader(parse(this.channels.get(topic).schema, {ros2: true}));
    return this.messages.get(topic).map(({data}) => reader.readMessage(data));
  }
}

for (const name of ['foxglove.sdk.v1', 'foxglove.websocket.v1']) {
  test(`${name}: no gap, and the bits of the recording`, () => sandboxed(async (sandbox) => {
    const h5 = join(sandbox.folder, 'run.h5'), csv = join(sandbox.folder, 'ticks.csv');
    const {daemon, url} = await sandbox.show(scenes('pendulum'), {args: ['--record', h5]});
    const listener = new Listener(url, name, ['/hapticd/ticks', '/hapticd/poses', '/tf', '/scene']);
    await until(() => listener.messages.get('/hapticd/ticks').length > 3000, 60, '3000 ticks');
    await until(() => listener.messages.get('/scene').length > 0, 20, 'a scene');
    assert.deepEqual(listener.errors, []);
    listener.client.close();
    await daemon.end('SIGINT');
    execFileSync(hapticd, ['export', h5, '--csv', csv, '--stream', 'ticks']);
    const [head, ...rows] = readFileSync(csv, 'utf8').trimEnd().split('\n').map((row) => row.split(','));
    const ticks = listener.decoded('/hapticd/ticks');
    ticks.forEach((tick, i) => {
      if (i > 0) assert.equal(tick.tick, ticks[i - 1].tick + 1n, 'no tick is missing');
      const row = rows[Number(tick.tick)];
      head.forEach((field, column) => {
        const wanted = typeof tick[field] === 'bigint' ? BigInt(row[column]) : Number(row[column]);
        assert.ok(Object.is(tick[field], wanted) || Object.is(tick[field], Math.fround(Number(wanted))), `${field} of tick ${tick.tick}: ${tick[field]}, ${row[column]}`);
      });
    });
    const transforms = listener.decoded('/tf').at(-1).transforms;
    assert.deepEqual(transforms.map((t) => t.child_frame_id).map((n) => n.replace(/.*_tip$/, 'tip')), ['pendulum', 'tip']);
    const {x, y, z, w} = transforms[0].transform.rotation;
    assert.ok(Math.abs(Math.hypot(x, y, z, w) - 1) < 1e-9, 'a unit quaternion');
    const scene = JSON.parse(new TextDecoder().decode(listener.messages.get('/scene')[0].data));
    assert.equal(scene.entities[0].id, 'pendulum');
    assert.ok(scene.entities[0].triangles[0].indices.length > 100);
    const stamps = listener.messages.get('/hapticd/ticks').map((m) => m.timestamp);
    assert.ok(stamps.every((s, i) => i === 0 || s > stamps[i - 1]), 'times grow');
    assert.ok(Math.abs(Number(stamps[0] / 1000000n) - Date.now()) < 300e3, 'times are of today');
  }));
}

test('models that come and leave are in /scene and /tf, live and of a recording', () => sandboxed(async (sandbox) => {
  const h5 = join(sandbox.folder, 'run.h5'), model = join(sandbox.folder, 'later.yaml');
  writeFileSync(model, `hapticd: 1\nmodels:\n  - {name: later, plugin: nurbs_rigid, pose: {position: [0.2, 0, 0]}, parameters: {geometry: ${join(root, 'config', 'models', 'torus.yaml')}}}\n`);
  const {daemon, url} = await sandbox.show(scenes('sphere'), {args: ['--record', h5]});
  const ctl = (...words) => execFileSync(hapticd, ['ctl', '--name', 'test', '--wait', '30', ...words], {env: {...process.env, ...sandbox.env}, stdio: 'ignore'});
  const topics = ['/hapticd/ticks', '/tf', '/scene'];
  /** What happened to the models in /scene, and whether /tf ever had the later one, in its place. */
  const told = (listener) => listener.messages.get('/scene').map(({data}) => JSON.parse(new TextDecoder().decode(data)))
    .map(({entities, deletions}) => [...deletions.map(({id}) => `-${id}`), ...entities.map(({id}) => `+${id}`)].join());
  const placed = (listener) => listener.decoded('/tf').some(({transforms}) => transforms.some((t) => t.child_frame_id === 'later' && t.transform.translation.x === 0.2));
  const live = new Listener(url, 'foxglove.sdk.v1', topics);
  const wanted = ['+sphere', '+later', '-later'];
  for (const [i, words] of [['list'], ['add', model], ['remove', 'later']].entries()) {
    ctl(...words);
    await until(() => told(live).length > i, 60, `${wanted[i]} after ${told(live)}`);
  }
  assert.deepEqual(told(live), wanted);
  assert.ok(placed(live), 'it has its frame');
  live.client.close();
  await daemon.end('SIGINT');
  const [recorded] = await sandbox.start(['view', h5]).says(/http:\S+/);
  const past = new Listener(recorded, 'foxglove.sdk.v1', topics);
  await until(() => told(past).length >= 3, 60, `three changes, not ${told(past)}`);
  assert.deepEqual(told(past), wanted, 'of the recording');
  assert.ok(placed(past), 'it has its frame in the recording');
  past.client.close();
}));
