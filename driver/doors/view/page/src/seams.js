// SPDX-License-Identifier: MIT
/** Fills the cracks between the faces of a model. A plugin cuts each face into triangles by itself, so the corners of two
 * faces along their common edge may differ; what is behind would show through, as specks a pixel wide. */
import {BufferAttribute, BufferGeometry} from 'three';

const kMost = 200_000; // triangles; larger models have small triangles, and no time is left to look for their seams

/** Returns a number for each corner; corners at the same place have the same one. */
function placesOf(position) {
  const seen = new Map(), places = new Uint32Array(position.count);
  for (let i = 0; i < places.length; ++i) {
    const place = `${position.getX(i)},${position.getY(i)},${position.getZ(i)}`;
    if (!seen.has(place)) seen.set(place, i);
    places[i] = seen.get(place);
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
