// SPDX-License-Identifier: MIT
/** Colours of models: those of a CAD file, and otherwise one of the page's own for each model. Colours of a file are words
 * red | green << 8 | blue << 16, one per vertex; 0 means none. */
import {Color, SRGBColorSpace} from 'three';

const kPlugins = {mat_deformable: '#e0a08c', push_button: '#8fb0dc', pendulum: '#cdb27a'};
const kRigid = ['#a3b8c9', '#c9b49c', '#a5c2a6', '#bfaacb', '#9cc0c4']; // parts of an assembly must be told apart
const kOther = ['#a7c4a0', '#c3a6cf', '#9fc6c4', '#d3bd94'];
const kPale = 0.2; // share of grey in a colour of a file: on pure red or black a shape would have no shading
const kGrey = new Color('#c8ccd0');
const kSwatches = 4; // most colours of a swatch

/** Returns the page's own colour of a model, which depends on its plugin; rigid models take turns. */
export function colourOf(plugin, index) {
  if (plugin === 'nurbs_rigid') return kRigid[index % kRigid.length];
  return kPlugins[plugin] ?? kOther[index % kOther.length];
}

/** Returns what a word means on the page. @param own colour of the model, for 0 */
function drawn(word, own) {
  if (word === 0) return new Color(own);
  return new Color().setRGB((word & 255) / 255, (word >> 8 & 255) / 255, (word >> 16 & 255) / 255, SRGBColorSpace).lerp(kGrey, kPale);
}

/** Returns red, green and blue of each vertex, as a shader takes them. */
export function vertexColours(words, own) {
  const known = new Map(), numbers = new Float32Array(3 * words.length);
  words.forEach((word, i) => {
    if (!known.has(word)) known.set(word, drawn(word, own).toArray());
    numbers.set(known.get(word), 3 * i);
  });
  return numbers;
}

/** Returns a background for the swatch of a model: its most frequent colours. @param words null if it has none */
export function swatchOf(words, own) {
  if (!words) return own;
  const counts = new Map();
  for (const word of words) counts.set(word, (counts.get(word) ?? 0) + 1);
  const most = [...counts].sort((a, b) => b[1] - a[1]).slice(0, kSwatches);
  const stops = most.map(([word], i) => `#${drawn(word, own).getHexString()} ${i / most.length}turn ${(i + 1) / most.length}turn`);
  return `conic-gradient(${stops.join(', ')})`;
}
