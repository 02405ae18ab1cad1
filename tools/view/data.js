// What the page shows, decoded: meshes, scenes, queries and their answers.

// {"f4": "..."}: little-endian numbers in base64, of the type that numpy calls so.
const ARRAYS = { u1: Uint8Array, u4: Uint32Array, f4: Float32Array, f8: Float64Array };

function decodeArray(key, value) {
  for (const type in ARRAYS) {
    if (typeof value?.[type] !== "string") continue;
    const text = atob(value[type]);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
    return new ARRAYS[type](bytes.buffer);
  }
  return value;
}

/** A triangle mesh with the sphere around its box. */
class Mesh {
  /** `isBox`: only the box of a mesh of so many triangles is known. */
  constructor({ name, positions, indices, triangles = indices.length / 3, isBox = false }) {
    Object.assign(this, { name, positions, indices, triangles, isBox, drawn: indices.length / 3 });
    const lo = [Infinity, Infinity, Infinity], hi = [-Infinity, -Infinity, -Infinity];
    for (const vertex of indices) {
      for (let k = 0; k < 3; ++k) {
        const value = positions[3 * vertex + k];
        lo[k] = Math.min(lo[k], value);
        hi[k] = Math.max(hi[k], value);
      }
    }
    this.middle = lo.map((low, k) => 0.5 * (low + hi[k]) || 0);
    this.half = lo.map((low, k) => 0.5 * (hi[k] - low) || 0);
  }
  corners(triangle) {
    return [0, 1, 2].map((i) => {
      const vertex = this.indices[3 * triangle + i];
      return [...this.positions.subarray(3 * vertex, 3 * vertex + 3)];
    });
  }
  /** Whether a triangle crosses start + s * way, 0 < s < 0.998. */
  isCrossed([sx, sy, sz], [wx, wy, wz]) {
    const { positions: p, indices } = this;
    // By T. Moeller and B. Trumbore (1997); without arrays that live for a triangle.
    for (let t = 0; t < indices.length; t += 3) {
      const a = 3 * indices[t], b = 3 * indices[t + 1], c = 3 * indices[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const nx = wy * vz - wz * vy, ny = wz * vx - wx * vz, nz = wx * vy - wy * vx, volume = ux * nx + uy * ny + uz * nz;
      const x = sx - p[a], y = sy - p[a + 1], z = sz - p[a + 2], u = (x * nx + y * ny + z * nz) / volume;
      if (!(u >= 0 && u <= 1)) continue;
      const qx = y * uz - z * uy, qy = z * ux - x * uz, qz = x * uy - y * ux, v = (wx * qx + wy * qy + wz * qz) / volume;
      if (!(v >= 0 && u + v <= 1)) continue;
      const s = (vx * qx + vy * qy + vz * qz) / volume;
      if (s > 0 && s < 0.998) return true;
    }
    return false;
  }
  /** Pairs of points: the edges with one triangle, and those where two meet at more than 30 degrees. */
  creases() {
    this.creaseLines ??= creasesOf(this);
    return this.creaseLines;
  }
}

function creasesOf(mesh) {
  const found = new Map(), ids = new Map(), lines = [];
  // Vertices at one place are one, since the triangles of some files share none.
  const idOf = (p) => {
    const key = p.join();
    if (!ids.has(key)) ids.set(key, ids.size);
    return ids.get(key);
  };
  for (let t = 0; t < mesh.drawn; ++t) {
    const corners = mesh.corners(t), id = corners.map(idOf);
    const normal = unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])));
    for (let i = 0; i < 3; ++i) {
      const j = (i + 1) % 3, key = Math.min(id[i], id[j]) * 2 ** 26 + Math.max(id[i], id[j]);
      if (!found.has(key)) found.set(key, { from: corners[i], to: corners[j], normal, isCrease: true });
      else found.get(key).isCrease = Math.abs(dot(found.get(key).normal, normal)) < 0.866;
    }
  }
  for (const { from, to, isCrease } of found.values()) if (isCrease) lines.push([from, to]);
  return lines;
}

/** Things in a row: of each a mesh, among those that `meshesOf` gives for it, and a pose, world = linear * local + at. */
class Placed {
  constructor(meshesOf, { mesh, linear, at }) {
    Object.assign(this, { meshesOf, mesh, linear, at, count: mesh.length });
    this.centre = new Float64Array(3 * this.count);
    this.radius = new Float64Array(this.count);
    for (let i = 0; i < this.count; ++i) {
      const { middle, half } = this.meshOf(i);
      const sides = [0, 0, 0];
      for (let k = 0; k < 3; ++k) {
        const row = linear.subarray(9 * i + 3 * k, 9 * i + 3 * k + 3);
        this.centre[3 * i + k] = at[3 * i + k] + dot(row, middle);
        sides[k] = row.reduce((sum, value, j) => sum + Math.abs(value) * half[j], 0);
      }
      this.radius[i] = lengthOf(sides);
    }
  }
  meshOf(i) {
    return this.meshesOf(i)[this.mesh[i]];
  }
  centreOf(i) {
    return [...this.centre.subarray(3 * i, 3 * i + 3)];
  }
  /** Whether a triangle crosses a segment, short of its end. */
  crosses(i, from, to) {
    const linear = this.linear.subarray(9 * i, 9 * i + 9), rows = [0, 1, 2].map((k) => [...linear.subarray(3 * k, 3 * k + 3)]);
    const [a, b, c] = rows, columns = [cross(b, c), cross(c, a), cross(a, b)], volume = dot(a, columns[0]);
    if (!(Math.abs(volume) > 0)) return false;
    const toLocal = (v) => [0, 1, 2].map((k) => (v[0] * columns[0][k] + v[1] * columns[1][k] + v[2] * columns[2][k]) / volume);
    const start = toLocal(minus(from, this.at.subarray(3 * i, 3 * i + 3)));
    return this.meshOf(i).isCrossed(start, toLocal(minus(to, from)));
  }
  toWorld(i, point) {
    return [0, 1, 2].map((k) => this.at[3 * i + k] + dot(this.linear.subarray(9 * i + 3 * k, 9 * i + 3 * k + 3), point));
  }
}

function joined(first, second) {
  const all = new first.constructor(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}

class Data {
  constructor(text) {
    Object.assign(this, JSON.parse(text, decodeArray));
    this.meshes = this.meshes.map((mesh) => new Mesh(mesh));
    this.shown = new Map();
    this.sensors = new Placed((i) => this.scene(this.queries.scene[i]).meshes, this.queries);
  }
  /** The meshes of a scene, some deformed; its objects, as Placed; and how each moves during a step. */
  scene(number) {
    if (!this.shown.has(number)) this.shown.set(number, this.makeScene(number));
    return this.shown.get(number);
  }
  makeScene(number) {
    const own = this.scenes[number], base = own.base === null ? null : this.scenes[own.base];
    const meshes = [...this.meshes];
    for (const { mesh, positions } of own.deforms) {
      meshes[mesh] = new Mesh({ ...meshes[mesh], positions });
    }
    const parts = ["mesh", "linear", "at", "number"];
    const objects = Object.fromEntries(parts.map((p) => [p, base ? joined(base[p], own[p]) : own[p]]));
    const placed = new Placed(() => meshes, objects);
    placed.number = objects.number;
    placed.place = new Map([...objects.number].map((object, i) => [object, i]));
    const ways = new Map();
    own.moving.forEach((object, i) => ways.set(placed.place.get(object), own.ways.subarray(3 * i, 3 * i + 3)));
    return { meshes, objects: placed, ways };
  }
  /** What of a scene is near together, and how much is far from it: {bounds, far: {objects, sensors}}. */
  extent(number) {
    const scene = this.scene(number);
    return (scene.extent ??= this.extentOf(number, scene.objects));
  }
  extentOf(number, objects) {
    const things = [], add = (placed, i, way, isSensor) => {
      const place = plus(placed.centreOf(i), times(0.5, way));
      things.push({ place, radius: placed.radius[i] + 0.5 * lengthOf(way), isSensor });
    };
    for (let i = 0; i < objects.count; ++i) add(objects, i, [0, 0, 0], false);
    for (let i = 0; i < this.queries.count; ++i) {
      if (this.queries.scene[i] !== number) continue;
      const share = this.status(i) === "clear" ? 0 : this.share(i);
      add(this.sensors, i, share > 0 ? times(share, this.way(i)) : [0, 0, 0], true);
    }
    const { near, far } = nearTogether(things), bounds = new Bounds(), sensors = far.filter(({ isSensor }) => isSensor).length;
    for (const { place, radius } of near) bounds.add(place, radius);
    return { bounds, far: { objects: far.length - sensors, sensors } };
  }
  /** How far a way leads out of the scene. */
  reach(number) {
    return this.extent(number).bounds.diagonal || 1;
  }
  /** The object that is the query's sensor: ignored, and where it starts. Its place in the scene, or undefined. */
  ownObject(query) {
    this.own ??= Array.from({ length: this.queries.count }, (_, i) => this.findOwn(i));
    return this.own[query];
  }
  findOwn(query) {
    const { objects } = this.scene(this.queries.scene[query]), { sensors } = this;
    const isSame = (i) => i !== undefined && objects.mesh[i] === sensors.mesh[query] &&
      [0, 1, 2].every((k) => objects.at[3 * i + k] === sensors.at[3 * query + k]) &&
      objects.linear.subarray(9 * i, 9 * i + 9).every((value, k) => value === sensors.linear[9 * query + k]);
    return (this.queries.ignored[query] ?? []).map((object) => objects.place.get(object)).find(isSame);
  }
  /** An object's own name, or none. */
  nameOf(scene, object) {
    return this.scenes[scene].names[object] ?? "";
  }
  /** "object 3 (lid)": its own name, or that of its mesh. */
  called(scene, object) {
    const { objects } = this.scene(scene), place = objects.place.get(object);
    const name = this.nameOf(scene, object) || (place === undefined ? "" : objects.meshOf(place).name);
    return `object ${object}${name ? ` (${name})` : ""}`;
  }
  status(query) {
    return this.statuses[this.answers.status[query]];
  }
  /** Its status; "part" if it is clear of all but what was left out. */
  kind(query) {
    const status = this.status(query);
    return status === "clear" && this.left[query] ? "part" : status;
  }
  /** Whether only that is known. */
  saysOnlyWhether(query) {
    return this.queries.any[query] === 1 && this.status(query) === "hit";
  }
  /** When it touches something; NaN if it is not known. */
  time(query) {
    const t = this.answers.t[query];
    return Number.isFinite(t) && !this.saysOnlyWhether(query) && this.status(query) !== "undecided" ? t : NaN;
  }
  /** The latest of these times. */
  get latest() {
    this.latestTime ??= this.answers.t.reduce((latest, _, query) => Math.max(latest, this.time(query) || 0), 0);
    return this.latestTime;
  }
  /** The distance of the surfaces then; NaN if it is not known. */
  gap(query) {
    return this.queries.clearance[query] > 0 && !this.saysOnlyWhether(query) ? this.answers.gap?.[query] ?? NaN : 0;
  }
  vector(name, query) {
    return [...this.answers[name].subarray(3 * query, 3 * query + 3)];
  }
  /**
   * The part of its way that a sensor can go, 0 to 1; of a free way, no more than leads out of the scene. 0 where it is
   * not known.
   */
  share(query) {
    if (this.saysOnlyWhether(query)) return 0;
    switch (this.status(query)) {
      case "hit": return this.fractionOf(query, this.answers.t[query]);
      case "undecided": return this.fractionOf(query, this.answers.lo[query]);
      case "clear": return Math.min(1, this.reach(this.queries.scene[query]) / (lengthOf(this.way(query)) || 1));
    }
    return 0;
  }
  /** The same of another mode's answer, if it touches something; else null. */
  otherShare(query) {
    const other = this.others[query];
    return other && other.t !== null ? this.fractionOf(query, other.t) : null;
  }
  /** The object touched, by this answer or by another mode's. */
  touched(query) {
    const own = this.answers.object[query];
    return own === this.none && this.others[query] ? this.others[query].object : own;
  }
  /** From a time in the unit of t to a part of the way. */
  fractionOf(query, t) {
    const whole = this.queries.whole[query];
    return whole > 0 ? Math.min(t / whole, 1) : 0;
  }
  way(query) {
    return [...this.queries.way.subarray(3 * query, 3 * query + 3)];
  }
}
