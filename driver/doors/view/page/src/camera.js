// SPDX-License-Identifier: MIT
/** The camera, which turns about a point. Mouse, touch and keys move it in the same way. */
import {Box3, MathUtils, PerspectiveCamera, Spherical, Vector3} from 'three';

const kFieldOfView = 32; // degrees
const kViews = {front: [0, Math.PI / 2], right: [Math.PI / 2, Math.PI / 2], top: [0, 0.001], start: [0.6, 1.12]};
const kNearest = 0.01, kFarthest = 100; // m
const kPole = 0.001; // rad: least angle to the vertical, because a vertical view has no direction to the right

export class OrbitCamera {
  constructor() {
    this.camera = new PerspectiveCamera(kFieldOfView, 1, 0.002, 50);
    this.center = new Vector3();
    this.spherical = new Spherical(0.5, kViews.start[1], kViews.start[0]);
    this.apply();
  }

  apply() {
    this.spherical.radius = MathUtils.clamp(this.spherical.radius, kNearest, kFarthest);
    this.camera.position.setFromSpherical(this.spherical).add(this.center);
    this.camera.near = Math.max(this.spherical.radius / 200, 0.0005);
    this.camera.far = this.spherical.radius * 40;
    this.camera.lookAt(this.center);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  resize(width, height) {
    this.camera.aspect = width / Math.max(height, 1);
    this.apply();
  }

  turn(theta, phi) {
    this.spherical.theta += theta;
    this.spherical.phi = MathUtils.clamp(this.spherical.phi + phi, kPole, Math.PI - kPole);
    this.apply();
  }

  zoom(factor) {
    this.spherical.radius *= factor;
    this.apply();
  }

  right() { return new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0); }
  up() { return new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1); }
  forward() { return this.camera.getWorldDirection(new Vector3()); }

  /** Moves the view by a number of pixels. @param height height of the canvas in pixels */
  pan(dx, dy, height) {
    const scale = this.metresPerPixel(this.center, height);
    this.center.addScaledVector(this.right(), -dx * scale).addScaledVector(this.up(), dy * scale);
    this.apply();
  }

  /** Returns how many metres a pixel covers at a point. */
  metresPerPixel(point, height) {
    const distance = point.clone().sub(this.camera.position).dot(this.forward());
    return 2 * distance * Math.tan(MathUtils.degToRad(kFieldOfView / 2)) / height;
  }

  /** Moves the camera so that it shows all of a box. */
  fit(box) {
    const all = box.isEmpty() ? new Box3(new Vector3(-0.1, -0.1, -0.1), new Vector3(0.1, 0.1, 0.1)) : box;
    all.getCenter(this.center);
    const radius = all.getSize(new Vector3()).length() / 2, narrow = Math.min(1, this.camera.aspect);
    this.spherical.radius = radius / Math.sin(MathUtils.degToRad(kFieldOfView / 2)) / narrow * 1.06;
    this.apply();
  }

  look(name) {
    [this.spherical.theta, this.spherical.phi] = kViews[name];
    this.apply();
  }
}
