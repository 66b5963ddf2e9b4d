// SPDX-License-Identifier: MIT
/** Formats numbers for people, and makes elements of the page. */

/** Returns the element of the page with an id. */
export const $ = (id) => document.getElementById(id);

export const norm = (v) => Math.hypot(...v);
export const fileName = (path) => (path ?? '').split('/').pop();

/** Returns a number as text with about three digits, never "-0". */
export function short(value, digits = 3) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  const decimals = size >= 100 ? 0 : size >= 10 ? Math.max(0, digits - 2) : digits - 1;
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? (0).toFixed(decimals) : text;
}

/** Returns a whole number with its digits in groups: 1 000 000. */
export const grouped = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, '\u202f');

/** Returns the size of a box [m] as text, and its unit: 120 × 60.0 × 40.0 and mm; from a metre on m. */
export function sizeOf({min, max}) {
  const size = ['x', 'y', 'z'].map((axis) => max[axis] - min[axis]), large = Math.max(...size) >= 1;
  return {lengths: size.map((length) => short(large ? length : length * 1e3)).join(' × '), unit: large ? 'm' : 'mm'};
}

/** Returns a bound as people write it: 1e-12, 0.001, 10000. */
export const exact = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(6))) : '–');

/** Returns a time in seconds as m:ss.ss. */
export function clock(t) {
  if (!Number.isFinite(t)) return '–';
  const minutes = Math.floor(t / 60);
  return `${minutes}:${(t - 60 * minutes).toFixed(2).padStart(5, '0')}`;
}

/** Makes an element with properties and children. */
export function element(tag, properties = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(properties)) {
    if (key === 'class') made.className = value;
    else if (key === 'data') Object.assign(made.dataset, value);
    else if (key in made) made[key] = value;
    else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

/** Returns a colour of the page's theme. */
export const themeColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Lets the user save bytes as a file. */
export function save(blob, name) {
  const link = element('a', {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
