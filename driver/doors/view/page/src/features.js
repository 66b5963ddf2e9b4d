// SPDX-License-Identifier: MIT
/** The names of the features of contacts; for a part, a name consists of instance and face. Each name is requested
 * once. */

const kMostKept = 4096;

export class Features {
  /** @param ask function that sends a request and returns a promise of the answer */
  constructor(ask) {
    this.ask = ask;
    this.clear();
  }

  /** Forgets all names, because the models have changed. */
  clear() {
    this.names = new Map(); // "model/feature" -> name; '' until it is known
    this.nameless = new Set(); // models whose plugin has no names
  }

  /** Returns the name of a feature of a model; '' if it has no name, or if the name has not come yet. */
  name({name: model, since = 0} = {}, feature) {
    const key = `${model}/${feature}`, {names, nameless} = this, known = names.get(key);
    if (known !== undefined || model === undefined || nameless.has(model)) return known ?? '';
    if (names.size >= kMostKept) names.clear();
    names.set(key, '');
    this.ask({do: 'feature', model, since, number: feature}).then((answer) => {
      if (answer.name) names.set(key, answer.name);
      else nameless.add(model);
    }, () => nameless.add(model));
    return '';
  }
}
