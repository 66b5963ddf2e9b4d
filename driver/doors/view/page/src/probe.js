// SPDX-License-Identifier: MIT
/** Draws one arm in the scene: its tip, the foot point and the normal there, an arrow for the force, the wanted
 * position of a led hand (the ghost), and the links. */
import {BufferAttribute, BufferGeometry, ConeGeometry, CylinderGeometry, DoubleSide, Group, Line, LineBasicMaterial, Mesh,
  MeshBasicMaterial, MeshLambertMaterial, RingGeometry, SphereGeometry, Vector3} from 'three';
import {norm} from './format.js';

const kMetresPerNewton = 0.012; // length of the force arrow for a tip of kUsualTip; the arrow grows with the tip
const kUsualTip = 0.0035; // m: usual radius of the drawn tip
const kSmallForce = 0.02; // N: a smaller force has no arrow
const kUp = new Vector3(0, 1, 0), kForward = new Vector3(0, 0, 1);

/** Places a cylinder of height 1 so that it reaches from one point to another. */
function span(mesh, from, to, radius) {
  const along = to.clone().sub(from), length = along.length();
  mesh.visible = length > 1e-6;
  if (!mesh.visible) return;
  mesh.position.copy(from).addScaledVector(along, 0.5);
  mesh.quaternion.setFromUnitVectors(kUp, along.divideScalar(length));
  mesh.scale.set(radius, length, radius);
}

function segment() {
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
  const line = new Line(geometry, new LineBasicMaterial());
  line.frustumCulled = false;
  return line;
}

function setSegment(line, from, to) {
  const position = line.geometry.getAttribute('position');
  position.setXYZ(0, from.x, from.y, from.z);
  position.setXYZ(1, to.x, to.y, to.z);
  position.needsUpdate = true;
}

export class Probe {
  constructor() {
    this.group = new Group();
    this.tip = new Mesh(new SphereGeometry(1, 20, 14), new MeshLambertMaterial());
    this.ghost = new Mesh(new SphereGeometry(1, 16, 12), new MeshBasicMaterial({transparent: true, opacity: 0.35, depthWrite: false}));
    this.tether = segment();
    this.foot = new Mesh(new RingGeometry(0.72, 1, 28), new MeshBasicMaterial({side: DoubleSide, depthTest: false, transparent: true}));
    this.normal = segment();
    this.shaft = new Mesh(new CylinderGeometry(1, 1, 1, 14), new MeshBasicMaterial({depthTest: false, transparent: true}));
    this.head = new Mesh(new ConeGeometry(1, 1, 18), this.shaft.material);
    for (const over of [this.foot, this.shaft, this.head]) over.renderOrder = 2;
    this.arm = new Group();
    this.links = [];
    this.point = new CylinderGeometry(0.4, 1, 1, 14);
    this.linkMaterial = new MeshLambertMaterial();
    this.group.add(this.tip, this.ghost, this.tether, this.foot, this.normal, this.shaft, this.head, this.arm);
    this.ghost.visible = this.tether.visible = this.tip.visible = false;
    this.tipPlace = new Vector3();
    this.showForce = true;
    this.keyed = false;
    this.ball = 0; // m: radius of the ball that is drawn
    this.resize(kUsualTip);
  }

  /** Sets the size of the tip. @param size [m] radius of the drawn tip if it is a point */
  resize(size) {
    this.size = size;
    this.foot.scale.setScalar(size * 1.4);
  }

  /** Draws the tip as the ball that touches the nearest model; with none near, as the largest one. */
  #ball(best, models) {
    this.ball = best ? models.ball(best.model) : Math.max(0, ...models.balls.values());
    this.tip.scale.setScalar(this.ball || this.size);
    this.ghost.scale.setScalar((this.ball || this.size) * 1.3);
  }

  colors({tip, accent, force, link}) {
    this.tipColors = {true: accent, false: tip};
    this.mark(this.keyed);
    this.linkMaterial.color.set(link);
    for (const part of [this.ghost, this.tether, this.foot, this.normal]) part.material.color.set(accent);
    this.shaft.material.color.set(force);
  }

  /** Draws the tip in the colour of what is led, or in its own. @param keyed whether the keys move this arm */
  mark(keyed) {
    this.keyed = keyed;
    if (this.tipColors) this.tip.material.color.set(this.tipColors[keyed]);
  }

  /** Draws the present state. @param now newest state of the arm @param contacts contacts of this probe @param wish
   * wanted position of the led hand, or null @param models those of the scene */
  update(now, contacts, wish, models) {
    this.tip.visible = now.valid;
    this.tipPlace.set(...now.position);
    const best = contacts.reduce((a, b) => (!a || b.depth > a.depth ? b : a), null);
    this.#ball(best, models);
    // The felt surface of a ball is that of its centre: the foot point is the centre of the ball that a rigid model keeps out.
    const kept = this.ball && best?.depth > 0 && !models.deforms(best.model);
    if (now.valid) this.tip.position.set(...(kept ? best.point : now.position));
    this.#force(new Vector3(...now.sent));
    this.#foot(best);
    this.ghost.visible = this.tether.visible = wish !== null;
    if (!wish) return;
    this.ghost.position.copy(wish);
    setSegment(this.tether, this.tipPlace, wish);
  }

  #force(force) {
    const size = force.length(), visible = this.showForce && size > kSmallForce;
    this.shaft.visible = this.head.visible = visible;
    if (!visible) return;
    const direction = force.clone().divideScalar(size);
    const length = this.ball + this.size * (1.2 + size * kMetresPerNewton / kUsualTip), head = Math.min(length * 0.45, this.size * 2.4);
    const neck = this.tip.position.clone().addScaledVector(direction, length - head);
    span(this.shaft, this.tip.position, neck, this.size * 0.28);
    this.head.position.copy(neck).addScaledVector(direction, head / 2);
    this.head.quaternion.setFromUnitVectors(kUp, direction);
    this.head.scale.set(this.size * 0.72, head, this.size * 0.72);
  }

  /** Draws the foot point with the greatest depth; outside of contact this is the nearest one. */
  #foot(best) {
    const near = best !== null && best.depth > -12 * this.size && norm(best.normal) > 0.5;
    this.foot.visible = this.normal.visible = near && this.showForce;
    if (!near) return;
    const normal = new Vector3(...best.normal).normalize(), point = new Vector3(...best.point).addScaledVector(normal, -this.ball);
    this.foot.position.copy(point).addScaledVector(normal, this.size * 0.06);
    this.foot.quaternion.setFromUnitVectors(kForward, normal);
    setSegment(this.normal, point, point.clone().addScaledVector(normal, this.size * 5));
  }

  /** Draws the links of the arm, {from, to, radius, pointed} in the world, with a joint at the beginning of each. */
  setLinks(links) {
    links.forEach((link, i) => this.#link(i, link));
    for (const {bar, joint} of this.links.slice(links.length)) bar.visible = joint.visible = false;
  }

  #link(index, {from, to, radius, pointed}) {
    if (index === this.links.length) {
      const bar = new Mesh(this.shaft.geometry, this.linkMaterial), joint = new Mesh(this.tip.geometry, this.linkMaterial);
      this.arm.add(bar, joint);
      this.links.push({bar, joint});
    }
    const {bar, joint} = this.links[index];
    bar.geometry = pointed ? this.point : this.shaft.geometry;
    span(bar, from, to, radius);
    joint.visible = bar.visible;
    joint.position.copy(from);
    joint.scale.setScalar(radius * 1.3);
  }
}
