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
      let square = 0;
      for (let k = 0; k < 3; ++k) {
        const row = linear.subarray(9 * i + 3 * k, 9 * i + 3 * k + 3);
        this.centre[3 * i + k] = at[3 * i + k] + dot(row, middle);
        square += row.reduce((sum, value, j) => sum + Math.abs(value) * half[j], 0) ** 2;
      }
      this.radius[i] = Math.sqrt(square);
    }
  }
  meshOf(i) {
    return this.meshesOf(i)[this.mesh[i]];
  }
  centreOf(i) {
    return [...this.centre.subarray(3 * i, 3 * i + 3)];
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
  /** The diagonal of the box around a scene's objects and sensors. */
  reach(number) {
    const scene = this.scene(number);
    return (scene.reach ??= this.reachOf(number, scene.objects));
  }
  reachOf(number, objects) {
    const lo = [Infinity, Infinity, Infinity], hi = [-Infinity, -Infinity, -Infinity];
    const add = (placed, i) => {
      for (let k = 0; k < 3; ++k) {
        lo[k] = Math.min(lo[k], placed.centre[3 * i + k] - placed.radius[i]);
        hi[k] = Math.max(hi[k], placed.centre[3 * i + k] + placed.radius[i]);
      }
    };
    for (let i = 0; i < objects.count; ++i) add(objects, i);
    for (let i = 0; i < this.queries.count; ++i) if (this.queries.scene[i] === number) add(this.sensors, i);
    return lo[0] <= hi[0] ? lengthOf(minus(hi, lo)) : 1;
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
  nameOf(query, object) {
    const { names } = this.scenes[this.queries.scene[query]];
    return names[object] ? `${object} (${names[object]})` : `${object}`;
  }
  status(query) {
    return this.statuses[this.answers.status[query]];
  }
  /** The part of its way that a sensor can go, 0 to 1; of a free way, no more than leads out of the scene. */
  share(query) {
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
