// SPDX-License-Identifier: MIT
/** Computes where the links of an arm are, from the description of its mechanism and its joint positions. It knows the
 * PHANToM's parallelogram, the delta and serial chains, as devices/support/kinematics does. For any other mechanism no
 * links are drawn. Vectors are in the device frame; ArmModel converts the results to the world. */
import {Matrix4, Quaternion, Vector3} from 'three';

/** The words of the parameter arm.kind, by module. The index of a word is the value of the parameter. */
const kKinds = {simulated: ['phantom', 'chain', 'phantom', 'delta'], usb_hid: ['phantom', 'delta', 'chain'], usb_bulk: ['phantom', 'delta', 'chain'], vme: ['phantom', 'delta', 'chain']};
const kPhantomLengths = [0.215, 0.17, 0.0325]; // m: upper arm, forearm, short side (Cavusoglu et al. 2002)
const kOpening = 55 * Math.PI / 180, kClosing = 65 * Math.PI / 180; // rad: limits of the angle between the PHANToM's links
const kDelta = {lengths: [0.06, 0.1025, 0.01443, 0.01125, 0.01125, -0.025, 0.04, -0.02309], angles: [105, -15, -135].map((a) => a * Math.PI / 180)};
const kFar = 0.0005; // m: if the computed tip is farther from the recorded one, the mechanism is another one
const kFarBehind = 0.03; // m: same with compliance control, where the rows hold the virtual mass that the arm follows
const kSamples = 4000; // number of poses from which the box of the workspace is computed
const kPlaces = 40000; // number of places about a delta from which it is computed; it reaches few of them

const vector = (list) => new Vector3(...(list ?? [0, 0, 0]));

/** Returns a frame at a position, with an orientation w, x, y, z; either may be left out. */
function frameAt(position, orientation) {
  const [w, x, y, z] = orientation ?? [1, 0, 0, 0];
  return new Matrix4().compose(vector(position), new Quaternion(x, y, z, w).normalize(), new Vector3(1, 1, 1));
}

function parametersOf(device) {
  const all = new Map((device.parameters ?? []).map((p) => [p.id, p]));
  return {
    list: (id) => { const numbers = all.get(id)?.numbers ?? []; return numbers.length > 0 ? numbers.map(Number) : null; },
    number: (id) => Number(all.get(id)?.number ?? 0),
  };
}

const kPointed = true;

/** Makes a link between two places, with a radius [m]. A pointed link becomes thinner toward its end. */
const link = (from, to, radius, pointed = false) => ({from, to, radius, pointed});

class Phantom {
  constructor(of) {
    const given = of.list('arm.lengths') ?? kPhantomLengths;
    [this.upper, this.fore, this.short] = given;
    this.shoulder = vector(of.list('arm.origin')).add(new Vector3(0, this.fore, -this.upper));
  }

  #out(q1, reach, height) { return new Vector3(reach * Math.sin(q1), height, reach * Math.cos(q1)); }

  /** Returns the elbow, the tip, and the direction from the elbow to the tip. */
  #places([q1, q2, q3]) {
    const elbow = this.shoulder.clone().add(this.#out(q1, this.upper * Math.cos(q2), this.upper * Math.sin(q2)));
    const along = this.#out(q1, Math.sin(q3), -Math.cos(q3));
    return {elbow, along, tip: elbow.clone().addScaledVector(along, this.fore)};
  }

  tip(q) { return this.#places(q).tip; }

  links(q) {
    const shoulder = this.shoulder.clone(), thick = 0.02 * this.upper, {elbow, along, tip} = this.#places(q);
    const links = [
      link(shoulder.clone().add(new Vector3(0, -0.35 * this.upper, 0)), shoulder, 1.9 * thick),
      link(shoulder, elbow, thick), link(elbow, tip, 0.8 * thick, kPointed),
    ];
    if (this.short > 0) { // draws the crank that drives the forearm, and its rod
      const crank = shoulder.clone().addScaledVector(along, -this.short), end = elbow.clone().addScaledVector(along, -this.short);
      links.push(link(shoulder, crank, 0.6 * thick), link(crank, end, 0.45 * thick), link(end, elbow, 0.75 * thick));
    }
    return links;
  }

  allowed([, q2, q3]) { return q3 - q2 <= kOpening && q2 - q3 <= kClosing; }
}

class Chain {
  constructor(of) {
    const dh = of.list('arm.dh') ?? [];
    this.rows = Array.from({length: Math.floor(dh.length / 4)}, (_, i) => dh.slice(4 * i, 4 * i + 4));
    this.base = frameAt(of.list('arm.base_position') ?? of.list('arm.origin'), of.list('arm.base_orientation'));
    this.tool = vector(of.list('arm.tool_position'));
  }

  /** Returns the frame before the first joint, and the frame after each joint. */
  #frames(q) {
    const frames = [this.base.clone()];
    this.rows.forEach(([a, alpha, d, theta], i) => {
      const turn = theta + (q[i] ?? 0);
      const step = new Matrix4().makeRotationZ(turn).multiply(new Matrix4().makeTranslation(a, 0, d)).multiply(new Matrix4().makeRotationX(alpha));
      frames.push(frames[i].clone().multiply(step));
    });
    return frames;
  }

  tip(q) { return this.tool.clone().applyMatrix4(this.#frames(q).at(-1)); }

  links(q) {
    const frames = this.#frames(q), places = frames.map((f) => new Vector3().setFromMatrixPosition(f)), links = [];
    let from = places[0];
    for (const to of places.slice(1)) {
      if (to.distanceTo(from) < 1e-4) continue; // the axes meet in one point, so there is no link between them
      links.push(link(from, to, 0.055 * to.distanceTo(from)));
      from = to;
    }
    const last = frames.length - 1, tip = this.tool.clone().applyMatrix4(frames[last]);
    const finger = last > 1 && this.tool.length() > 1e-3 && places[last].distanceTo(places[last - 1]) < 1e-4;
    return [...links, ...(finger ? this.#hand(frames[last - 1], frames[last]) : [link(from, tip, 0.06 * tip.distanceTo(from), kPointed)])];
  }

  /** Draws a hand, for an arm whose last joint turns in place: this joint moves a finger. The palm and the thumb do not
   * move with it. */
  #hand(palm, finger) {
    const size = this.tool.length(), along = this.tool, across = new Vector3(-along.y, along.x, 0).setLength(size);
    if (!(across.length() > 0)) across.set(0, size, 0);
    const at = (frame, far, aside) => along.clone().multiplyScalar(far).addScaledVector(across, aside).applyMatrix4(frame);
    return [
      link(at(palm, 0, 0), at(palm, 0.45, 0), 0.17 * size), link(at(finger, 0.45, 0), at(finger, 1, 0), 0.085 * size, kPointed),
      link(at(palm, 0.25, -0.1), at(palm, 0.6, -0.42), 0.08 * size), link(at(palm, 0.6, -0.42), at(palm, 0.95, -0.3), 0.08 * size, kPointed),
    ];
  }
}

class Delta {
  constructor(of) {
    const [a, b, c, d, e, f, r, s] = of.list('arm.lengths') ?? kDelta.lengths;
    Object.assign(this, {a, b, c, d, e, f, r, s});
    this.angles = of.list('arm.angles') ?? kDelta.angles;
    this.base = frameAt(of.list('arm.origin'), of.list('arm.base_orientation'));
    this.toArm = this.base.clone().invert();
  }

  tip() { return null; } // not computed: a delta has a closed form only for the inverse, and the row holds the tip

  /** Returns a place where the tip may be, if all joints are within their limits; else null. @param chance gives numbers from 0 to 1 */
  reach(chance, low, high) {
    const far = this.a + this.b + this.d + this.e, p = new Vector3(chance() - 0.5, chance() - 0.5, chance() / 2).multiplyScalar(2 * far);
    const meets = this.angles.every((phi, i) => {
      const u = p.x * Math.cos(phi) + p.y * Math.sin(phi) - this.r + this.c, v = -p.x * Math.sin(phi) + p.y * Math.cos(phi) - this.s - this.f;
      const long = this.d + this.e + Math.sqrt(this.b * this.b - v * v), away = Math.hypot(u, p.z);
      const theta = Math.atan2(p.z, u) - Math.acos((away * away + this.a * this.a - long * long) / (2 * this.a * away)); // NaN out of reach
      return theta >= low[i] && theta <= high[i];
    });
    return meets ? p.applyMatrix4(this.base) : null;
  }

  links(q, row) {
    const p = row.clone().applyMatrix4(this.toArm), thick = 0.07 * this.a, tip = row.clone(), links = [];
    this.angles.forEach((phi, i) => {
      const out = new Vector3(Math.cos(phi), Math.sin(phi), 0), aside = new Vector3(-Math.sin(phi), Math.cos(phi), 0);
      const place = (u, v, z) => out.clone().multiplyScalar(u).addScaledVector(aside, v).setZ(z).applyMatrix4(this.base);
      const hinge = place(this.r, this.s, 0), elbow = place(this.r + this.a * Math.cos(q[i]), this.s, this.a * Math.sin(q[i]));
      const end = place(p.dot(out) + this.c, p.dot(aside) - this.f, p.z);
      links.push(link(place(0, 0, 0), hinge, 1.4 * thick), link(hinge, elbow, thick), link(elbow, end, 0.6 * thick), link(end, tip, thick, kPointed));
    });
    return links;
  }
}

export class ArmModel {
  /** @param device description of the device, from the scene in `about` @param info what the opened device reports
   * (hdv_info) */
  constructor(device, info) {
    const of = parametersOf(device), kind = kKinds[device?.module]?.[of.number('arm.kind')];
    this.mechanism = kind === 'phantom' ? new Phantom(of) : kind === 'chain' ? new Chain(of) : kind === 'delta' ? new Delta(of) : null;
    this.mount = frameAt(device?.mount?.position, device?.mount?.orientation);
    this.toDevice = this.mount.clone().invert();
    this.info = info ?? {};
    this.far = device?.admittance ? kFarBehind : kFar;
  }

  /** Returns the links in the world frame. Returns none if they would not end at the tip of the row. */
  links(joints, position) {
    if (!this.mechanism) return [];
    const row = vector(position).applyMatrix4(this.toDevice), tip = this.mechanism.tip(joints);
    if (tip && !(tip.distanceTo(row) < this.far)) return [];
    const links = this.mechanism.links(joints, row);
    for (const place of new Set(links.flatMap((l) => [l.from, l.to]))) place.applyMatrix4(this.mount);
    return links;
  }

  /** Returns the box {min, max} in the world frame that contains every place that the tip can reach, or null if it is
   * unknown. */
  workspace() {
    const {joint_count: count, position_min: low, position_max: high} = this.info;
    if (!this.mechanism || !count) return null;
    const min = new Vector3(Infinity, Infinity, Infinity), max = min.clone().negate();
    let seed = 1;
    const chance = () => (seed = seed * 48271 % 0x7fffffff) / 0x7fffffff;
    for (let sample = 0; sample < (this.mechanism.reach ? kPlaces : kSamples); ++sample) {
      const tip = this.mechanism.reach ? this.mechanism.reach(chance, low, high) : this.#tipOf(chance, low, high);
      if (!tip) continue;
      tip.applyMatrix4(this.mount);
      min.min(tip), max.max(tip);
    }
    return min.x < max.x ? {min, max} : null;
  }

  /** Returns the tip in a pose by chance, or null if the arm cannot have it. The tip is farthest out when joints are at
   * their limits, so half of the joints are placed at a limit. */
  #tipOf(chance, low, high) {
    const between = (i) => Number(low[i]) + (Number(high[i]) - Number(low[i])) * (chance() < 0.5 ? Math.round(chance()) : chance());
    const q = Array.from({length: this.info.joint_count}, (_, i) => between(i));
    return q.every(Number.isFinite) && this.mechanism.allowed?.(q) !== false ? this.mechanism.tip(q) : null;
  }
}
