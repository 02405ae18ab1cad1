// What is to be drawn for a state of the page: which meshes where, as far as the budget of triangles goes.

import { LARGEST } from "./extent.js";
import { Mesh } from "./meshes.js";
import { POINT_WORDS, Rows, SEGMENT_WORDS, SHAPES, SURFACE_WORDS, packed } from "./renderer.js";
import { minus, plus, times } from "./vectors.js";

export const BOX = new Mesh({
  name: "box",
  positions: new Float32Array([0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1, i & 2, i & 4].map((bit) => (bit ? 1 : -1)))),
  indices: new Uint32Array([
    0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5,
  ]),
});
export const TRIANGLE = new Mesh({
  name: "triangle", positions: new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), indices: new Uint32Array([0, 1, 2]),
});

// Bins of apparent size in pixels, each 1.25 times the last.
const BINS = 64, binOf = (pixels) => Math.min(BINS - 1, Math.max(0, Math.floor(Math.log(pixels) / Math.log(1.25)) + 8));

export class Stage {
  /**
   * @param {import("./vectors.js").Camera} camera
   * @param {HTMLCanvasElement} canvas
   */
  constructor(camera, canvas) {
    this.camera = camera;
    this.canvas = canvas;
    this.begin(0);
  }

  /** Collects for a camera; `budget`: triangles. Numbers: 1 + index of an object, then of queries. */
  begin(budget) {
    const { camera, canvas } = this, [right, up, forward] = camera.axes();
    this.budget = budget;
    this.items = [];
    this.simplified = false;
    /** @type {Map<Mesh, Rows>} */
    this.solids = new Map();
    /** @type {Map<Mesh, Rows>} */
    this.ghosts = new Map();
    /** @type {{place: number[], text: string}[]} */
    this.labels = [];
    this.lines = new Rows(SEGMENT_WORDS);
    this.marks = new Rows(POINT_WORDS);
    this.specks = new Rows(POINT_WORDS);
    this.farthest = 0;
    this.right = right;
    this.up = up;
    this.forward = forward;
    this.eye = camera.eye();
    this.focal = canvas.height / (2 * camera.slope);
    this.aspect = canvas.width / canvas.height;
    this.widest = Math.hypot(1, camera.slope * Math.max(1, this.aspect));
  }

  /** One of `placed`, moved; drawn if it may be in sight. */
  add(placed, i, moved, colour, id) {
    // Called for every object in every picture: without arrays that live for a call.
    const { eye, forward, up, right } = this, { centre } = placed;
    const x = centre[3 * i] + moved[0] - eye[0], y = centre[3 * i + 1] + moved[1] - eye[1];
    const z = centre[3 * i + 2] + moved[2] - eye[2];
    const depth = x * forward[0] + y * forward[1] + z * forward[2], radius = placed.radius[i];
    if (!(depth >= -radius && Math.max(Math.abs(x), Math.abs(y), Math.abs(z), radius) < LARGEST)) return;
    const side = this.widest * radius, most = Math.max(depth, 0) * this.camera.slope;
    if (Math.abs(x * up[0] + y * up[1] + z * up[2]) > most + side) return;
    if (Math.abs(x * right[0] + y * right[1] + z * right[2]) > most * this.aspect + side) return;
    this.farthest = Math.max(this.farthest, depth + radius);
    const pixels = (radius * this.focal) / Math.max(depth, radius);
    this.items.push({ placed, i, moved, colour, id, pixels, bin: binOf(pixels), mesh: placed.meshOf(i) });
  }

  /** Whether something is between the eye and a place. */
  hides(placed, i, moved, place) {
    const { eye } = this, { centre } = placed, [u, v, w] = [place[0] - eye[0], place[1] - eye[1], place[2] - eye[2]];
    const x = centre[3 * i] + moved[0] - eye[0], y = centre[3 * i + 1] + moved[1] - eye[1];
    const z = centre[3 * i + 2] + moved[2] - eye[2], far = u * u + v * v + w * w;
    const share = Math.min(Math.max((x * u + y * v + z * w) / far, 0), 1), radius = placed.radius[i];
    if (!((x - share * u) ** 2 + (y - share * v) ** 2 + (z - share * w) ** 2 < radius ** 2)) return false;
    if (placed.meshOf(i).drawn > 50000) return share < 1 && share * Math.sqrt(far) > radius;
    return placed.crosses(i, minus(eye, moved), minus(place, moved));
  }

  /** The largest in sight whole, others as their boxes, the smallest as specks, some of which are left out. */
  settle() {
    const whole = new Float64Array(BINS), boxes = new Float64Array(BINS);
    for (const item of this.items) {
      whole[item.bin] += item.mesh.drawn;
      boxes[item.bin] += Math.min(item.mesh.drawn, 12);
    }
    const leastBin = (triangles, budget) => {
      let bin = BINS;
      for (let sum = 0; bin > 0 && (sum += triangles[bin - 1]) <= budget; --bin);
      return bin;
    };
    const leastWhole = leastBin(whole, 0.7 * this.budget), leastBox = leastBin(boxes, 0.3 * this.budget);
    const isSmall = (item) => item.pixels <= 1 || item.bin < Math.min(leastWhole, leastBox);
    const specks = this.items.reduce((count, item) => count + isSmall(item), 0);
    const kept = Math.min(1, Math.max(12000, 0.2 * this.budget) / specks);
    this.simplified = kept < 1;
    for (const item of this.items) {
      if (item.pixels > 1 && item.bin >= leastWhole) this.put(this.solids, item.mesh, item);
      else if (!isSmall(item)) this.put(this.solids, BOX, item, item.mesh);
      else if (((item.id * 0.618034) % 1) < kept) this.speck(item);
      this.simplified ||= item.bin < leastWhole;
    }
  }

  /** An instance of a mesh in the pose of an item; `boxed`: the mesh whose box it is. */
  put(groups, mesh, { placed, i, moved, colour, id }, boxed = null) {
    if (!groups.has(mesh)) groups.set(mesh, new Rows(SURFACE_WORDS));
    const rows = groups.get(mesh), word = rows.add(), { linear, at } = placed, { floats, whole } = rows;
    for (let k = 0; k < 3; ++k) {
      let place = at[3 * i + k] + moved[k] - this.eye[k];
      for (let j = 0; j < 3; ++j) {
        const entry = linear[9 * i + 3 * k + j];
        floats[word + 4 * k + j] = boxed ? entry * boxed.half[j] : entry;
        if (boxed) place += entry * boxed.middle[j];
      }
      floats[word + 4 * k + 3] = place;
    }
    whole[word + 12] = packed(colour);
    whole[word + 13] = id;
  }

  /** An item as a square. */
  speck({ placed, i, moved, colour, id, pixels }) {
    const { specks, eye } = this, word = specks.add(), { floats, whole } = specks;
    for (let k = 0; k < 3; ++k) floats[word + k] = placed.centre[3 * i + k] + moved[k] - eye[k];
    floats[word + 3] = Math.max(1.3 * pixels, 1.5);
    whole[word + 4] = packed(colour);
    whole[word + 5] = id;
    floats[word + 6] = SHAPES.square;
  }

  /** An item like glass, with its edges if `lines`. */
  glass(placed, i, moved, colour, lines) {
    const mesh = placed.meshOf(i);
    if (!(placed.radius[i] < LARGEST)) return;
    this.put(this.ghosts, mesh, { placed, i, moved, colour, id: 0 });
    if (!lines || mesh.drawn > 20000) return;
    for (const ends of mesh.creases()) {
      const [a, b] = ends.map((end) => plus(placed.toWorld(i, end), moved));
      this.line(a, b, [...colour, 0.8], 1);
    }
  }

  /** Words beside a place. */
  label(place, text) {
    this.labels.push({ place, text });
  }

  triangle(corners, colour) {
    const [a, b] = [minus(corners[1], corners[0]), minus(corners[2], corners[0])];
    const linear = [0, 1, 2].flatMap((k) => [a[k], b[k], 0]);
    // A little nearer, to be seen on the surface that it is a part of.
    const nearer = times(-2e-4, minus(corners[0], this.eye));
    const placed = { linear: new Float32Array(linear), at: plus(corners[0], nearer) };
    this.put(this.solids, TRIANGLE, { placed, i: 0, moved: [0, 0, 0], colour, id: 0 });
  }

  line(from, to, colour, width = 1, dash = 0) {
    const { lines, eye } = this, word = lines.add();
    lines.floats.set(minus(from, eye), word);
    lines.floats.set(minus(to, eye), word + 3);
    lines.whole[word + 6] = packed(colour);
    lines.floats.set([width * devicePixelRatio, dash * devicePixelRatio], word + 7);
  }

  /** A line through points; of many, a dashed one leaves out every other part. */
  path(points, colour, width = 1, dash = 0) {
    for (let i = 1; i < points.length; i += dash && points.length > 2 ? 2 : 1) {
      this.line(points[i - 1], points[i], colour, width, points.length > 2 ? 0 : dash);
    }
  }

  point(rows, place, colour, diameter, shape, id = 0) {
    const word = rows.add();
    rows.floats.set(minus(place, this.eye), word);
    rows.floats[word + 3] = diameter;
    rows.whole[word + 4] = packed(colour);
    rows.whole[word + 5] = id;
    rows.floats[word + 6] = SHAPES[shape];
  }
  mark(place, colour, diameter, shape) {
    this.point(this.marks, place, colour, diameter * devicePixelRatio, shape);
  }

  view() {
    const { camera, canvas } = this, farthest = Math.max(this.farthest, 1.5 * camera.distance);
    const near = camera.nearest(farthest);
    return { clipFromEye: camera.clipFromEye(canvas.width / canvas.height, near, farthest), near, up: this.up };
  }

  drawWith(renderer, picking = false) {
    renderer.begin(this.view(), picking);
    renderer.surfaces(this.solids);
    renderer.points(this.specks);
    if (!picking) renderer.surfaces(this.ghosts, "ghost");
    renderer.segments(this.lines);
    if (!picking) renderer.points(this.marks);
  }
}
