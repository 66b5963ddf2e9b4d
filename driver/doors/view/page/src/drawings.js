// SPDX-License-Identifier: MIT
/** Keeps the drawn models equal to those of the run: requests the triangles of models that come, and removes those that
 * leave. A recording lists all models that it ever had; those of the present tick are drawn. */

/** Returns how a model is named in a request. Another model may get its name when it has left; `since` tells them apart. */
const keyOf = ({name, since = 0}) => `${since}/${name}`;
/** Tells whether a model is there. A running daemon lists only those that are, and its newest rows may not have come yet. */
const isThere = (model, tick) => !('until' in model) || (model.since <= Math.max(tick, 0) && tick < (model.until ?? Infinity));
const ballOf = ({tip_radius: radius, parameters}) => radius ?? parameters?.find((p) => p.id === 'tip_radius')?.number ?? 0;

export class Drawings {
  /** @param ask function that sends a request and returns a promise of the answer @param view the scene, or null
   * @param panel is told of each drawing */
  constructor(ask, panel) {
    this.ask = ask;
    this.panel = panel;
    this.begin(null, null);
  }

  /** Forgets all models: another run begins. @param now state of the run */
  begin(view, now) {
    this.view = view;
    this.now = now;
    this.listed = [];
    this.asked = new Map(); // index -> key of the model whose triangles were requested
    view?.models.clear();
  }

  /** Takes all models of the run. */
  list(models) {
    this.listed = models.map((model, i) => ({...model, index: model.number ?? i}));
    return this.present();
  }

  /** Returns the models of the present tick. */
  present() {
    return this.listed.filter((model) => isThere(model, this.now.tick.tick));
  }

  /** Returns the model that now has this number; undefined if there is none. */
  of(index) {
    return this.present().find((model) => model.index === index);
  }

  /** True if a model came or left since the last call of draw(). */
  stale() {
    const present = this.present();
    return present.length !== this.asked.size || present.some((model) => this.asked.get(model.index) !== keyOf(model));
  }

  /** Removes the models that have left, and draws those that came. Returns true if it was one of the two, as soon as all
   * are drawn. */
  async draw() {
    const present = this.present(), {view, now} = this;
    const gone = [...this.asked].filter(([index, key]) => !present.some((model) => model.index === index && keyOf(model) === key));
    for (const [index] of gone) {
      view.models.remove(index);
      this.asked.delete(index);
    }
    const fresh = present.filter((model) => !this.asked.has(model.index));
    for (const model of fresh) this.asked.set(model.index, keyOf(model));
    view.models.balls = new Map(present.map((model) => [model.index, ballOf(model)]));
    for (const model of fresh) { // one after the other, so that few bytes wait in the server
      await this.#drawOne(model, present.length);
      if (now !== this.now) return false;
    }
    return gone.length + fresh.length > 0;
  }

  async #drawOne(model, models) {
    const {view, now} = this, {index, name, since = 0} = model;
    const answer = await this.ask({do: 'geometry', model: name, since, triangles: view.trianglesOfOne(models)});
    if (now !== this.now || this.asked.get(index) !== keyOf(model)) return;
    this.panel.drawing(name, answer);
    if (answer.mesh) view.models.add(index, {...model, pose: now.poseOf(index, model.since) ?? model.pose}, answer.mesh);
    else this.onLack?.(`${name} is not drawn: ${answer.error}`);
  }
}
