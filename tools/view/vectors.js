// Points and vectors are arrays of three numbers.

export const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const lengthOf = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => times(1 / (lengthOf(a) || 1), a);
export const between = (a, b, share) => plus(a, times(share, minus(b, a)));

/** A vector after a part of a turn, by O. Rodrigues. */
export function turned({ axis, angle }, vector, share) {
  const by = share * angle, longest = Math.max(...axis.map(Math.abs)) || 1, along = unit(axis.map((x) => x / longest));
  const across = cross(along, vector), inwards = cross(along, across);
  return plus(vector, plus(times(Math.sin(by), across), times(2 * Math.sin(by / 2) ** 2, inwards)));
}

/** An orbit around a target, seen in perspective; z is up. */
export class Camera {
  target = [0, 0, 0];
  distance = 1;
  yaw = -0.9;
  pitch = 0.5;
  /** Half the height of what is seen at a distance of 1. */
  slope = Math.tan(Math.PI / 9);

  /** Right, up and forward. */
  axes() {
    const [c, s, cp, sp] = [Math.cos(this.yaw), Math.sin(this.yaw), Math.cos(this.pitch), Math.sin(this.pitch)];
    return [[-s, c, 0], [-c * sp, -s * sp, cp], [-c * cp, -s * cp, -sp]];
  }
  /** By angles. */
  turn(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = Math.min(Math.max(this.pitch + pitch, -1.57), 1.57);
  }
  /** What is seen by pixels to the right and down, on a canvas so high. */
  move(x, y, height) {
    const [right, up] = this.axes(), pixel = (2 * this.slope * this.distance) / height;
    this.target = plus(this.target, plus(times(-x * pixel, right), times(y * pixel, up)));
  }
  /** As far from the target as before, times a factor. */
  zoom(factor) {
    this.distance *= factor;
  }
  eye() {
    return minus(this.target, times(this.distance, this.axes()[2]));
  }
  /** Where pictures begin: as far from the eye as lets depths of far things differ, and yet before the target. */
  nearest(farthest) {
    return Math.min(Math.max(1e-3 * this.distance, 1e-5 * farthest), 0.05 * this.distance);
  }
  /** Columns of the matrix from places relative to the eye to clip coordinates. */
  clipFromEye(aspect, near, farthest) {
    const [right, up, forward] = this.axes(), far = farthest + near;
    const x = 1 / (this.slope * aspect), y = 1 / this.slope;
    const depth = (far + near) / (far - near), shift = (-2 * far * near) / (far - near);
    const columns = [0, 1, 2].map((k) => [x * right[k], y * up[k], depth * forward[k], forward[k]]);
    return new Float32Array([...columns.flat(), 0, 0, shift, 0]);
  }
  /** Looks at the middle of a box, from where all of it is seen, with some room. */
  looking({ lo, hi }, aspect) {
    const [right, up, forward] = this.axes(), target = between(lo, hi, 0.5), room = 0.85 * this.slope;
    let distance = 0.6 * lengthOf(minus(hi, lo)) || 1;
    for (let corner = 0; corner < 8; ++corner) {
      const from = minus([0, 1, 2].map((k) => (corner & (1 << k) ? hi[k] : lo[k])), target), depth = dot(from, forward);
      distance = Math.max(distance, Math.abs(dot(from, right)) / (room * aspect) - depth, Math.abs(dot(from, up)) / room - depth);
    }
    return { target, distance };
  }
  /** Where a place is on a canvas of that size, in pixels from the upper left corner; its depth. */
  pixel(place, width, height) {
    const [right, up, forward] = this.axes(), from = minus(place, this.eye()), depth = dot(from, forward);
    const scale = height / (2 * this.slope * depth);
    return [0.5 * width + scale * dot(from, right), 0.5 * height - scale * dot(from, up), depth];
  }
}
