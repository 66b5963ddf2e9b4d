// SPDX-License-Identifier: MIT
/** What happened, newest first: orders, faults, contacts, clicks, models and clients that came and went. */
import {clock, element} from './format.js';
import {reader} from './rows.js';

const kMost = 300;
const kOrders = ['', 'enabled', 'disabled', 'moved', 'parameter set', 'fault cleared', 'held', 'added', 'removed', 'answered coarser', 'overran', 'motors cut'];
const kFaults = ['no fault any more', 'a force or position was not a number', 'the device is gone', 'the device reports a fault', 'no new sample came', 'the tip was too fast',
  'too many ticks were missed', 'not calibrated', 'held', 'a tick was stuck', 'a motor is too hot', 'the position jumped'];
const kServoOrders = new Set([9, 10, 11]);

export class Events {
  constructor(list, about, onEvent) {
    this.list = list;
    this.onEvent = onEvent;
    this.names = (about.models ?? []).map((m) => m.name);
    this.devices = (about.devices ?? []).map((d) => d.name);
    this.period = 1 / (about.rate_hz || 1000);
    const columns = about.columns ?? {};
    this.read = Object.fromEntries(['tick', 'kind', 'target', 'value'].map((n) => [n, reader(columns.orders ?? [], n)]));
    this.event = Object.fromEntries(['tick', 'kind', 'model', 'probe', 'value'].map((n) => [n, reader(columns.events ?? [], n)]));
    this.kinds = about.event_kinds ?? about.events ?? [];
    this.faults = [];
    this.touching = new Set();
    this.clear();
  }

  clear() {
    this.list.replaceChildren();
    this.touching.clear();
    this.faults = [];
  }

  add(t, kind, text) {
    this.list.prepend(element('li', {}, element('time', {}, clock(t)), element('i', {class: kind}), element('span', {}, text)));
    while (this.list.childElementCount > kMost) this.list.lastElementChild.remove();
    this.onEvent?.(t, kind);
  }

  name(model) { return this.names[model] ?? `model ${model}`; }

  orders(view, count, rowBytes) {
    for (let i = 0; i < count; ++i) {
      const at = i * rowBytes, kind = this.read.kind(view, at), target = this.read.target(view, at);
      if (kServoOrders.has(kind) && kind !== 11) continue;
      const whose = kind === 5 || kind === 6 || kind === 11 ? this.devices[target] ?? `arm ${target}` : this.name(target);
      const value = kind === 4 ? ` to ${Number(this.read.value(view, at).toPrecision(4))}` : '';
      this.add(this.read.tick(view, at) * this.period, kind === 11 ? 'fault' : 'order', `${whose}: ${kOrders[kind] ?? `order ${kind}`}${value}`);
    }
  }

  /** The stream of events, where the daemon has one. */
  events(view, count, rowBytes) {
    for (let i = 0; i < count; ++i) {
      const at = i * rowBytes, kind = this.event.kind(view, at);
      const name = this.kinds[kind] ?? `event ${kind}`, model = this.event.model(view, at);
      const sort = /fault|silenced|quarantin|cut|refused/.test(name) ? 'fault' : /click/.test(name) ? 'click' : /contact/.test(name) ? 'contact' : 'order';
      this.add(this.event.tick(view, at) * this.period, sort, `${this.names[model] ? `${this.names[model]}: ` : ''}${name.replaceAll('_', ' ')}`);
    }
  }

  /** What follows from the rows of now: faults that latched or went, contacts that began. */
  look(now) {
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
