// SPDX-License-Identifier: MIT
/** Plots of the last seconds. A column of pixels shows the least and the greatest value of its ticks, so that even a
 * single late tick can be seen. */
import uPlot from 'uplot';
import {element, norm, short, themeColor} from './format.js';
import {reader, vectorReader} from './rows.js';

const kSeconds = 10;
const kBuckets = 640; // number of intervals in kSeconds; each contains about 16 ticks at 1 kHz
const kRedrawMs = 90;
const kColours = {fault: '--bad', click: '--late', mark: '--depth'}; // of moments; others are faint

/** The least and the greatest value of one quantity in each interval of time (bucket). */
class Extremes {
  constructor(read, readTime) {
    this.read = read;
    this.readTime = readTime;
    this.clear();
  }

  clear() {
    this.bucket = -1;
    this.times = [];
    this.low = [];
    this.high = [];
    this.newest = NaN;
  }

  add(view, at) {
    const value = this.read(view, at), t = this.readTime(view, at), known = Number.isFinite(value);
    if (known) this.newest = value;
    const bucket = Math.floor(t / kSeconds * kBuckets), last = this.times.length - 1;
    if (bucket === this.bucket) {
      if (known) this.low[last] = Math.min(this.low[last] ?? value, value), this.high[last] = Math.max(this.high[last] ?? value, value);
      return;
    }
    this.bucket = bucket;
    this.times.push(t);
    this.low.push(known ? value : null);
    this.high.push(known ? value : null);
    while (this.times.length > kBuckets + 2) this.times.shift(), this.low.shift(), this.high.shift();
  }
}

function axis(size, format) {
  return {
    stroke: () => themeColor('--faint'), grid: {stroke: () => themeColor('--line'), width: 1}, ticks: {show: false},
    font: '11px system-ui, sans-serif', size, gap: 3, values: format,
  };
}

/** Draws a line in a colour of the theme. */
function line(ctx, color, from, to) {
  ctx.strokeStyle = themeColor(color);
  ctx.beginPath();
  ctx.moveTo(...from), ctx.lineTo(...to);
  ctx.stroke();
}

class Plot {
  constructor(parent, {title, about = '', unit, color, read, scale = 1, limit = null, zero = true, least = 0}, plots) {
    this.plots = plots;
    this.scale = scale;
    this.limit = limit;
    this.value = element('b', {}, '–');
    this.unit = unit;
    const bound = limit === null ? '' : element('small', {title: 'Limit: dashed in the plot'}, `≤ ${short(limit)} ${unit}`);
    const mark = element('i');
    mark.style.background = `var(${color})`;
    this.chartBox = element('div', {class: 'chart'});
    this.root = element('article', {class: 'plot'}, element('h3', {}, mark, element('span', {title: about || title}, title), bound, this.value), this.chartBox);
    parent.append(this.root);
    this.extremes = new Extremes((view, at) => scale * read(view, at), plots.readTime);
    this.color = color;
    this.zero = zero;
    this.least = least; // least span of the axis, so that noise is not magnified
    this.#chart();
    this.#fill();
  }

  #chart() {
    const stroke = () => themeColor(this.color);
    const range = (u, low, high) => {
      const bottom = this.zero ? Math.min(0, low ?? 0) : low ?? 0, top = Math.max(high ?? 0, bottom + Math.max(this.least, 1e-9));
      return [bottom - (bottom < 0 ? 0.06 : 0) * (top - bottom), top + 0.1 * (top - bottom)];
    };
    this.chart = new uPlot({
      width: 240, height: 118, legend: {show: false}, cursor: {show: true, points: {show: false}, y: false, drag: {x: false, y: false}},
      padding: [6, 16, 0, 0], scales: {x: {time: false}, y: {range}},
      axes: [axis(20, (u, values) => values.map((v) => `${Number(v.toFixed(1))} s`)), axis(40, (u, values) => values.map((v) => String(Number(v.toPrecision(4)))))],
      series: [{}, {stroke, width: 1.4, points: {show: false}}, {stroke, width: 1.4, points: {show: false}}],
      bands: [{series: [2, 1], fill: () => `color-mix(in srgb, ${themeColor(this.color)} 45%, transparent)`}],
      hooks: {draw: [(u) => this.#marks(u)]},
    }, [[0, 1], [null, null], [null, null]], this.chartBox);
  }

  /** Draws a dashed line at the limit, and a line at each moment (fault, order, mark of a program). */
  #marks(u) {
    const {ctx} = u, {left, top, width, height} = u.bbox;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    if (this.limit !== null) {
      const y = u.valToPos(this.limit, 'y', true);
      ctx.setLineDash([5, 4]);
      line(ctx, '--bad', [left, y], [left + width, y]);
      ctx.setLineDash([]);
    }
    for (const {t, kind} of this.plots.marks) {
      const x = u.valToPos(t, 'x', true);
      ctx.globalAlpha = kind === 'fault' || kind === 'mark' ? 0.9 : 0.45;
      line(ctx, kColours[kind] ?? '--faint', [x, top], [x, top + height]);
    }
    ctx.restore();
  }

  /** Fills the plot from the rows that are kept, so that a column that was just picked shows the last seconds at
   * once. */
  #fill() {
    const {table} = this.plots;
    for (let row = table.begin; row < table.end; ++row) this.extremes.add(table.view, table.at(row));
  }

  redraw(from, to) {
    const {times, low, high, newest} = this.extremes;
    const {clientWidth, clientHeight} = this.chartBox;
    if (clientWidth > 0 && (this.chart.width !== clientWidth || this.chart.height !== clientHeight))
      this.chart.setSize({width: clientWidth, height: clientHeight});
    this.chart.batch(() => {
      this.chart.setData([times, low, high], false);
      this.chart.setScale('x', {min: from, max: to});
    });
    this.value.textContent = `${short(newest)} ${this.unit}`;
  }

  destroy() {
    this.chart.destroy();
    this.root.remove();
  }
}

export class Plots {
  /** @param arms {name, limit} of each arm; limit is its largest force [N] or null @param period [s] duration of a
   * tick */
  constructor(parent, table, {arms, period}) {
    parent.replaceChildren();
    this.parent = parent;
    this.table = table;
    this.marks = [];
    const {columns} = table;
    this.readTime = reader(columns, 't');
    const depth = reader(columns, 'depth');
    const forces = arms.map(({name, limit}, i) => {
      const force = vectorReader(columns, `arm${i}_sent_f`);
      return {title: arms.length > 1 ? `Force, ${name}` : 'Force', about: 'Force that the arm exerts on the hand', unit: 'N', color: '--force', read: (v, at) => norm(force(v, at)), limit, least: 0.5};
    });
    this.plots = [
      ...forces,
      {title: 'Depth', about: 'How deep the tip is in the model; negative: its distance', unit: 'mm', color: '--depth', read: (v, at) => Math.max(depth(v, at), -0.02), scale: 1e3, zero: false, least: 0.5},
      {title: 'Lateness', about: 'How late each tick began', unit: 'µs', color: '--late', read: reader(columns, 'lateness_us'), limit: period * 1e6, least: 50},
      {title: 'Compute time', about: 'How long each tick took', unit: 'µs', color: '--compute', read: reader(columns, 'compute_us'), limit: period * 1e6, least: 20},
    ].map((what) => new Plot(parent, what, this));
    this.own = null;
    this.next = 0;
  }

  /** Returns the columns that the user may pick. */
  columns() { return this.table.columns.filter((c) => !/reserved|^tick$|_ns$/.test(c.name)); }

  /** Shows the column that the user picked. @param name name of the column, or '' for none */
  pick(name) {
    this.own?.destroy();
    const column = this.table.columns.find((c) => c.name === name);
    this.own = column ? new Plot(this.parent, {title: column.name, unit: column.unit, color: '--own', read: reader(this.table.columns, name), zero: false}, this) : null;
  }

  get all() { return this.own ? [...this.plots, this.own] : this.plots; }

  add(view, count, rowBytes) {
    for (let i = 0; i < count; ++i) for (const plot of this.all) plot.extremes.add(view, i * rowBytes);
  }

  mark(t, kind) {
    this.marks.push({t, kind});
    if (this.marks.length > 200) this.marks.shift();
  }

  clear() {
    this.marks = [];
    for (const plot of this.all) plot.extremes.clear();
  }

  /** Draws the plots again, about ten times per second. @param t newest time [s] */
  redraw(t, now) {
    if (now < this.next || !Number.isFinite(t)) return;
    this.next = now + kRedrawMs;
    for (const plot of this.all) plot.redraw(t - kSeconds, t);
  }
}
