// SPDX-License-Identifier: MIT
/** Fills the cracks between the faces of a model. A plugin cuts each face into triangles by itself, so the corners of two
 * faces along their common edge may differ; what is behind would show through, as specks a pixel wide. */
import {BufferAttribute, BufferGeometry} from 'three';

const kMost = 100_000; // triangles; larger models have small triangles, and to look for their seams takes too long

/** Returns a number for each corner; corners at the same place have the same one. */
function placesOf(position) {
  const bits = new Uint32Array(Float32Array.from(position.array, (x) => x + 0).buffer), places = new Uint32Array(position.count);
  const table = new Int32Array(2 ** Math.ceil(Math.log2(2 * places.length + 2))).fill(-1); // open addressing
  const same = (i, j) => bits[3 * i] === bits[3 * j] && bits[3 * i + 1] === bits[3 * j + 1] && bits[3 * i + 2] === bits[3 * j + 2];
  for (let i = 0; i < places.length; ++i) {
    let hash = [0, 1, 2].reduce((sum, k) => Math.imul(sum ^ bits[3 * i + k], 0x9e3779b1), 0);
    hash ^= hash >>> 15;
    let slot = hash & (table.length - 1);
    while (table[slot] >= 0 && !same(table[slot], i)) slot = (slot + 1) & (table.length - 1);
    if (table[slot] < 0) table[slot] = i;
    places[i] = table[slot];
  }
  return places;
}

/** Returns the corners, two by two, of the edges that belong to one triangle alone. */
function openEdges(geometry) {
  const corners = geometry.index ?? {count: geometry.attributes.position.count, getX: (i) => i};
  const places = placesOf(geometry.attributes.position), edges = new Map();
  for (let i = 0; i < corners.count; ++i) {
    const a = corners.getX(i), b = corners.getX(i % 3 === 2 ? i - 2 : i + 1);
    const [low, high] = [places[a], places[b]].sort((x, y) => x - y), key = low * places.length + high;
    if (low < high) edges.set(key, edges.has(key) ? null : [a, b]);
  }
  return [...edges.values()].flatMap((edge) => edge ?? []);
}

/** Returns lines along all edges at which triangles do not meet corner to corner; null if there are none. */
export function seamsOf(geometry) {
  const {position, normal, color} = geometry.attributes;
  if ((geometry.index ?? position).count > 3 * kMost) return null;
  const corners = openEdges(geometry);
  if (corners.length === 0) return null;
  const lines = new BufferGeometry();
  for (const [name, of] of Object.entries({position, normal, ...(color && {color})}))
    lines.setAttribute(name, new BufferAttribute(new Float32Array(corners.flatMap((i) => [of.getX(i), of.getY(i), of.getZ(i)])), 3));
  return lines;
}

/** Changes the shader of a material so that lines are where they are on the screen, but farther away: only a crack shows
 * them. Those of faces that are seen from behind or from the side are left out: they would stick out of the silhouette. */
export function placeBehind(shader) {
  shader.vertexShader = shader.vertexShader.replace('#include <project_vertex>',
    '#include <project_vertex>\ngl_Position = projectionMatrix * vec4(1.002 * mvPosition.xyz, 1.0);');
  shader.fragmentShader = shader.fragmentShader.replace('#include <opaque_fragment>',
    'if (dot(normalize(vNormal), normalize(vViewPosition)) < 0.2) discard;\n#include <opaque_fragment>');
}
