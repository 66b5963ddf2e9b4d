// SPDX-License-Identifier: MIT
/** Draws the scene on a canvas. It draws only when something has changed, and at most once per frame of the display. On
 * a slow machine without a graphics card it draws with fewer pixels. */
import {Box3, Box3Helper, BufferGeometry, Color, DirectionalLight, GridHelper, Group, HemisphereLight, LineBasicMaterial, LineLoop, Scene,
  Vector3, WebGLRenderer} from 'three';
import {OrbitCamera} from './camera.js';
import {Models} from './models.js';
import {Probe} from './probe.js';
import {Ruler} from './ruler.js';

const kSlowMs = 55, kFastMs = 24, kCoarsest = 0.56;
const kMostSquares = 120; // of the floor's grid, in one direction
const kRulerPlace = 8; // pixels from the lower left corner of a saved picture
/** Triangles of the whole scene. A processor that plays the graphics card draws 120 000 of them some 7 times a second; a
 * part of 10 000 faces has so many. With more than kTriangles, searching for the one under the pointer delays the hand. */
const kTriangles = 300000, kSoftwareTriangles = 125000, kFewestTriangles = 2000;
const kEmptyExtent = 0.15; // m: size of a scene without a model

/** Tells whether the processor draws instead of a graphics card. */
function drawsInSoftware() {
  const probe = document.createElement('canvas').getContext('webgl2');
  const info = probe?.getExtension('WEBGL_debug_renderer_info');
  const name = info ? probe.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  probe?.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(name);
}

export class View {
  /** @param canvas for the scene @param ruler canvas for the axes and the scale */
  constructor(canvas, ruler) {
    this.canvas = canvas;
    this.ruler = new Ruler(ruler);
    this.software = drawsInSoftware();
    this.renderer = new WebGLRenderer({canvas, antialias: !this.software, powerPreference: 'high-performance', preserveDrawingBuffer: false});
    this.ratio = this.software ? 1 : Math.min(devicePixelRatio, 2);
    this.scene = new Scene();
    this.orbit = new OrbitCamera();
    this.models = new Models();
    this.probes = [];
    this.light = new DirectionalLight('#ffffff', 2.1);
    this.scene.add(this.models.group, new HemisphereLight('#ffffff', '#8d99a6', 1.6), this.light);
    this.workspaceMaterial = new LineBasicMaterial();
    this.shown = {arm: true, force: true, grid: true, workspace: false, wire: false};
    this.extent = kEmptyExtent;
    this.dirty = true;
    this.frames = 0;
    this.average = (kSlowMs + kFastMs) / 2;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  /** Returns how many triangles one of so many models may have. */
  trianglesOfOne(models) {
    return Math.max(kFewestTriangles, Math.floor((this.software ? kSoftwareTriangles : kTriangles) / Math.max(models, 1)));
  }

  /** Notes the new size of the canvas. It is applied directly before the next picture, because a canvas is empty after
   * a change of its size. */
  resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas.parentElement;
    this.size = [width, height];
    this.orbit.resize(width, height);
    this.dirty = true;
  }

  #applySize() {
    if (!this.size) return;
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(...this.size, false);
    this.size = null;
  }

  theme(colors) {
    this.colors = colors;
    this.scene.background = new Color(colors.panel);
    for (const probe of this.probes) probe.colors(colors);
    this.workspaceMaterial.color.set(colors.accent);
    this.floor = '';
    this.dirty = true;
  }

  /** Makes one probe for each arm. */
  arms(count) {
    for (const probe of this.probes) this.scene.remove(probe.group);
    this.probes = Array.from({length: count}, () => {
      const probe = new Probe();
      if (this.colors) probe.colors(this.colors);
      this.scene.add(probe.group);
      return probe;
    });
  }

  /** Sets the sizes of tip, floor and stains by the size of the scene. */
  measure() {
    const box = this.models.box();
    this.extent = box.isEmpty() ? kEmptyExtent : box.getSize(new Vector3()).length();
    for (const probe of this.probes) probe.resize(Math.min(Math.max(this.extent / 60, 0.002), 0.006));
    this.models.stainRadius(Math.min(this.extent / 26, 0.02));
    this.floor = '';
    this.show('wire', this.shown.wire);
  }

  /** Draws the grid of the floor about the middle of the picture, if it is not there yet. Its lines are at multiples of
   * its pitch. */
  #floor() {
    const {pitch} = this.ruler, squares = 2 * Math.min(Math.ceil(0.65 * Math.max(this.extent, 0.2) / pitch), kMostSquares / 2);
    const [x, z] = [this.orbit.center.x, this.orbit.center.z].map((place) => Math.round(place / pitch) * pitch);
    const floor = [pitch, squares, x, z].join();
    if (floor === this.floor) return;
    this.floor = floor;
    if (this.grid) {
      this.scene.remove(this.grid);
      this.grid.geometry.dispose();
    }
    const box = this.models.box();
    this.grid = new GridHelper(squares * pitch, squares, this.colors?.line, this.colors?.line);
    this.grid.position.set(x, box.isEmpty() ? -0.08 : box.min.y - 0.004, z);
    this.grid.visible = this.shown.grid;
    this.scene.add(this.grid);
  }

  /** Draws the workspaces. @param spaces for each arm: `box`, the places that it can reach as {min, max}; and `center`
   * and `radius` [m] of the sphere outside of which forces fade, drawn as three great circles (0: no limit) */
  setWorkspaces(spaces) {
    if (this.workspace) this.scene.remove(this.workspace);
    this.workspace = new Group();
    this.workspaceMaterial.color.set(this.colors?.accent ?? '#888888');
    for (const {box, center, radius} of spaces) {
      if (box) this.workspace.add(new Box3Helper(new Box3(box.min, box.max)));
      if (radius > 0) this.workspace.add(...this.#circles(center, radius));
    }
    for (const line of this.workspace.children) line.material = this.workspaceMaterial;
    this.workspace.visible = this.shown.workspace;
    this.scene.add(this.workspace);
  }

  #circles(center, radius) {
    const points = Array.from({length: 96}, (_, i) => new Vector3(Math.cos(i * Math.PI / 48) * radius, Math.sin(i * Math.PI / 48) * radius, 0));
    const circle = new BufferGeometry().setFromPoints(points);
    return [[0, 0], [Math.PI / 2, 0], [0, Math.PI / 2]].map(([x, y]) => {
      const line = new LineLoop(circle);
      line.rotation.set(x, y, 0);
      line.position.set(...center);
      return line;
    });
  }

  show(what, on) {
    this.shown[what] = on;
    if (this.grid) this.grid.visible = this.shown.grid;
    if (this.workspace) this.workspace.visible = this.shown.workspace;
    this.models.wire(this.shown.wire);
    for (const probe of this.probes) {
      probe.arm.visible = this.shown.arm;
      probe.showForce = this.shown.force;
    }
    this.dirty = true;
  }

  fit() {
    const box = this.models.box(), room = new Vector3().setScalar(0.02);
    for (const probe of this.probes)
      if (probe.tip.visible) box.union(new Box3().setFromCenterAndSize(probe.tipPlace, room));
    this.orbit.fit(box);
    this.dirty = true;
  }

  /** Draws if something has changed. Returns true if it drew. */
  draw() {
    if (!this.dirty) return false;
    this.dirty = false;
    this.#applySize();
    const {camera, spherical, center} = this.orbit;
    this.light.position.copy(camera.position).addScaledVector(this.orbit.up(), spherical.radius * 0.7)
      .addScaledVector(this.orbit.right(), -spherical.radius * 0.55);
    this.light.target.position.copy(center);
    this.light.target.updateMatrixWorld();
    this.ruler.look(this.orbit, this.canvas.clientHeight, this.shown.grid);
    this.#floor();
    if (this.colors) this.ruler.draw(this.colors.ruler);
    this.renderer.render(this.scene, camera);
    ++this.frames;
    return true;
  }

  /** Chooses the resolution of the next frames by the time [ms] between the last two. */
  pace(ms) {
    if (!this.software || ms > 500) return;
    this.average += 0.06 * (ms - this.average);
    const before = this.ratio;
    if (this.average > kSlowMs) this.ratio = Math.max(kCoarsest, this.ratio * 0.85);
    else if (this.average < kFastMs) this.ratio = Math.min(1, this.ratio * 1.15);
    if (this.ratio === before) return;
    this.average = (kSlowMs + kFastMs) / 2;
    this.resize();
  }

  /** Returns where a point of the world is on the canvas, in CSS pixels. */
  project(point) {
    const p = point.clone().project(this.orbit.camera);
    return {x: (p.x + 1) / 2 * this.canvas.clientWidth, y: (1 - p.y) / 2 * this.canvas.clientHeight, inFront: p.z < 1};
  }

  /** Returns a picture of the present scene with its axes and scale (PNG). It is sharp, also where the page draws with
   * fewer pixels because it is slow. */
  picture() {
    const usual = this.ratio;
    this.ratio = Math.min(Math.max(devicePixelRatio, 1), 2);
    this.resize();
    this.#applySize();
    this.renderer.render(this.scene, this.orbit.camera);
    this.ratio = usual;
    this.resize();
    const {width, height} = this.canvas, picture = Object.assign(document.createElement('canvas'), {width, height});
    const context = picture.getContext('2d'), ratio = height / this.canvas.clientHeight;
    context.drawImage(this.canvas, 0, 0);
    context.scale(ratio, ratio);
    context.translate(kRulerPlace, this.canvas.clientHeight - this.ruler.canvas.clientHeight - kRulerPlace);
    this.ruler.paint(context, this.colors.ruler);
    return new Promise((resolve) => picture.toBlob(resolve, 'image/png'));
  }
}
