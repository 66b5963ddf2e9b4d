// SPDX-License-Identifier: MIT
/** Plays short sounds of clicks, contacts and faults, if the user switches them on. */

const kSounds = {click: {hertz: 2100, seconds: 0.025, loud: 0.35}, contact: {hertz: 420, seconds: 0.06, loud: 0.18}, fault: {hertz: 190, seconds: 0.3, loud: 0.25}};

export class Sound {
  on = false;
  #context = null;

  /** Switches the sounds on or off. Call it from a click or a key of the user, because browsers keep pages silent
   * before. */
  enable(on) {
    this.on = on;
    if (on) this.#context ??= new AudioContext();
  }

  play(kind) {
    const sound = kSounds[kind];
    if (!this.on || !sound) return;
    const {currentTime: now} = this.#context, tone = this.#context.createOscillator(), gain = this.#context.createGain();
    tone.type = kind === 'click' ? 'square' : 'sine';
    tone.frequency.value = sound.hertz;
    gain.gain.setValueAtTime(sound.loud, now);
    gain.gain.exponentialRampToValueAtTime(0.001, now + sound.seconds);
    tone.connect(gain).connect(this.#context.destination);
    tone.start(now);
    tone.stop(now + sound.seconds);
  }
}
