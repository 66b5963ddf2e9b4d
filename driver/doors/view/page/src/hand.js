// SPDX-License-Identifier: MIT
/** The hand of people who have no arm: the tip is dragged in the plane that faces the viewer, and onto the models that the
 * pointer is over; the wheel moves it deeper. What is sent is a wish; the simulated hand's mass and spring, and the shapes, decide what comes of it. */
import {Raycaster, Vector2, Vector3} from 'three';

const kGrabPixels = 34; // about the tip; a finger is not finer
const kStep = 0.001, kFineStep = 0.0001; // m a key
const kWheelStep = 0.0015; // m a notch
const kPress = 0.004; // m that a hand over a model wishes to be behind its surface
const kTurn = 0.06; // rad a key
const kLost = 'The connection is lost: no hand can be led until it is back';
const kAgainMs = 50; // a wish is told again so often while it is led

/** A target as the daemon takes it: f64 position[3], orientation[4], linear[3], angular[3], time; 0: when it is read. */
function targetBytes(lead, position) {
  const bytes = new ArrayBuffer(8 + 14 * 8), view = new DataView(bytes);
  view.setUint32(0, lead, true);
  [position.x, position.y, position.z, 1].forEach((value, i) => view.setFloat64(8 + 8 * i, value, true));
  return bytes;
}

export class Hand {
  #lead = null; // number of the lead
  #asking = false;
  #wish = null;
  #drag = null; // what the pointer does: {kind, x, y, ...}
  #pointers = new Map();
  #sent = 0;
  #turn = 0; // grows when a lead is given up: what was asked before counts no more

  /** @param connection to the server @param view the scene */
  constructor(connection, view) {
    this.connection = connection;
    this.view = view;
    this.arm = 0;
    this.devices = [];
    this.reaches = [];
    this.obstacle = kLost; // why nothing can be led, '' where it can
    this.used = false; // the view or the hand was moved by the user: the camera is theirs
    this.onRefused = () => {};
    const {canvas} = view;
    canvas.addEventListener('pointerdown', (e) => this.#down(e));
    canvas.addEventListener('pointermove', (e) => this.#move(e));
    for (const type of ['pointerup', 'pointercancel']) canvas.addEventListener(type, (e) => this.#up(e));
    canvas.addEventListener('wheel', (e) => this.#wheel(e), {passive: false});
    canvas.addEventListener('keydown', (e) => this.#key(e));
    canvas.addEventListener('contextmenu', (e) => e.preventDefault());
  }

  /** A run: nothing is led. @param devices names @param reaches [m] how far from the tip each hand pulls at most
   * @param obstacle why none may be led, or '' @param again the run is that of before: who still holds the tip goes on */
  begin(devices, reaches, obstacle, again = false) {
    const held = again && obstacle === '' && this.#drag?.kind === 'hand' ? this.#wish : null;
    this.lose();
    this.devices = devices;
    this.reaches = reaches;
    this.obstacle = obstacle;
    if (held) {
      this.#want(held);
      return;
    }
    this.#wish = null;
    if (this.#drag?.kind === 'hand') this.#drag = null;
    if (!again) this.arm = 0;
  }

  /** The connection is gone, and every lead with it. Returns whether a hand was led. */
  lose() {
    const led = this.#lead !== null;
    ++this.#turn;
    this.#lead = null;
    this.#asking = false;
    this.obstacle = kLost;
    if (this.#drag?.kind !== 'hand') this.#wish = null;
    return led;
  }

  /** Where the led hand of an arm wants to be, or null. */
  wish(arm) { return arm === this.arm ? this.#wish : null; }

  get possible() { return this.obstacle === ''; }
  get leads() { return this.#lead !== null; }

  #tipNear(x, y) {
    let best = null;
    this.view.probes.forEach((probe, i) => {
      if (!probe.tip.visible) return;
      for (const place of [this.wish(i), probe.tipPlace]) {
        if (!place) continue;
        const p = this.view.project(place), distance = Math.hypot(p.x - x, p.y - y);
        if (p.inFront && distance < kGrabPixels && (!best || distance < best.distance)) best = {arm: i, distance, place};
      }
    });
    return best;
  }

  /** The place under the pointer: in the plane through `through` that faces the viewer, or just behind the surface of the
   * model that the pointer is over, whichever is deeper. */
  #placeAt(x, y, through) {
    const {canvas, orbit, models} = this.view, caster = new Raycaster(), {ray} = caster;
    caster.setFromCamera(new Vector2(2 * x / canvas.clientWidth - 1, 1 - 2 * y / canvas.clientHeight), orbit.camera);
    const forward = orbit.forward(), along = ray.direction.dot(forward);
    const plane = through.clone().sub(ray.origin).dot(forward) / along;
    const [hit] = caster.intersectObjects([...models.byIndex.values()].map(({mesh}) => mesh), false);
    return ray.at(hit ? Math.max(plane, hit.distance + kPress) : plane, new Vector3());
  }

  #down(e) {
    const {canvas} = this.view;
    this.used = true;
    canvas.focus({preventScroll: true});
    canvas.setPointerCapture(e.pointerId);
    this.#pointers.set(e.pointerId, {x: e.offsetX, y: e.offsetY});
    const near = this.#pointers.size === 1 && e.button === 0 && !e.shiftKey ? this.#tipNear(e.offsetX, e.offsetY) : null;
    if (near && this.possible) {
      if (near.arm !== this.arm) this.#release(near.arm);
      const at = this.view.project(near.place);
      this.#drag = {kind: 'hand', plane: near.place.clone(), dx: at.x - e.offsetX, dy: at.y - e.offsetY};
      this.#want(near.place.clone());
      return;
    }
    if (near) this.onRefused(this.obstacle);
    const kind = this.#pointers.size > 1 ? 'pinch' : e.button === 2 || e.shiftKey ? 'pan' : 'turn';
    this.#drag = {kind, spread: this.#spread()};
  }

  #move(e) {
    const last = this.#pointers.get(e.pointerId);
    if (!last) {
      this.view.canvas.classList.toggle('on-tip', this.#tipNear(e.offsetX, e.offsetY) !== null);
      return;
    }
    const dx = e.offsetX - last.x, dy = e.offsetY - last.y;
    last.x = e.offsetX, last.y = e.offsetY;
    const {orbit, canvas} = this.view, drag = this.#drag;
    if (!drag) return;
    if (drag.kind === 'hand' && !this.possible) return; // until the connection is back
    if (drag.kind === 'hand') this.#want(this.#placeAt(e.offsetX + drag.dx, e.offsetY + drag.dy, drag.plane));
    else if (drag.kind === 'turn') orbit.turn(-dx * 0.008, -dy * 0.008);
    else if (drag.kind === 'pan') orbit.pan(dx, dy, canvas.clientHeight);
    else {
      const spread = this.#spread();
      if (drag.spread > 0 && spread > 0) orbit.zoom(drag.spread / spread);
      drag.spread = spread;
      orbit.pan(dx / 2, dy / 2, canvas.clientHeight);
    }
    this.view.dirty = true;
  }

  #spread() {
    const [a, b] = [...this.#pointers.values()];
    return a && b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  }

  #up(e) {
    this.#pointers.delete(e.pointerId);
    this.#drag = null; // the hand stays where it was led
  }

  #wheel(e) {
    e.preventDefault();
    this.used = true;
    const notches = Math.max(-3, Math.min(3, e.deltaY / 100));
    if (this.possible && this.#wish && (this.#drag?.kind === 'hand' || e.altKey)) {
      const deeper = this.view.orbit.forward().multiplyScalar(-notches * kWheelStep);
      if (this.#drag?.kind === 'hand') this.#drag.plane = this.#wish.clone().add(deeper);
      this.#want(this.#wish.clone().add(deeper));
    } else this.view.orbit.zoom(Math.exp(notches * 0.14));
    this.view.dirty = true;
  }

  #key(e) {
    const directions = {ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0], ArrowUp: [0, 1, 0], ArrowDown: [0, -1, 0], PageUp: [0, 0, 1], PageDown: [0, 0, -1]};
    const {orbit} = this.view, d = directions[e.key];
    const distance = e.key === '+' || e.key === '-' || e.key === '=';
    if (!d && !distance) return;
    this.used = true;
    if (distance) orbit.zoom(e.key === '-' ? 1.12 : 1 / 1.12);
    else if (e.shiftKey) orbit.turn(-d[0] * kTurn, -d[1] * kTurn);
    else if (!this.possible) this.onRefused(this.obstacle);
    else {
      const step = e.ctrlKey ? kFineStep : kStep, from = this.#wish ?? this.view.probes[this.arm]?.tipPlace;
      if (!from) return;
      this.#want(from.clone().addScaledVector(orbit.right(), d[0] * step).addScaledVector(orbit.up(), d[1] * step).addScaledVector(orbit.forward(), d[2] * step));
    }
    e.preventDefault();
    this.view.dirty = true;
  }

  /** The keys move the next arm from now on. Returns its name. */
  next() {
    if (this.devices.length > 1) this.#release((this.arm + 1) % this.devices.length);
    return this.devices[this.arm];
  }

  #release(arm) {
    if (this.#lead !== null) this.connection.ask({do: 'unlead', lead: this.#lead});
    ++this.#turn;
    this.#lead = this.#wish = null;
    this.#asking = false;
    this.arm = arm;
  }

  /** The hand is to be there. The first wish asks for the lead. */
  async #want(place) {
    this.#wish = place;
    this.#send();
    if (this.#lead !== null || this.#asking) return;
    this.#asking = true;
    const turn = this.#turn, answer = await this.connection.ask({do: 'lead', hand: this.devices[this.arm]});
    if (turn !== this.#turn) { // meant for a hand that is not wanted any more
      if (answer.ok) this.connection.ask({do: 'unlead', lead: answer.lead});
      return;
    }
    this.#asking = false;
    if (answer.ok) {
      this.#lead = answer.lead;
      this.#send();
      return;
    }
    this.#wish = this.#drag = null;
    this.view.dirty = true;
    this.onRefused(answer.error);
  }

  #send() {
    if (this.#lead === null || !this.#wish) return;
    this.connection.put(targetBytes(this.#lead, this.#pulled()));
    this.#sent = performance.now();
  }

  /** A hand that is stronger than the arm would push the tip through every wall: it pulls no harder than the arm does. */
  #pulled() {
    const tip = this.view.probes[this.arm]?.tipPlace, reach = this.reaches[this.arm];
    if (!tip || !this.#beyond()) return this.#wish;
    return tip.clone().addScaledVector(this.#wish.clone().sub(tip).normalize(), reach);
  }

  #beyond() { return this.#wish !== null && this.#wish.distanceTo(this.view.probes[this.arm].tipPlace) > this.reaches[this.arm]; }

  /** Called each frame: what may have been lost is told again, and a hand that is far behind is pulled on. */
  look(now) {
    if (this.#lead !== null && (now - this.#sent > kAgainMs || this.#beyond())) this.#send();
  }
}
