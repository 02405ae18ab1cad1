// What is to be drawn for a state of the page: which meshes where, as far as the budget of triangles goes.

const COLOURS = {
  hit: [0.9, 0.42, 0.05], clear: [0.1, 0.6, 0.47], overlap: [0.85, 0.13, 0.5], undecided: [0.85, 0.65, 0],
  invalid: [0.35, 0.35, 0.35], object: [0.68, 0.72, 0.78], touched: [0.32, 0.55, 0.86], triangle: [1, 0.9, 0.1],
  normal: [0.05, 0.2, 0.75], path: [0.15, 0.15, 0.2],
};
const SYMBOLS = { hit: "●", clear: "○", overlap: "✕", undecided: "◆", invalid: "–" };
const MARKS = { hit: "disc", clear: "ring", overlap: "cross", undecided: "diamond", invalid: "square" };

// The viridis map (S. van der Walt and N. Smith, 2015), as a polynomial (M. Zucker).
const VIRIDIS = [
  [0.2777, 0.0054, 0.3341], [0.1051, 1.4046, 1.3846], [-0.3309, 0.2148, 0.0951], [-4.6342, -5.7991, -19.3324],
  [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.353], [-5.4355, 4.6459, 26.3124],
];
function viridis(share) {
  const x = Math.min(Math.max(share, 0), 1);
  const colour = VIRIDIS.reduceRight((sum, factors) => plus(times(x, sum), factors), [0, 0, 0]);
  return colour.map((value) => Math.min(Math.max(value, 0), 1));
}

/** A colour of its own for each number. */
function hashed(number) {
  const hue = (number * 0.618034) % 1;
  return [0, 1 / 3, 2 / 3].map((shift) => 0.45 + 0.4 * Math.cos(2 * Math.PI * (hue + shift)));
}

const BOX = new Mesh({
  name: "box",
  positions: new Float32Array([0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1, i & 2, i & 4].map((bit) => (bit ? 1 : -1)))),
  indices: new Uint32Array([
    0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5,
  ]),
});
const TRIANGLE = new Mesh({
  name: "triangle", positions: new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]), indices: new Uint32Array([0, 1, 2]),
});

// Bins of apparent size in pixels, each 1.25 times the last.
const BINS = 64, binOf = (pixels) => Math.min(BINS - 1, Math.max(0, Math.floor(Math.log(pixels) / Math.log(1.25)) + 8));

class Stage {
  constructor(data, camera, canvas) {
    Object.assign(this, { data, camera, canvas });
  }

  /** Collects for a camera; `budget`: triangles. Numbers: 1 + index of an object, then of queries. */
  begin(budget) {
    const { camera, canvas } = this;
    Object.assign(this, { budget, items: [], solids: new Map(), ghosts: new Map(), farthest: 0 });
    Object.assign(this, { lines: new Rows(SEGMENT_WORDS), marks: new Rows(POINT_WORDS), specks: new Rows(POINT_WORDS) });
    [this.right, this.up, this.forward] = camera.axes();
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
    if (depth < -radius) return;
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
    const z = centre[3 * i + 2] + moved[2] - eye[2], far = u * u + v * v + w * w, share = (x * u + y * v + z * w) / far;
    if (share < 0 || share > 1) return false;
    const off = (x - share * u) ** 2 + (y - share * v) ** 2 + (z - share * w) ** 2, radius = placed.radius[i];
    return off < radius ** 2 && share * Math.sqrt(far) > radius;
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
    const near = Math.max(1e-3 * camera.distance, 1e-5 * farthest);
    return { clipFromEye: camera.clipFromEye(canvas.width / canvas.height, farthest), near, up: this.up };
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

/** A way of looking at the answers: which queries, how far along their ways, and what is chosen. */
class Look {
  constructor(data) {
    const scene = data.queries.count ? data.queries.scene[0] : 0;
    Object.assign(this, { data, scene, chosen: -1, object: -1, visible: [], time: 1, alone: false, by: "status" });
  }

  /** The part of its way that a query's sensor has gone. */
  gone(query) {
    const share = this.data.share(query);
    return this.alone && query === this.chosen ? this.time * share : Math.min(this.time, share);
  }
  /** The part of the step that has passed, for objects. */
  passed() {
    return this.chosen >= 0 && this.alone ? this.gone(this.chosen) : this.time;
  }

  colourOf(query) {
    const { data, by } = this, { object, t } = data.answers;
    if (by === "t") return Number.isFinite(t[query]) ? viridis(t[query] / (this.farthest() || 1)) : COLOURS.invalid;
    if (by === "object") {
      const own = data.ownObject(query), number = own === undefined ? object[query] : data.scene(this.scene).objects.number[own];
      return number === data.none ? COLOURS.invalid : hashed(number);
    }
    return COLOURS[data.status(query)];
  }
  farthest() {
    return Math.max(0, ...this.data.answers.t.filter(Number.isFinite));
  }

  /** The place that nothing is to hide: where the chosen sensor stops. */
  seen() {
    const { data, chosen } = this, point = [...data.answers.point.subarray(3 * chosen, 3 * chosen + 3)];
    if (chosen < 0) return null;
    return point.every(Number.isFinite) ? point : plus(data.sensors.centreOf(chosen), times(data.share(chosen), data.way(chosen)));
  }

  /** Puts everything on a stage. */
  fill(stage) {
    const { data, chosen } = this, { sensors } = data, scene = data.scene(this.scene);
    const { objects, ways } = scene, rest = [0, 0, 0], isMoving = ways.size > 0, passed = this.passed();
    const touched = chosen >= 0 ? objects.place.get(data.touched(chosen)) : undefined;
    const ignored = new Set(data.queries.ignored[chosen]), seen = this.seen(stage);
    const shown = this.visible.filter((query) => data.queries.scene[query] === this.scene);
    const drawn = this.alone && chosen >= 0 ? [chosen] : shown, moves = new Set(drawn.map((query) => data.ownObject(query)));
    for (let i = 0; i < objects.count; ++i) {
      if (moves.has(i)) continue;
      let colour = this.by === "object" ? hashed(objects.number[i]) : COLOURS.object;
      if (i === touched || i === this.object) colour = COLOURS.touched;
      const moved = isMoving && ways.has(i) ? times(passed, ways.get(i)) : rest;
      const isGlass = (ignored.size > 0 && ignored.has(objects.number[i])) || (i !== touched && seen && stage.hides(objects, i, moved, seen));
      if (isGlass) stage.put(stage.ghosts, objects.meshOf(i), { placed: objects, i, moved, colour, id: 0 });
      else stage.add(objects, i, moved, colour, 1 + i);
      if (i === touched && objects.radius[i] < 0.02 * stage.camera.distance) {
        stage.mark(plus(objects.centreOf(i), moved), COLOURS.touched, 22, "ring");
      }
    }
    for (const query of drawn) {
      const colour = this.colourOf(query), way = data.way(query), pale = chosen >= 0 && query !== chosen;
      if (query === chosen) this.explain(stage, scene);
      if (data.status(query) !== "invalid") {
        const tint = pale ? between(colour, [0.9, 0.9, 0.92], 0.55) : colour;
        stage.add(sensors, query, times(this.gone(query), way), tint, 1 + objects.count + query);
      }
      if (shown.length > 2000 && query !== chosen) continue;
      const start = sensors.centreOf(query), end = plus(start, times(data.share(query), way));
      const status = data.status(query), line = pale ? [...colour, 0.5] : colour;
      stage.line(start, end, line, query === chosen ? 3 : 1.5, status === "clear" ? 6 : status === "undecided" ? 2 : 0);
      stage.mark(end, line, query === chosen ? 11 : 7, MARKS[status]);
    }
  }

  /** The chosen query: where its sensor starts, its bracket, what it touches. */
  explain(stage, { objects, ways }) {
    const { data, chosen } = this, { sensors, answers } = data, way = data.way(chosen);
    const colour = COLOURS[data.status(chosen)], mesh = sensors.meshOf(chosen), start = sensors.centreOf(chosen);
    stage.put(stage.ghosts, mesh, { placed: sensors, i: chosen, moved: [0, 0, 0], colour, id: 0 });
    if (mesh.drawn <= 20000) {
      for (const [a, b] of mesh.creases()) {
        stage.line(sensors.toWorld(chosen, a), sensors.toWorld(chosen, b), [...colour, 0.8], 1);
      }
    }
    const at = (share) => plus(start, times(share, way)), share = data.share(chosen);
    const beyond = Math.min(1, Math.max(share, data.reach(this.scene) / (lengthOf(way) || 1)));
    stage.line(at(share), at(beyond), [...COLOURS.path, 0.5], 1.5, 4);
    const across = times(0.25 * sensors.radius[chosen], unit(cross(way, stage.forward)));
    for (const t of [answers.lo[chosen], answers.hi[chosen]]) {
      if (!Number.isFinite(t)) continue;
      const tick = at(data.fractionOf(chosen, t));
      stage.line(minus(tick, across), plus(tick, across), COLOURS.path, 2);
    }
    this.explainContact(stage, objects, ways, share);
    const other = data.otherShare(chosen);
    if (other !== null && Math.abs(other - share) > 1e-3) {
      const moved = times(other, way);
      stage.put(stage.ghosts, mesh, { placed: sensors, i: chosen, moved, colour: COLOURS.path, id: 0 });
      stage.mark(at(other), COLOURS.path, 13, "ring");
    }
    const scopes = data.scopes[chosen];
    if (scopes) {
      for (const [a, b] of frameOf(scopes)) stage.line(a, b, COLOURS.normal, 1.5);
    }
  }

  explainContact(stage, objects, ways, share) {
    const { data, chosen } = this, { sensors, answers } = data, way = data.way(chosen);
    const object = objects.place.get(answers.object[chosen]);
    if (object === undefined) return;
    const place = (placed, i, triangle, moved) =>
      placed.meshOf(i).corners(triangle).map((corner) => plus(placed.toWorld(i, corner), moved));
    const moved = ways.has(object) ? times(share, ways.get(object)) : [0, 0, 0];
    // A mesh of which the page has only the box has other triangles.
    const has = (placed, i, triangle) => triangle !== data.none && !placed.meshOf(i).isBox;
    const triangles = [], [a, b] = [answers.triA[chosen], answers.triB[chosen]];
    if (has(sensors, chosen, a)) triangles.push(place(sensors, chosen, a, times(share, way)));
    if (has(objects, object, b)) triangles.push(place(objects, object, b, moved));
    for (const corners of triangles) {
      stage.triangle(corners, COLOURS.triangle);
      for (let k = 0; k < 3; ++k) stage.line(corners[k], corners[(k + 1) % 3], COLOURS.path, 2);
    }
    const point = [...answers.point.subarray(3 * chosen, 3 * chosen + 3)];
    const normal = [...answers.normal.subarray(3 * chosen, 3 * chosen + 3)];
    if (!point.every(Number.isFinite)) return;
    if (normal.every(Number.isFinite)) {
      const tip = plus(point, times(0.8 * sensors.radius[chosen], normal));
      stage.line(point, tip, COLOURS.normal, 3);
      stage.mark(tip, COLOURS.normal, 8, "diamond");
    }
    stage.mark(point, [0, 0, 0], 9, "disc");
  }
}
