// SPDX-License-Identifier: MIT
/** Shows how large things are: the axes of the world with their letters, and a bar of one square of the floor's grid. In
 * a perspective the bar is true in the middle of the picture. */
import {Vector3} from 'three';

const kAxes = [['x', new Vector3(1, 0, 0)], ['y', new Vector3(0, 1, 0)], ['z', new Vector3(0, 0, 1)]];
const kMiddle = {x: 36, y: 38}, kArm = 22, kLetter = 31; // pixels: the triad and its letters
const kBar = {x: 78, y: 50}; // pixels: where the bar begins
const kShortest = 28; // pixels: a square of the grid is 28 to 70 pixels wide

/** Returns the least length of the series 1, 2, 5, 10... that is not shorter. */
export function roundLength(metres) {
  const ten = 10 ** Math.floor(Math.log10(metres) + 1e-9);
  return ten * ([1, 2, 5].find((digit) => digit * ten >= metres * (1 - 1e-9)) ?? 10);
}

/** Returns a length as people write it: 0.5 mm, 10 mm, 2 m. */
const lengthText = (metres) => (metres < 0.999 ? `${Number((metres * 1e3).toPrecision(1))} mm` : `${Number(metres.toPrecision(1))} m`);

export class Ruler {
  constructor(canvas) {
    this.canvas = canvas;
    this.pitch = 0; // m: width of a square of the grid
    this.text = '';
  }

  /** Takes the present camera. @param height height of the picture in pixels @param grid true if the floor is shown */
  look(orbit, height, grid) {
    const scale = orbit.metresPerPixel(orbit.center, Math.max(height, 1));
    this.pitch = roundLength(kShortest * scale);
    this.length = this.pitch / scale;
    this.text = `${grid ? 'grid ' : ''}${lengthText(this.pitch)}`;
    const turn = orbit.camera.quaternion.clone().invert();
    // the axis that points away is painted first
    this.axes = kAxes.map(([name, axis]) => ({name, to: axis.clone().applyQuaternion(turn)})).sort((a, b) => a.to.z - b.to.z);
  }

  /** Paints on the page, if something has changed. @param colors colours of x, y, z and of the text */
  draw(colors) {
    const shown = JSON.stringify([this.text, this.length, this.axes, colors, devicePixelRatio]);
    if (shown === this.shown) return;
    this.shown = shown;
    const {clientWidth: width, clientHeight: height} = this.canvas, ratio = Math.max(devicePixelRatio, 1);
    Object.assign(this.canvas, {width: width * ratio, height: height * ratio});
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    this.paint(context, colors);
    this.canvas.setAttribute('aria-label', `Axes x, y, z; ${this.text}`);
  }

  /** Paints with the upper left corner at the context's origin. */
  paint(context, colors) {
    context.font = '12px system-ui, "DejaVu Sans", sans-serif';
    context.lineWidth = 2;
    context.lineCap = 'round';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    for (const {name, to} of this.axes) {
      context.strokeStyle = context.fillStyle = colors[name];
      context.beginPath();
      context.moveTo(kMiddle.x, kMiddle.y);
      context.lineTo(kMiddle.x + kArm * to.x, kMiddle.y - kArm * to.y);
      context.stroke();
      context.fillText(name, kMiddle.x + kLetter * to.x, kMiddle.y - kLetter * to.y);
    }
    this.#bar(context, colors.text);
  }

  #bar(context, color) {
    const {x, y} = kBar, end = x + this.length;
    context.strokeStyle = context.fillStyle = color;
    context.lineWidth = 1.5;
    context.beginPath();
    for (const [px, py] of [[x, y - 4], [x, y], [end, y], [end, y - 4]]) context.lineTo(px, py);
    context.stroke();
    context.textAlign = 'left';
    context.fillText(this.text, x, y - 14);
  }
}
