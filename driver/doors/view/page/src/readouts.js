// SPDX-License-Identifier: MIT
/** The numbers of each arm: its force and the speed of its tip; and which arm the keys move. */
import {element, norm, short} from './format.js';

const kSpeedSpan = 0.02; // s between the positions that give a speed

export class Readouts {
  /** @param root the list that they are put into, before its other entries */
  constructor(root, names) {
    for (const old of root.querySelectorAll('.of-arm')) old.remove();
    this.arms = names.map(() => ({keys: element('kbd', {hidden: true}, 'keys'), force: element('output', {title: 'Force'}, '–'), speed: element('output', {title: 'Speed of the tip'}, '–'), before: null}));
    const entry = (name, marks, ...parts) => element('div', {class: 'of-arm'}, element('dt', {title: name}, ...marks, name), element('dd', {}, ...parts));
    const force = (arm) => [arm.force, element('small', {}, 'N')], speed = (arm) => [arm.speed, element('small', {}, 'mm/s')];
    root.prepend(...this.arms.flatMap((arm, i) => names.length > 1 ? [entry(names[i], [arm.keys], ...force(arm), ...speed(arm))]
      : [entry('Force', [], ...force(arm)), entry('Speed', [], ...speed(arm))]));
  }

  /** Marks the arm that the keys move. @param keyed its index, or -1 */
  mark(keyed) { this.arms.forEach(({keys}, i) => { keys.hidden = i !== keyed; }); }

  /** @param rows the newest row of each arm, or undefined */
  update(rows, t) {
    rows.forEach((row, i) => {
      this.arms[i].force.value = short(row ? norm(row.sent) : NaN);
      if (row) this.#speed(this.arms[i], row.position, t);
    });
  }

  /** The speed is computed from positions, because the daemon estimates a velocity only if a model needs one. */
  #speed(arm, position, t) {
    const {before} = arm;
    if (before && t - before.t <= kSpeedSpan && t >= before.t) return;
    const moved = before && t > before.t ? norm(position.map((p, k) => p - before.position[k])) / (t - before.t) : 0;
    arm.before = {t, position};
    arm.speed.value = short(moved * 1e3);
  }
}
