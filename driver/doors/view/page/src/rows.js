// SPDX-License-Identifier: MIT
/** Rows as the daemon records them. Each stream has a table, which keeps the newest rows as bytes. Numbers are read by
 * the name of their column. */

const kReaders = {
  f8: (view, at) => view.getFloat64(at, true),
  f4: (view, at) => view.getFloat32(at, true),
  u8: (view, at) => Number(view.getBigUint64(at, true)),
  u4: (view, at) => view.getUint32(at, true),
  i4: (view, at) => view.getInt32(at, true),
  s96: (view, at) => new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + at, 96)).replace(/\0.*/s, ''),
};
const kKeptSeconds = 11, kMostBytes = 24 << 20;

/** Returns a function that reads a column of the row that begins at `at`. If there is no such column, the function
 * returns NaN. */
export function reader(columns, name) {
  const column = columns.find((c) => c.name === name);
  if (!column) return () => NaN;
  const read = kReaders[column.type], {offset} = column;
  return (view, at) => read(view, at + offset);
}

/** Returns a function that reads columns with a common prefix as a list of numbers. */
export function vectorReader(columns, prefix, names = ['x', 'y', 'z']) {
  const readers = names.map((n) => reader(columns, prefix + n));
  return (view, at) => readers.map((read) => read(view, at));
}

/** The newest rows of one stream, in a ring buffer. */
export class Table {
  constructor(name, columns, rowBytes, capacity) {
    this.name = name;
    this.columns = columns;
    this.rowBytes = rowBytes;
    this.capacity = capacity;
    this.bytes = new Uint8Array(capacity * rowBytes);
    this.view = new DataView(this.bytes.buffer);
    this.end = 0; // number of all rows that have come so far
  }

  clear() { this.end = 0; }

  push(from, count) {
    for (let i = Math.max(0, count - this.capacity); i < count; ++i) {
      const row = new Uint8Array(from.buffer, from.byteOffset + i * this.rowBytes, this.rowBytes);
      this.bytes.set(row, (this.end + i) % this.capacity * this.rowBytes);
    }
    this.end += count;
  }

  get begin() { return Math.max(0, this.end - this.capacity); }
  at(row) { return row % this.capacity * this.rowBytes; }
}

/** Reads a row: the value of each reader under its name. */
export const readAll = (readers, view, at) => Object.fromEntries(Object.entries(readers).map(([name, read]) => [name, read(view, at)]));

function armOf(columns, prefix, {name, info}) {
  const joints = Array.from({length: info?.joint_count ?? 0}, (_, i) => `q${i}`);
  const read = {
    joints: vectorReader(columns, prefix, joints), position: vectorReader(columns, prefix), sent: vectorReader(columns, `${prefix}sent_f`),
    fault: reader(columns, `${prefix}fault`), valid: reader(columns, `${prefix}valid`),
  };
  return {name, info, read, now: null};
}

/** The present state: the newest tick, contacts and poses. They are taken from each batch of rows as it comes. */
export class Now {
  constructor(about, streams) {
    const columns = (name) => about.columns?.[name] ?? [];
    const rows = kKeptSeconds * (about.rate_hz || 1000);
    this.about = about;
    this.tables = streams.map((s) => new Table(s.name, columns(s.name), s.row_bytes,
      Math.max(64, Math.min(Math.ceil(rows), Math.floor(kMostBytes / s.row_bytes)))));
    this.arms = (about.devices ?? []).map((device, i) => armOf(columns('ticks'), `arm${i}_`, device));
    this.tick = {t: NaN, tick: -1, depth: NaN};
    this.contacts = new Map(); // "model/probe" -> contact
    this.poses = new Map(); // model -> pose
    const t = columns('ticks'), c = columns('contacts'), p = columns('poses');
    this.read = {tick: reader(t, 'tick'), t: reader(t, 't'), depth: reader(t, 'depth')};
    this.contact = {
      tick: reader(c, 'tick'), model: reader(c, 'model'), probe: reader(c, 'probe'), depth: reader(c, 'depth'),
      feature: reader(c, 'feature'), point: vectorReader(c, 'p'), normal: vectorReader(c, 'n'),
    };
    this.model = reader(p, 'model');
    this.pose = {tick: reader(p, 'tick'), position: vectorReader(p, ''), orientation: vectorReader(p, 'q', ['w', 'x', 'y', 'z'])};
  }

  table(name) { return this.tables.find((t) => t.name === name); }

  clear() {
    for (const table of this.tables) table.clear();
    this.contacts.clear();
    this.poses.clear();
    this.tick.tick = -1;
  }

  /** Returns the newest pose of a model that has its number since a tick; undefined if it has not moved. */
  poseOf(index, since = 0) {
    const pose = this.poses.get(index);
    return pose && !(pose.tick < since) ? pose : undefined;
  }

  /** Takes a message of rows. Returns the table to which the rows were added. */
  take({stream, rowBytes, count, bytes}) {
    const table = this.tables[stream];
    if (!table || table.rowBytes !== rowBytes) return null;
    table.push(bytes, count);
    if (table.name === 'ticks') this.#ticks(bytes, (count - 1) * rowBytes);
    else if (table.name === 'contacts') this.#contacts(bytes, count, rowBytes);
    else if (table.name === 'poses') this.#poses(bytes, count, rowBytes);
    return table;
  }

  #ticks(view, at) {
    this.tick = readAll(this.read, view, at);
    for (const arm of this.arms) {
      arm.now = readAll(arm.read, view, at);
      arm.now.valid = arm.now.valid === 1;
    }
  }

  #contacts(view, count, rowBytes) {
    const newest = this.contact.tick(view, (count - 1) * rowBytes);
    for (let i = count - 1; i >= 0 && this.contact.tick(view, i * rowBytes) === newest; --i) {
      const c = readAll(this.contact, view, i * rowBytes);
      this.contacts.set(`${c.model}/${c.probe}`, c);
    }
  }

  #poses(view, count, rowBytes) {
    const seen = new Set();
    for (let i = count - 1; i >= 0; --i) {
      const at = i * rowBytes, model = this.model(view, at);
      if (seen.has(model)) continue;
      seen.add(model);
      this.poses.set(model, readAll(this.pose, view, at));
      if (seen.size >= this.poses.size && count - i > 256) break;
    }
  }

  /** Returns the contacts of the newest tick. */
  current() {
    return [...this.contacts.values()].filter((c) => this.tick.tick - c.tick <= 1);
  }
}
