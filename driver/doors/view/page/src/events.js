// SPDX-License-Identifier: MIT
/** The list of what happened, newest first: orders, faults, contacts, clicks, marks, and models and programs that came or
 * left. */
import {clock, element, short} from './format.js';
import {readAll, reader} from './rows.js';

const kMost = 300;
const kOrders = ['', 'enabled', 'disabled', 'moved', 'parameter set', 'fault cleared', 'held', 'added', 'removed', 'computed less accurately', 'overran', 'motors cut', 'led', 'no longer led'];
/** Numbers of the orders that are not listed: events report the same, or the servo itself gave them. */
const kToldAsEvents = new Set([5, 6, 7, 8, 9, 10, 12, 13]);
export const kHeld = 8; // number of the fault of an arm that a person holds; it is not shown as a failure
const kOfArm = new Set([5, 6, 11]);
const kFaults = ['no fault any more', 'a force or position was not a number', 'the device is gone', 'the device reports a fault', 'no new sample came', 'the tip was too fast',
  'too many ticks were missed', 'not calibrated', 'held', 'a tick did not end', 'a motor is too hot', 'the position jumped', 'its orientation is not a unit quaternion'];
const kFaultUnits = {4: 's', 5: 'm/s', 6: 's', 9: 's', 10: '°C', 11: 'm/s'};
const kSilenced = ['', 'it lost the surface', 'its force or pose was not a number', 'it returned an unknown status', 'its steps took too long', 'its force jumped beyond its stiffness',
  'its pose is not a unit quaternion', 'it pulled the probe in', 'its torque jumped beyond its stiffness', 'its body ran away',
  'it gave energy from nowhere'];
const kJoined = ['a program leads it', 'a program leads its hand', 'a program pushes on it'];
const kLost = ['no program leads it any more', 'no program leads its hand any more', 'the program pushes no more'];
/** The text for each kind of event; e has the code and the value of the event. `sort` decides the colour, the sound and
 * the mark. */
const kEvents = {
  click: {sort: 'click', text: (e) => `click${['', ', snapped in', ', snapped out'][e.code] ?? ''}`},
  touch: {sort: 'contact', text: (e) => `touched, ${short(e.value)} N`},
  fault: {sort: 'fault', text: (e) => `${kFaults[e.code] ?? `fault ${e.code}`}${kFaultUnits[e.code] ? ` (${short(e.value)} ${kFaultUnits[e.code]})` : ''}`},
  cleared: {sort: 'order', text: () => 'no fault any more'},
  silenced: {sort: 'fault', text: (e) => `not felt any more: ${kSilenced[e.code] || 'it is not trusted'}`},
  degraded: {sort: 'late', text: () => 'computes less accurately, because time is short'},
  restored: {sort: 'order', text: () => 'computes at full accuracy again'},
  came: {sort: 'order', text: () => 'was added'},
  left: {sort: 'order', text: () => 'was removed'},
  joined: {sort: 'order', text: (e) => kJoined[e.code] ?? kJoined[0]},
  lost: {sort: 'order', text: (e) => kLost[e.code] ?? kLost[0]},
  refused: {sort: 'fault', text: (e) => `${e.value} records of the program that leads it were refused so far`},
  stalled: {sort: 'fault', text: (e) => `no tick came for ${short(e.value)} s`},
  end_stop: {sort: 'contact', text: (e) => `came to its ${['', 'lowest', 'highest'][e.code] ?? ''} end`},
  mark: {sort: 'mark', text: () => 'marked'}, // the stream `marks` has its text
  quarantined: {sort: 'fault', text: () => 'models were left out, because their plugin ended an earlier run'},
};

export class Events {
  constructor(list, about, onEvent) {
    this.list = list;
    this.onEvent = onEvent;
    this.models = []; // all models that were ever named, by the ticks from which on they have their numbers
    this.description = ''; // beginning of the text that describes a model
    this.devices = (about.devices ?? []).map((d) => d.name);
    this.period = 1 / (about.rate_hz || 1000);
    const columns = about.columns ?? {}, readers = (stream, names) => Object.fromEntries(names.map((n) => [n, reader(columns[stream] ?? [], n)]));
    this.order = readers('orders', ['tick', 'kind', 'target', 'value']);
    this.event = readers('events', ['tick', 't', 'kind', 'model', 'probe', 'code', 'value']);
    this.mark = readers('marks', ['tick', 't', 'model', 'left', 'text']);
    this.kinds = about.events ?? [];
    this.told = 'events' in columns; // older recordings have no stream of events
    this.faults = [];
    this.touching = new Set();
    this.clear();
  }

  clear() {
    this.list.replaceChildren();
    this.touching.clear();
    this.faults = [];
    this.description = '';
  }

  add(t, kind, text) {
    this.list.prepend(element('li', {}, element('time', {}, clock(t)), element('i', {class: kind}), element('span', {}, text)));
    while (this.list.childElementCount > kMost) this.list.lastElementChild.remove();
    this.onEvent?.(t, kind);
  }

  /** Learns the names of models. @param models list of {name, index, since} */
  learn(models) {
    const known = new Set(this.models.map(({index, since}) => `${index}/${since}`));
    const fresh = models.map(({name, index, since = 0}) => ({name, index, since})).filter(({index, since}) => !known.has(`${index}/${since}`));
    if (fresh.length > 0) this.models = [...this.models, ...fresh].sort((a, b) => a.since - b.since);
  }

  name(model, tick = Infinity) {
    return this.models.findLast(({index, since}) => index === model && since <= tick)?.name ?? `model ${model}`;
  }

  orders(view, count, rowBytes) {
    for (let i = 0; i < count; ++i) {
      const {tick, kind, target, value} = readAll(this.order, view, i * rowBytes);
      if (this.told && kToldAsEvents.has(kind)) continue;
      const whose = kOfArm.has(kind) ? this.devices[target] ?? `arm ${target}` : this.name(target, tick);
      const to = kind === 4 ? ` to ${Number(value.toPrecision(4))}` : '';
      this.add(tick * this.period, kind === 11 ? 'fault' : 'order', `${whose}: ${kOrders[kind] ?? `order ${kind}`}${to}`);
    }
  }

  events(view, count, rowBytes) {
    for (let i = 0; i < count; ++i) {
      const e = readAll(this.event, view, i * rowBytes);
      const name = this.kinds[e.kind] ?? `event ${e.kind}`;
      if (name === 'mark') continue; // marks() tells it
      const said = kEvents[name] ?? {sort: 'order', text: () => name.replaceAll('_', ' ')};
      const whose = e.model >= 0 ? this.name(e.model, e.tick) : this.devices[e.probe];
      this.add(e.t, name === 'fault' && e.code === kHeld ? 'order' : said.sort, `${whose ? `${whose}: ` : ''}${said.text(e)}`);
    }
  }

  marks(view, count, rowBytes) {
    for (let i = 0; i < count; ++i) {
      const mark = readAll(this.mark, view, i * rowBytes);
      if (mark.model >= 0) this.#describe(mark);
      else this.add(mark.t, 'mark', mark.text);
    }
  }

  /** Takes a row of the description of a model that comes. The page may have missed the first rows of it. */
  #describe({tick, model, left, text}) {
    this.description += text;
    if (left > 0) return;
    const described = this.description;
    this.description = '';
    try {
      this.learn([{name: JSON.parse(described).name, index: model, since: tick}]);
    } catch { /* the list will have its name */ }
  }

  /** For a recording without a stream of events: finds events in the present rows, namely faults that began or ended
   * and contacts that began. */
  look(now) {
    if (this.told) return;
    now.arms.forEach((arm, i) => {
      const fault = arm.now?.fault ?? 0;
      if (fault === (this.faults[i] ?? 0)) return;
      this.faults[i] = fault;
      this.add(now.tick.t, fault === 0 ? 'order' : 'fault', `${arm.name}: ${kFaults[fault] ?? `fault ${fault}`}`);
    });
    const touching = new Set(now.current().filter((c) => c.depth > 0).map((c) => c.model));
    for (const model of touching) if (!this.touching.has(model)) this.add(now.tick.t, 'contact', `${this.name(model)}: contact`);
    this.touching = touching;
  }
}
