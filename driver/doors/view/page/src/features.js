// SPDX-License-Identifier: MIT
/** What the features of contacts are called, asked for once each: of a part, instance and face. */

const kMostKept = 4096;

export class Features {
  /** @param ask sends a request and promises the answer */
  constructor(ask) {
    this.ask = ask;
    this.clear();
  }

  /** The models are others now. */
  clear() {
    this.names = new Map(); // "model/feature" -> name; '' until it is known
    this.nameless = new Set(); // models whose plugin has no names
  }

  /** @returns '' where it has no name, or none yet */
  name(model, feature) {
    const key = `${model}/${feature}`, {names, nameless} = this, known = names.get(key);
    if (known !== undefined || model === undefined || nameless.has(model)) return known ?? '';
    if (names.size >= kMostKept) names.clear();
    names.set(key, '');
    this.ask({do: 'feature', model, number: feature}).then((answer) => {
      if (answer.name) names.set(key, answer.name);
      else nameless.add(model);
    }, () => nameless.add(model));
    return '';
  }
}
