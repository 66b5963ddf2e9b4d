// SPDX-License-Identifier: MIT
// Every value of an exported MCAP file, read by the official reader and decoded by Foxglove's ROS 2 library, is the value
// in the CSV of the same recording, bit for bit.
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import {mkdtempSync, readFileSync, rmSync, statSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {test} from 'node:test';
import {McapIndexedReader} from '@mcap/core';
import {parse} from '@foxglove/rosmsg';
import {MessageReader} from '@foxglove/rosmsg2-serialization';
import {decompress} from './zstd.mjs';
import {hapticd, sandboxed, scenes} from './program.mjs';

const readable = (bytes) => ({
  size: async () => BigInt(bytes.length),
  read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size))),
});

function table(file) {
  const [head, ...rows] = readFileSync(file, 'utf8').trimEnd().split('\n');
  return {names: head.split(','), rows: rows.filter((r) => r !== '').map((r) => r.split(','))};
}

/** The number of a CSV cell as the message has it: u8 as bigint, f4 rounded to single. */
const asMessage = (cell, value) => (typeof value === 'bigint' ? BigInt(cell) : Number(cell));

for (const scene of ['teapot', 'pendulum', 'two-arms', 'button']) {
  test(`${scene}: every value of the MCAP file is that of the recording`, async () => {
    const folder = mkdtempSync(join(tmpdir(), 'hapticd-mcap-'));
    try {
      const h5 = join(folder, 'run.h5'), mcap = join(folder, 'run.mcap'), csv = join(folder, 'csv');
      execFileSync(hapticd, ['run', scenes(scene), '--virtual-time', '--for', '2', '--record', h5], {stdio: 'ignore'});
      execFileSync(hapticd, ['export', h5, '--mcap', mcap, '--csv', csv]);
      const reader = await McapIndexedReader.Initialize({readable: readable(readFileSync(mcap)), decompressHandlers: {zstd: decompress}});
      const channels = new Map();
      for (const channel of reader.channelsById.values()) {
        const schema = reader.schemasById.get(channel.schemaId);
        const definition = parse(new TextDecoder().decode(schema.data), {ros2: true});
        channels.set(channel.id, {decoder: new MessageReader(definition), csv: table(join(csv, `${channel.topic.split('/').pop()}.csv`)), next: 0});
      }
      let values = 0, last = 0n;
      for await (const message of reader.readMessages()) {
        assert.ok(message.logTime >= last, 'times grow');
        last = message.logTime;
        const channel = channels.get(message.channelId), row = channel.csv.rows[channel.next++];
        const said = channel.decoder.readMessage(message.data);
        channel.csv.names.forEach((name, i) => {
          const wanted = asMessage(row[i], said[name]), got = said[name];
          assert.ok(Object.is(got, wanted) || Object.is(got, Math.fround(Number(wanted))) || (Number.isNaN(got) && row[i] === 'nan'), `${name}: ${got} is not ${row[i]}`);
          ++values;
        });
      }
      for (const channel of channels.values()) assert.equal(channel.next, channel.csv.rows.length, 'every row is there');
      assert.ok(values > 50000, `${values} values`);
      assert.ok(statSync(mcap).size <= 0.5 * statSync(h5).size, `${statSync(mcap).size} of ${statSync(h5).size} bytes`);
      const attachments = [];
      for await (const attachment of reader.readAttachments()) attachments.push(attachment);
      assert.equal(JSON.parse(new TextDecoder().decode(attachments[0].data)).format, 'hapticd-recording/1');
    } finally {
      rmSync(folder, {recursive: true});
    }
  });
}

test('the text of a mark is a string of ROS', () => sandboxed(async (sandbox) => {
  const h5 = join(sandbox.folder, 'run.h5'), mcap = join(sandbox.folder, 'run.mcap'), texts = ['trial 7 "begins", \u00e4', 'x'.repeat(95)];
  const run = sandbox.start(['run', scenes('teapot'), '--name', 'marked', '--for', '100', '--allow-non-rt', '--record', h5]);
  const ask = (...words) => execFileSync(hapticd, ['ctl', '--name', 'marked', '--wait', '30', ...words], {env: {...process.env, ...sandbox.env}, stdio: 'pipe'});
  const ticks = texts.map((text) => JSON.parse(ask('mark', text)).tick);
  ask('stop');
  await run.ended;
  execFileSync(hapticd, ['export', h5, '--mcap', mcap]);
  const reader = await McapIndexedReader.Initialize({readable: readable(readFileSync(mcap)), decompressHandlers: {zstd: decompress}});
  const found = [];
  for await (const message of reader.readMessages({topics: ['/hapticd/marks']})) {
    const schema = reader.schemasById.get(reader.channelsById.get(message.channelId).schemaId);
    found.push(new MessageReader(parse(new TextDecoder().decode(schema.data), {ros2: true})).readMessage(message.data));
  }
  assert.deepEqual(found.map(({tick, text}) => [Number(tick), text]), ticks.map((tick, i) => [tick, texts[i]]));
}));
