// What mouse, fingers and keys on the picture do to the camera.

// How far a key turns, radians, and moves, pixels; what it zooms by.
const TURN = 0.1, STEP = 40, ZOOM = 1.2;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

export class Hands {
  /**
   * @param {import("./vectors.js").Camera} camera
   * @param {HTMLElement} canvas
   */
  constructor(camera, canvas) {
    this.camera = camera;
    this.canvas = canvas;
    /** @type {Map<number, number[]>} where each pointer is that is down, pixels */
    this.down = new Map();
    /** How far they have moved since the first went down. */
    this.moved = 0;
  }

  press({ pointerId, clientX, clientY }) {
    this.moved = this.down.size === 0 ? 0 : Infinity;
    this.down.set(pointerId, [clientX, clientY]);
  }
  /** One pointer turns, or moves with another button or shift; two move and zoom. Returns whether it does. */
  move({ pointerId, clientX, clientY, buttons, shiftKey }) {
    const { camera, canvas, down } = this, last = down.get(pointerId), place = [clientX, clientY];
    if (!last) return false;
    const x = clientX - last[0], y = clientY - last[1], [, other] = [...down].find(([id]) => id !== pointerId) ?? [];
    this.moved += Math.abs(x) + Math.abs(y);
    down.set(pointerId, place);
    if (other) {
      const spread = (from) => Math.max(1, Math.hypot(from[0] - other[0], from[1] - other[1]));
      camera.zoom(spread(last) / spread(place));
      camera.move(0.5 * x, 0.5 * y, canvas.clientHeight);
    } else if (buttons > 1 || shiftKey) {
      camera.move(x, y, canvas.clientHeight);
    } else {
      camera.turn(-0.006 * x, 0.006 * y);
    }
    return true;
  }
  /** Returns whether it was a click. */
  release({ pointerId }) {
    return this.down.delete(pointerId) && this.moved < 4;
  }

  /** Arrows turn, and move with shift; + and - zoom. Returns whether the key does so. */
  key({ key, shiftKey }) {
    const { camera, canvas } = this, arrow = ARROWS[key];
    if (arrow && shiftKey) camera.move(-STEP * arrow[0], -STEP * arrow[1], canvas.clientHeight);
    else if (arrow) camera.turn(TURN * arrow[0], -TURN * arrow[1]);
    else if ("+=-".includes(key)) camera.zoom(key === "-" ? ZOOM : 1 / ZOOM);
    else return false;
    return true;
  }
}
