// SPDX-License-Identifier: MIT
/** The page of hapticd-view. It passes the messages of the connection on to the scene, the plots and the panels. */
import {ArmModel} from './arm.js';
import {Connection} from './connection.js';
import {Drawings} from './drawings.js';
import {Events, kHeld} from './events.js';
import {Features} from './features.js';
import {$, fileName, save, short, sizeOf, themeColor} from './format.js';
import {greatestForce, Hand, handReach} from './hand.js';
import {Panel} from './panel.js';
import {Plots} from './plots.js';
import {Readouts} from './readouts.js';
import {Now} from './rows.js';
import {View} from './scene.js';
import {Sound} from './sound.js';
import {endText} from './stops.js';
import {Timeline} from './timeline.js';

const kFullStain = 0.003; // m: depth of the strongest colour
const kNoticeMs = 6000;
const kGuided = 7; // value of hand.script for a hand that a program leads
const kStopMs = 3000; // time after which the question "End the run?" is taken back
/** Elements that use the space key themselves; everywhere else it holds the arms. */
const kTakesSpace = 'input:not([type=number], [type=range]), textarea, select';

class Page {
  constructor() {
    // The token in the address is no longer needed, so it is removed.
    if (location.search) history.replaceState(null, '', location.pathname);
    this.connection = new Connection(`ws://${location.host}/`);
    this.ask = (request) => this.connection.ask(request);
    this.features = new Features(this.ask);
    this.panel = new Panel(this.ask);
    this.drawings = new Drawings(this.ask, this.panel);
    this.drawings.onLack = (text) => this.notice(text);
    this.panel.onRefused = (error) => this.notice(error);
    this.timeline = new Timeline(this.ask);
    this.sound = new Sound();
    this.view = null;
    this.now = null;
    this.hello = null;
    [this.status, this.held] = [{}, false];
    this.pendingList = null;
    this.paints = {first: performance.now(), scene: 0};
    this.#listen();
    this.#buttons();
    this.#theme(localStorage.getItem('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
    // The page is drawn first, and the scene one frame later.
    requestAnimationFrame(() => setTimeout(() => this.#startView()));
  }

  #startView() {
    try {
      this.view = new View($('canvas'), $('ruler'));
    } catch (error) {
      this.notice(`This browser cannot draw 3D (WebGL 2): ${error.message}`);
      return;
    }
    this.hand = new Hand(this.connection, this.view);
    this.hand.onRefused = (error) => this.notice(error);
    this.#theme(document.documentElement.dataset.theme);
    if (this.hello) this.#begin(this.hello);
    let last = performance.now();
    const frame = (time) => {
      requestAnimationFrame(frame);
      this.#frame(time);
      if (this.view.draw()) {
        this.paints.scene ||= performance.now();
        this.view.pace(time - last);
      }
      last = time;
    };
    requestAnimationFrame(frame);
  }

  #listen() {
    const on = (type, use) => this.connection.addEventListener(type, (e) => use(e.detail));
    on('about', (hello) => { this.hello = hello; this.pendingList = null; if (this.view) this.#begin(hello); });
    on('rows', (message) => this.#rows(message));
    on('vertices', ({model, xyz}) => { this.view?.models.deform(model, xyz); if (this.view) this.view.dirty = true; });
    on('list', (list) => this.#list(list));
    on('status', (status) => this.#status(status));
    on('reset', () => { this.now?.clear(); this.plots?.clear(); this.events?.clear(); });
    on('playback', (state) => { if (!this.still) this.timeline.show(state); });
    on('waiting', ({name}) => this.#lamp('wait', `No daemon named ${name} runs yet. To start it: hapticd run SCENE${name === 'hapticd' ? '' : ` --name ${name}`}`));
    on('end', () => { this.#lamp('wait', 'The run has ended'); this.hand?.begin([], [], 'The run has ended'); });
    on('lost', () => this.#lost());
    on('refused', (why) => { this.whyLost = why; this.notice(why); });
  }

  /** Called when the connection was lost. The daemon then stops the hand. The picture stays, and a tip that is still
   * held is led again when the connection is back. */
  #lost() {
    this.#lamp('bad', this.whyLost ?? 'The connection is lost: trying again');
    if (this.hand?.lose()) this.ledWhenLost = true;
  }

  /** Shows or hides the hint how to move the hand. @param again true if it is the same run as before the connection was
   * lost */
  #invite(again) {
    const {about, control} = this.hello, script = about.scene?.devices?.[0]?.parameters?.find((p) => p.id === 'hand.script');
    const resting = again && this.ledWhenLost;
    this.ledWhenLost = false;
    $('hint').hidden = !resting && (!control || script?.number !== kGuided);
    $('hint').textContent = resting ? 'The connection was lost, and the hand rests: drag the tip again' : `Drag the tip onto a model to press it${matchMedia('(pointer: coarse)').matches ? '' : '; the wheel moves it deeper'}`;
    if (again) this.notice('The connection is back', true);
  }

  /** Called when a run was found, or found again. @param hello the server's description of the run */
  #begin(hello) {
    const {about, streams, control, recorded} = hello, identity = JSON.stringify(about), again = identity === this.identity;
    this.identity = identity;
    this.whyLost = null;
    this.now = new Now(about, streams);
    const names = this.now.arms.map(({name}) => name), limits = names.map((_, i) => greatestForce(about, i));
    this.#measures(about, names, limits);
    this.#emptyScene(about, again);
    this.still = recorded && names.length === 0; // models that are only looked at
    document.body.classList.toggle('still', this.still);
    this.#title(hello);
    this.hand.begin(names, limits.map((limit, i) => handReach(about.scene?.devices?.[i], limit)),
      recorded ? 'A recording can only be looked at' : control ? '' : 'This view only looks. To press with the mouse: hapticd run SCENE --view', again);
    this.#invite(again);
    if (!recorded || this.still) this.timeline.show(null);
    else if (again) this.timeline.restore();
    this.drawings.list(about.scene?.models ?? about.models ?? []);
    this.events.learn(this.drawings.listed);
    this.#drawModels();
    if (this.pendingList) this.#list(this.pendingList); // the list came before there was a view
  }

  /** Makes what shows numbers and events: the forces, the plots with the columns to pick from, and the list. @param limits [N] of the arms */
  #measures(about, names, limits) {
    const ticks = this.now.table('ticks'), arms = names.map((name, i) => ({name, limit: limits[i]}));
    this.plots = ticks ? new Plots($('plots'), ticks, {arms, period: 1 / (about.rate_hz || 1000)}) : null;
    $('pick').replaceChildren(new Option('none', ''), ...(this.plots?.columns() ?? []).map((c) => new Option(c.unit ? `${c.name} [${c.unit}]` : c.name, c.name)));
    this.readouts = new Readouts($('readouts'), names);
    this.events = new Events($('events'), about, (t, kind) => {
      if (kind !== 'contact') this.plots?.mark(t, kind);
      this.sound.play(kind);
    });
  }

  /** Takes all models out of the scene, and puts the arms of the run into it. @param again true if the camera and the hand stay as they are */
  #emptyScene(about, again) {
    const devices = about.scene?.devices ?? [];
    this.drawings.begin(this.view, this.now);
    this.features.clear();
    this.view.arms(this.now.arms.length);
    this.armModels = this.now.arms.map(({info}, i) => new ArmModel(devices[i], info));
    this.view.setWorkspaces(devices.map((device, i) => ({
      box: this.armModels[i]?.workspace(), center: device.mount?.position ?? [0, 0, 0], radius: Number(device.limits?.workspace) || 0,
    })));
    this.fitted = again;
    this.fitWhenTip = false;
    if (!again) this.hand.used = false;
  }

  #title({about, name, control, recorded}) {
    this.panel.folder = about.folder ?? '';
    $('scene-name').textContent = fileName(about.scene?.file) || name;
    $('scene-mode').textContent = this.still ? 'at rest' : recorded ? `recording ${fileName(name)}` : control ? 'live' : 'live, looking only';
    document.title = `${$('scene-name').textContent} · hapticd`;
    $('run-tools').hidden = !control;
  }

  /** Draws the models that came, and removes those that left. */
  async #drawModels() {
    if (!await this.drawings.draw()) return;
    this.view.measure();
    const {lengths, unit} = sizeOf(this.view.models.box());
    $('read-size').value = lengths;
    $('read-size-unit').textContent = unit;
    this.fresh = true; // the tip has its radius, also in a recording that rests
    if (this.fitted) return;
    if (!this.hand.used) this.view.fit();
    this.fitted = this.fitWhenTip = true;
  }

  #list(list) {
    this.pendingList = list;
    if (!this.view || !this.now) return;
    this.drawings.list(this.#withValues(list.models));
    this.events.learn(this.drawings.listed);
    this.#showModels();
  }

  /** Shows the models of the present tick. */
  #showModels() {
    const models = this.drawings.present();
    if (this.drawings.stale()) this.features.clear(); // another part may have the same name
    this.panel.show(models, this.hello.control);
    // A model that has moved and now rests has no rows any more, so its pose comes from the list.
    for (const {index, pose, since} of models) if (pose && !this.now.poseOf(index, since)) this.view.models.move(index, pose);
    this.view.dirty = true;
    this.#drawModels();
  }

  /** Adds the values of parameters: if the daemon does not report the present value, the value of the scene is taken. */
  #withValues(models) {
    const scene = this.now.about.scene?.models ?? [];
    for (const model of models)
      for (const parameter of model.live_parameters ?? []) {
        const given = scene.find((s) => s.name === model.name)?.parameters?.find((p) => p.id === parameter.id);
        parameter.value ??= Number(given?.number ?? NaN);
      }
    return models;
  }

  #rows(message) {
    const table = this.now?.take(message);
    if (!table) return;
    const {bytes, count, rowBytes} = message;
    if (table.name === 'ticks') this.plots?.add(bytes, count, rowBytes);
    else if (table.name === 'orders') this.events.orders(bytes, count, rowBytes);
    else if (table.name === 'events') this.events.events(bytes, count, rowBytes);
    else if (table.name === 'marks') this.events.marks(bytes, count, rowBytes);
    this.fresh = true;
  }

  #frame(time) {
    if (!this.now) return;
    this.hand.look(time);
    this.plots?.redraw(this.now.tick.t, time);
    if (!this.fresh) return;
    this.#update();
    this.fresh = false;
    this.view.dirty = true;
  }

  #update() {
    const {now, view} = this, contacts = now.current();
    if (this.hello.recorded && this.drawings.stale()) this.#showModels();
    for (const {index, since} of this.drawings.present()) view.models.move(index, now.poseOf(index, since));
    view.models.stain(contacts, kFullStain);
    now.arms.forEach((arm, i) => {
      if (!arm.now) return;
      view.probes[i].update(arm.now, contacts.filter((c) => c.probe === i), this.hand.wish(i), view.models);
      if (view.shown.arm && arm.now.valid) view.probes[i].setLinks(this.armModels[i].links(arm.now.joints, arm.now.position));
    });
    if (this.fitWhenTip && now.arms[0]?.now?.valid) {
      this.fitWhenTip = false;
      if (!this.hand.used) view.fit();
    }
    this.events.look(now);
    this.#showFaults(now.arms.map((arm) => arm.now?.fault ?? 0));
    this.readouts.update(now.arms.map((arm) => arm.now), now.tick.t);
    this.#markKeyed();
    $('read-depth').value = short(now.tick.depth > 0 ? now.tick.depth * 1e3 : 0);
    this.#showFoot(contacts);
    this.timeline.at(now.tick.t);
    if (this.hand.leads) $('hint').hidden = true;
  }

  /** Shows which of several arms the keys move: beside its name and by the colour of its tip. */
  #markKeyed() {
    const {keyed} = this.hand;
    this.readouts.mark(keyed);
    this.view.probes.forEach((probe, i) => probe.mark(i === keyed));
  }

  /** Shows on which instance and face the deepest contact is, if the plugin has names for them, and which arm cannot go
   * farther. */
  #showFoot(contacts) {
    const deepest = contacts.reduce((a, b) => (b.depth > (a?.depth ?? 0) ? b : a), null);
    const name = deepest ? this.features.name(this.drawings.of(deepest.model), deepest.feature) : '';
    $('foot').textContent = [name, endText(this.now.arms)].filter((text) => text !== '').join(' · ');
    $('foot').hidden = $('foot').textContent === '';
  }

  #status(status) {
    this.status = status;
    this.panel.silenced(status.silenced ?? []);
    const faults = (status.devices ?? []).filter((d) => d.fault).map((d) => `${d.name}: ${d.fault}`);
    if (this.still) return this.#lamp('wait', 'Only looked at: no arm touches it');
    if (this.hello?.recorded) return this.#lamp('good', 'Recording');
    if (!('rate_hz' in status)) return undefined;
    const p99 = status.lateness_us?.p99;
    const text = `${short(status.rate_hz)} Hz · 99 % of the ticks at most ${short(p99)} µs late · ${status.missed_ticks ?? 0} missed`;
    return faults.length > 0 ? this.#lamp(this.held ? 'held' : 'bad', faults.join(', ')) : this.#lamp('good', text);
  }

  /** Offers what there is to clear: a hold by the button that makes it, a fault by one of its own. */
  #showFaults(faults) {
    $('clear').hidden = !faults.some((fault) => fault !== 0 && fault !== kHeld);
    if (faults.includes(kHeld) === this.held) return;
    this.held = !this.held;
    $('hold').firstElementChild.textContent = this.held ? 'Clear hold' : 'Hold';
    $('hold').title = this.held ? 'Clear the hold: the force ramps in again (space)' : 'Ramp the force to zero until the hold is cleared (space)';
  }

  #lamp(state, text) {
    const [lamp, words] = $('status').children;
    lamp.dataset.state = state;
    words.textContent = text;
    words.title = text;
  }

  notice(text, calm = false) {
    if (!text) return;
    const notice = $('notice');
    notice.textContent = text;
    notice.classList.toggle('calm', calm);
    notice.hidden = false;
    clearTimeout(this.noticeTimer);
    this.noticeTimer = setTimeout(() => { notice.hidden = true; }, kNoticeMs);
  }

  async #order(request, done) {
    const answer = await this.ask(request);
    this.notice(answer.ok ? done?.(answer) : answer.error, answer.ok);
  }

  /** Handles a click on Stop: the first click asks, the second ends the run. */
  #stop() {
    const asked = this.stopTimer, calm = () => { this.stopTimer = undefined; $('stop').textContent = 'Stop'; };
    clearTimeout(asked);
    calm();
    if (asked) return this.#order({do: 'stop'});
    $('stop').textContent = 'End the run?';
    this.stopTimer = setTimeout(calm, kStopMs);
    return undefined;
  }

  holdOrClear() {
    if (this.hello?.recorded) return this.still ? undefined : this.timeline.toggle();
    if (!this.hello?.control) return this.notice('This view only looks. To change the run: hapticd view --control');
    return this.#order({do: this.held ? 'clear' : 'hold'});
  }

  #buttons() {
    $('hold').onclick = () => this.holdOrClear();
    $('clear').onclick = () => this.#order({do: 'clear'});
    $('reload').onclick = () => this.#order({do: 'reload'}, (a) => `${a.models} models loaded again`);
    $('dump').onclick = () => this.#order({do: 'dump'}, (a) => `Written: ${a.file}`);
    $('stop').onclick = () => this.#stop();
    $('theme').onclick = () => this.#theme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark', true);
    $('help').onclick = () => $('keys').showModal();
    $('fit').onclick = () => this.view?.fit();
    for (const button of document.querySelectorAll('[data-view]')) button.onclick = () => this.look(button.dataset.view);
    for (const box of document.querySelectorAll('[data-show]')) box.onchange = () => this.view?.show(box.dataset.show, box.checked);
    for (const tab of document.querySelectorAll('[role=tab]')) tab.onclick = () => this.#tab(tab);
    $('sound').onchange = (e) => this.sound.enable(e.target.checked);
    $('pick').onchange = (e) => this.plots?.pick(e.target.value);
    $('save-picture').onclick = async () => save(await this.view.picture(), 'hapticd.png');
    $('save-report').onclick = () => save(new Blob([JSON.stringify(this.report(), null, 2)], {type: 'application/json'}), 'hapticd-report.json');
    document.addEventListener('keydown', (e) => this.#key(e));
    // The space key holds the arms wherever the focus is, so only Enter presses a button.
    document.addEventListener('keyup', (e) => { if (e.key === ' ' && e.target.matches('button')) e.preventDefault(); });
  }

  #key(e) {
    if (e.target.matches(e.key === ' ' ? kTakesSpace : 'input, select, textarea') || document.querySelector('dialog[open]') || e.ctrlKey || e.metaKey || e.altKey) return;
    const keys = {' ': () => this.holdOrClear(), f: () => this.view?.fit(), 1: () => this.look('front'), 3: () => this.look('right'), 7: () => this.look('top'), '?': () => $('keys').showModal(), n: () => this.nextArm()};
    const act = keys[e.key.toLowerCase()];
    if (!act) return;
    e.preventDefault();
    act();
  }

  nextArm() {
    if (!this.hand?.possible) return;
    this.notice(`The keys move ${this.hand.next()}`, true);
    this.view.canvas.focus({preventScroll: true}); // it takes the arrows
  }

  look(name) {
    this.view?.orbit.look(name);
    if (this.view) this.view.dirty = true;
  }

  #tab(tab) {
    for (const other of document.querySelectorAll('[role=tab]')) {
      other.setAttribute('aria-selected', String(other === tab));
      $(other.getAttribute('aria-controls')).hidden = other !== tab;
    }
  }

  #theme(name, keep = false) {
    document.documentElement.dataset.theme = name;
    if (keep) localStorage.setItem('theme', name);
    const dark = name === 'dark';
    this.view?.theme({panel: themeColor('--panel'), line: themeColor('--line'), accent: themeColor('--accent'), force: themeColor('--force'), ruler: {x: themeColor('--bad'), y: themeColor('--good'), z: themeColor('--depth'), text: themeColor('--soft')}, tip: dark ? '#f2f5f8' : '#1d2730', link: dark ? '#5b6a7a' : '#c3ccd6'});
  }

  /** Returns a report of what the page shows: the status, the models and the extremes of the plots. */
  report() {
    const extremes = Object.fromEntries((this.plots?.all ?? []).map((p) => [p.root.querySelector('span').textContent, {
      unit: p.unit, min: Math.min(...p.extremes.low.filter((v) => v !== null)), max: Math.max(...p.extremes.high.filter((v) => v !== null)),
    }]));
    return {scene: this.now?.about.scene?.file, hapticd: this.now?.about.hapticd, seconds: this.now?.tick.t, status: this.status, models: this.panel.models, last_seconds: extremes};
  }
}

window.hapticdView = new Page();
