// SPDX-License-Identifier: MIT
/** Time of a recording: play, pause, place, speed, loop. */

const $ = (id) => document.getElementById(id);

export class Timeline {
  constructor(ask) {
    this.ask = ask;
    this.state = null;
    this.mode = {playing: true, speed: 1, loop: true}; // as it was asked for
    this.held = false; // the slider is in somebody's hand
    const seek = $('seek');
    $('play').onclick = () => this.toggle();
    seek.addEventListener('pointerdown', () => { this.held = true; });
    for (const type of ['pointerup', 'change']) seek.addEventListener(type, () => { this.held = false; });
    seek.oninput = () => this.#seek(Number(seek.value));
    $('speed').onchange = () => this.#play();
    $('loop').onchange = () => this.#play();
  }

  toggle() {
    if (!this.state?.playing) return this.#play();
    this.mode.playing = false;
    return this.ask({do: 'pause'});
  }

  #play() {
    this.mode = {playing: true, speed: Number($('speed').value), loop: $('loop').checked};
    return this.ask({do: 'play', speed: this.mode.speed, loop: this.mode.loop});
  }

  /** A new connection begins the recording anew: goes on as it was with the one before. */
  async restore() {
    const {playing, speed, loop} = this.mode, t = Number($('seek').value);
    await this.ask({do: 'play', speed, loop});
    if (!playing) await this.ask({do: 'pause'});
    await this.ask({do: 'seek', t}); // last: it went on meanwhile
  }

  /** One seek at a time is under way; the last that was asked for meanwhile follows. */
  async #seek(t) {
    this.wanted = t;
    if (this.seeking) return;
    this.seeking = true;
    while (this.wanted !== null) {
      const next = this.wanted;
      this.wanted = null;
      await this.ask({do: 'seek', t: next});
    }
    this.seeking = false;
  }

  /** @param state {from, to, t, playing, speed, loop}, or null: of a daemon */
  show(state) {
    this.state = state;
    $('timeline').hidden = state === null;
    if (!state) return;
    Object.assign($('seek'), {min: state.from, max: state.to, step: Math.max((state.to - state.from) / 20000, 1e-4)});
    $('play').textContent = state.playing ? '❚❚' : '▶';
    $('loop').checked = state.loop;
    this.at(state.t);
  }

  /** The time of the newest row. */
  at(t) {
    if (!this.state || !Number.isFinite(t)) return;
    if (!this.held) $('seek').value = t;
    $('seek-time').textContent = `${t.toFixed(2)} s`;
  }
}
