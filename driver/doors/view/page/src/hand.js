// SPDX-License-Identifier: MIT
/** Leads the hand of a simulated arm, for people who have no arm. The user drags the tip in the plane that faces the
 * viewer, and onto the models under the pointer; the wheel moves it deeper. Only the wanted position (the wish) is
 * sent. The mass and spring of the simulated hand, and the shapes, decide how the tip moves. */
import {Raycaster, Vector2, Vector3} from 'three';

const kGrabPixels = 34; // radius about the tip in which it can be grabbed, wide enough for a finger
const kStep = 0.001, kFineStep = 0.0001; // m per press of a key
const kWheelStep = 0.0015; // m per notch of the wheel
const kPress = 0.004; // m: depth of the wish behind the surface of the model under the pointer
const kTurn = 0.06; // rad per press of a key
const kLost = 'The connection is lost: no hand can be led until it is back';
const kHandStiffness = 500; // N/m: stiffness of the hand if the device file gives none
const kShareOfLimit = 0.8; // the hand pulls with at most this share of the arm's largest force, so that shapes can keep the tip outside
const kAgainMs = 50; // the wish is sent again after this time while the hand is led

/** Returns the largest force [N] that an arm may get, or null if it is unknown. */
export function greatestForce(about, arm) {
  const bounds = [about.scene?.devices?.[arm]?.limits?.force, about.devices?.[arm]?.info?.max_force].map(Number).filter((force) => force > 0);
  return bounds.length > 0 ? Math.min(...bounds) : null;
}

/** Returns how far [m] the spring of a simulated hand stretches under the force that the arm can hold against. */
export function handReach(device, limit) {
  const stiffness = Number(device?.parameters?.find((p) => p.id === 'hand.stiffness')?.number ?? kHandStiffness);
  return limit > 0 && stiffness > 0 ? kShareOfLimit * limit / stiffness : Infinity;
}

/** Makes the message with a target in the daemon's form: f64 position[3], orientation[4], linear[3], angular[3], time.
 * The time 0 means: when the daemon reads it. */
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
  #drag = null; // what the pointer does now: {kind, ...}
  #pointers = new Map();
  #sent = 0;
  #turn = 0; // grows when a lead is given up, so that later answers to earlier requests are ignored

  /** @param connection connection to the server @param view view of the scene */
  constructor(connection, view) {
    this.connection = connection;
    this.view = view;
    this.arm = 0;
    this.devices = [];
    this.reaches = [];
    this.obstacle = kLost; // why no hand can be led; '' if one can be led
    this.used = false; // true after the user has moved the view or the hand: the camera no longer moves by itself
    this.onRefused = () => {};
    const {canvas} = view;
    canvas.addEventListener('pointerdown', (e) => this.#down(e));
    canvas.addEventListener('pointermove', (e) => this.#move(e));
    for (const type of ['pointerup', 'pointercancel']) canvas.addEventListener(type, (e) => this.#up(e));
    canvas.addEventListener('wheel', (e) => this.#wheel(e), {passive: false});
    canvas.addEventListener('keydown', (e) => this.#key(e));
    canvas.addEventListener('contextmenu', (e) => e.preventDefault());
  }

  /** Called when a run was found. No hand is led then. @param devices names of the devices @param reaches [m] largest
   * distance of each hand's wish from the tip @param obstacle why no hand may be led, or '' @param again true if it is
   * the same run as before: a drag that still lasts goes on */
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

  /** Called when the connection was lost, which ends every lead. Returns true if a hand was led. */
  lose() {
    const led = this.#lead !== null;
    ++this.#turn;
    this.#lead = null;
    this.#asking = false;
    this.obstacle = kLost;
    if (this.#drag?.kind !== 'hand') this.#wish = null;
    return led;
  }

  /** Returns the wanted position of the hand of an arm, or null if the hand is not led. */
  wish(arm) { return arm === this.arm ? this.#wish : null; }

  get possible() { return this.obstacle === ''; }
  get leads() { return this.#lead !== null; }
  /** The arm that the keys move, where several could be meant; else -1. */
  get keyed() { return this.possible && this.devices.length > 1 ? this.arm : -1; }

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

  /** Returns the place under the pointer. It is in the plane through `through` that faces the viewer, or just behind
   * the surface of the model under the pointer, whichever is deeper; a ball touches it by its radius earlier. */
  #placeAt(x, y, through) {
    const {canvas, orbit, models} = this.view, caster = new Raycaster(), {ray} = caster;
    caster.setFromCamera(new Vector2(2 * x / canvas.clientWidth - 1, 1 - 2 * y / canvas.clientHeight), orbit.camera);
    const forward = orbit.forward(), along = ray.direction.dot(forward);
    const plane = through.clone().sub(ray.origin).dot(forward) / along;
    const [hit] = caster.intersectObjects([...models.byIndex.values()].map(({mesh}) => mesh), false);
    if (!hit) return ray.at(plane, new Vector3());
    const [model] = [...models.byIndex].find(([, {mesh}]) => mesh === hit.object);
    return ray.at(Math.max(plane, hit.distance + kPress - models.ball(model)), new Vector3());
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
    if (drag.kind === 'hand' && !this.possible) return; // waits until the connection is back
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

  /** From now on the keys move the next arm. Returns its name. */
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

  /** Sets the wanted position of the hand. The first call asks for the lead. */
  async #want(place) {
    this.#wish = place;
    this.#send();
    if (this.#lead !== null || this.#asking) return;
    this.#asking = true;
    const turn = this.#turn, answer = await this.connection.ask({do: 'lead', hand: this.devices[this.arm]});
    if (turn !== this.#turn) { // the hand was given up before this answer came
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

  /** Returns the wish, but not farther from the tip than the arm can hold against. A stronger hand would push the tip
   * through every wall. */
  #pulled() {
    const tip = this.view.probes[this.arm]?.tipPlace, reach = this.reaches[this.arm];
    if (!tip || !this.#beyond()) return this.#wish;
    return tip.clone().addScaledVector(this.#wish.clone().sub(tip).normalize(), reach);
  }

  #beyond() { return this.#wish !== null && this.#wish.distanceTo(this.view.probes[this.arm].tipPlace) > this.reaches[this.arm]; }

  /** Called in each frame. Sends the wish again in case a message was lost, and while the tip is far behind the wish. */
  look(now) {
    if (this.#lead !== null && (now - this.#sent > kAgainMs || this.#beyond())) this.#send();
  }
}
