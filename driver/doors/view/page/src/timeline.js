// SPDX-License-Identifier: MIT
/** The controls for the playback of a recording: play, pause, place, speed, loop. */
import {$} from './format.js';

export class Timeline {
  constructor(ask) {
    this.ask = ask;
    this.state = null;
    this.mode = {playing: true, speed: 1, loop: true}; // what the user asked for last
    this.held = false; // true while the user drags the slider
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

  /** Restores the playback after the connection was lost, because a new connection begins at the start of the
   * recording. */
  async restore() {
    const {playing, speed, loop} = this.mode, t = Number($('seek').value);
    await this.ask({do: 'play', speed, loop});
    if (!playing) await this.ask({do: 'pause'});
    await this.ask({do: 'seek', t}); // sent last, because the playback went on meanwhile
  }

  /** Seeks to a time. Only one request is sent at a time; after its answer, the newest time that was wanted meanwhile
   * is requested. */
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

  /** Shows the state of the playback. @param state {from, to, t, playing, speed, loop}, or null for a running daemon */
  show(state) {
    this.state = state;
    $('timeline').hidden = state === null;
    if (!state) return;
    Object.assign($('seek'), {min: state.from, max: state.to, step: Math.max((state.to - state.from) / 20000, 1e-4)});
    $('play').textContent = state.playing ? '❚❚' : '▶';
    $('loop').checked = state.loop;
    this.at(state.t);
  }

  /** Shows the time of the newest row. */
  at(t) {
    if (!this.state || !Number.isFinite(t)) return;
    if (!this.held) $('seek').value = t;
    $('seek-time').textContent = `${t.toFixed(2)} s`;
  }
}
