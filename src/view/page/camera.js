// The camera of the page: orbits, walks, and projects points of the room into the picture.
'use strict';

const add = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const scaled = (a, s) => a.map((v) => v * s);
const lengthOf = (a) => Math.hypot(...a);
const unit = (a) => scaled(a, 1 / (lengthOf(a) || 1));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
// Rotates v about a unit axis (Rodrigues).
function rotated(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(scaled(v, c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}

class RoomCamera {
  constructor(camera, worldUp, bounds) {
    Object.assign(this, structuredClone(camera));
    this.worldUp = unit(worldUp);
    const middle = bounds ? scaled(add(bounds[0], bounds[1]), 0.5) : add(this.eye, this.forward);
    const size = bounds ? lengthOf(add(bounds[1], bounds[0], -1)) : 1;
    // Distance of the orbit's pivot: as far ahead as the middle of the room.
    this.reach = Math.max(dot(add(middle, this.eye, -1), this.forward), 0.05 * size);
    this.size = size;
  }
  get right() { return scaled(unit(cross(this.forward, this.up)), this.hand); }
  get pivot() { return add(this.eye, this.forward, this.reach); }

  // Turns by angles in radians, to the right and up. Stops before the zenith.
  turn(yaw, pitch) {
    const level = dot(this.forward, this.worldUp);
    const now = Math.asin(Math.max(-1, Math.min(1, level))), most = 1.5;
    const up = Math.max(-most, Math.min(most, now + pitch)) - now;
    const side = unit(cross(this.forward, this.worldUp));
    let forward = rotated(this.forward, side, up);
    forward = rotated(forward, this.worldUp, -yaw * this.hand);
    this.forward = unit(forward);
    this.up = this.worldUp;
  }
  orbit(yaw, pitch) {
    const pivot = this.pivot;
    this.turn(yaw, pitch);
    this.eye = add(pivot, this.forward, -this.reach);
  }
  // Moves along right, up and forward; metres.
  walk(right, up, forward) {
    this.eye = add(add(add(this.eye, this.right, right), this.worldUp, up), this.forward, forward);
  }
  dolly(share) {
    const step = this.reach * share;
    this.eye = add(this.eye, this.forward, step);
    this.reach = Math.max(this.reach - step, 0.02 * this.size);
  }

  // Rectangle of the image plane at distance 1: [x0, x1, y0, y1], left to right and bottom to top.
  plane(aspect) {
    const h = this.half_extent;
    if (this.window) return this.window.map((v) => v * h);
    return this.is_vertical || aspect >= 1 ? [-aspect * h, aspect * h, -h, h]
      : [-h, h, -h / aspect, h / aspect];
  }
  // Projects a point into the picture: shares of its sides from the top left; null if it is behind
  // the camera.
  project(p, aspect) {
    const d = add(p, this.eye, -1), along = dot(d, this.forward);
    if (this.is_perspective && along < 1e-6) return null;
    const side = unit(cross(this.forward, this.up)), up = cross(side, this.forward);
    const scale = this.is_perspective ? 1 / along : 1, [x0, x1, y0, y1] = this.plane(aspect);
    const x = dot(d, this.right) * scale, y = dot(d, up) * scale;
    return [(x - x0) / (x1 - x0), (y1 - y) / (y1 - y0)];
  }
  message() {
    return {eye: this.eye, forward: this.forward, up: this.up, half_extent: this.half_extent};
  }
}
