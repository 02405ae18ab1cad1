// What the page shows, decoded: scenes, queries and their answers.

import { Bounds, nearTogether } from "./extent.js";
import { Mesh, Placed } from "./meshes.js";
import { between, cross, lengthOf, minus, plus, times, unit } from "./vectors.js";

/**
 * What page.cpp writes, of n things n numbers, or as many times as many as stated. By query: only of those that have some.
 * @typedef {import("./meshes.js").Poses} Poses
 * @typedef {Poses & {id: string, base: ?number, number: Uint32Array, names: Record<number, string>, moving: Uint32Array,
 *   ways: Float64Array, deforms: {mesh: number, positions: Float32Array}[]}} SceneRow  ways: 3
 * @typedef {Poses & {count: number, id: string[], scene: Uint32Array, way: Float64Array, whole: Float64Array,
 *   step: Uint8Array, turns: Record<number, {axis: number[], angle: number, centre: number[]}>, ignored: Record<number, number[]>,
 *   asked: Record<number, Record<string, number | string | boolean>>}} Queries  way: 3; asked: options given
 * @typedef {{status: Uint8Array, t: Float64Array, lo: Float64Array, hi: Float64Array, object: Uint32Array,
 *   tri_a: Uint32Array, tri_b: Uint32Array, point: Float64Array, normal: Float64Array, gap: Float64Array}} Answers
 *   point, normal: 3
 * @typedef {{width: number, height: number, pixel: number, d: number, length: number, R: Float32Array, M: Float32Array,
 *   L: Float32Array, origin: number[], right: number[], up: number[], forward: number[]}} Scopes
 * @typedef {{title: string, notes: string[], tour: {query?: number, play?: string}[], none: number, statuses: string[],
 *   meshes: object[], scenes: SceneRow[], queries: Queries, answers: Answers,
 *   hits: Answers & {first: Uint32Array}, left: Record<number, number[]>,
 *   reasons: Record<number, string>, others: Record<number, {words: string, t: ?number, object: number}>,
 *   scopes: Record<number, Scopes>}} Written
 */

// {"f4": "..."}: little-endian numbers in base64, of the type that numpy calls so.
const ARRAYS = { u1: Uint8Array, u4: Uint32Array, f4: Float32Array, f8: Float64Array };

function decodeArray(_, value) {
  for (const type in ARRAYS) {
    if (typeof value?.[type] !== "string") continue;
    const text = atob(value[type]);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = text.charCodeAt(i);
    return new ARRAYS[type](bytes.buffer);
  }
  return value;
}

function joined(first, second) {
  const all = new first.constructor(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}

/** A vector after a part of a turn, by O. Rodrigues. */
function turned({ axis, angle }, vector, share) {
  const by = share * angle, longest = Math.max(...axis.map(Math.abs)) || 1, along = unit(axis.map((x) => x / longest));
  const across = cross(along, vector), inwards = cross(along, across);
  return plus(vector, plus(times(Math.sin(by), across), times(2 * Math.sin(by / 2) ** 2, inwards)));
}

/** An answer to a query, or a contact that it lists. Ids are Data.none, numbers NaN, where there is none. */
export class Answer {
  /**
   * @param {Data} data
   * @param {number} query
   * @param {Answers} from
   * @param {number} i
   * @param {boolean} isListed
   */
  constructor(data, query, from, i, isListed = false) {
    const asked = data.queries.asked[query] ?? {};
    this.data = data;
    this.query = query;
    this.isListed = isListed;
    /** @type {?Answer[]} */
    this.list = null;
    this.status = data.statuses[from.status[i]];
    this.t = from.t[i];
    this.lo = from.lo[i];
    this.hi = from.hi[i];
    this.object = from.object[i];
    this.triA = from.tri_a[i];
    this.triB = from.tri_b[i];
    this.point = [...from.point.subarray(3 * i, 3 * i + 3)];
    this.normal = [...from.normal.subarray(3 * i, 3 * i + 3)];
    this.hasPoint = this.point.every(Number.isFinite);
    this.hasNormal = this.normal.every(Number.isFinite);
    /** Whether only that is known. */
    this.saysOnlyWhether = this.status === "hit" && asked.any_hit === true;
    /** When it touches something; NaN if it is not known. */
    this.time = Number.isFinite(this.t) && !this.saysOnlyWhether && this.status !== "undecided" ? this.t : NaN;
    this.clearance = Number(asked.clearance ?? 0);
    /** Counts only what blocks. */
    this.leaves = asked.ignore_leaving === true;
    /** The distance of the surfaces then; NaN if it is not known. */
    this.gap = this.clearance > 0 && !this.saysOnlyWhether ? from.gap[i] : 0;
    /** Of its bracket; NaN if it says nothing. */
    this.width = this.saysOnlyWhether ? NaN : this.hi - this.lo;
  }
  /** Its status; "part" if it is clear of all but what was left out. */
  get kind() {
    return this.status === "clear" && this.data.left[this.query] ? "part" : this.status;
  }
  /**
   * The part of its way that a sensor can go, 0 to 1; of a free way, no more than leads out of the scene. 0 where it is
   * not known.
   */
  get share() {
    const { data, query } = this;
    if (this.saysOnlyWhether) return 0;
    switch (this.status) {
      case "hit": return data.fractionOf(query, this.t);
      case "undecided": return data.fractionOf(query, this.lo);
      case "clear": return data.shareInReach(query);
    }
    return 0;
  }
  /** The same of another mode's answer, if it touches something; else null. */
  get otherShare() {
    const other = this.data.others[this.query];
    return other && other.t !== null ? this.data.fractionOf(this.query, other.t) : null;
  }
  /** The first contacts with the nearest objects, if the query lists several. @returns {Answer[]} */
  get contacts() {
    const { data, query } = this, { hits } = data, begin = hits.first[query], count = hits.first[query + 1] - begin;
    const contact = (_, i) => new Answer(data, query, hits, begin + i, true);
    return (this.list ??= count < 2 ? [] : Array.from({ length: count }, contact));
  }
  /** The object touched, by this answer or by another mode's. */
  get touched() {
    const other = this.data.others[this.query];
    return this.object === this.data.none && other ? other.object : this.object;
  }
}

export class Data {
  /** @param {string} text */
  constructor(text) {
    /** @type {Written} */
    const written = JSON.parse(text, decodeArray);
    this.title = written.title;
    this.notes = written.notes;
    this.tour = written.tour;
    this.none = written.none;
    this.statuses = written.statuses;
    this.scenes = written.scenes;
    this.queries = written.queries;
    this.hits = written.hits;
    this.left = written.left;
    this.reasons = written.reasons;
    this.others = written.others;
    this.scopes = written.scopes;
    this.meshes = written.meshes.map((mesh) => new Mesh(/** @type {Mesh} */ (mesh)));
    /** @type {Map<number, ReturnType<Data["makeScene"]>>} */
    this.shown = new Map();
    this.sensors = new Placed((i) => this.scene(this.queries.scene[i]).meshes, this.queries);
    this.answers = Array.from({ length: this.queries.count }, (_, query) => new Answer(this, query, written.answers, query));
    /**
     * Of each query the last that sensorAt() made.
     * @type {Map<number, {share: number, placed: Placed, i: number, moved: number[]}>}
     */
    this.turnedSensors = new Map();
    /** @type {?number[]} */
    this.own = null;
    /** The latest of their times. */
    this.latest = this.answers.reduce((latest, { time }) => Math.max(latest, time || 0), 0);
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
    const both = (part) => (base ? joined(base[part], own[part]) : own[part]);
    const objects = new Placed(() => meshes, { mesh: both("mesh"), linear: both("linear"), at: both("at") });
    /** @type {Uint32Array} */
    const numbers = both("number");
    /** From the number of an object to where it is in `objects`. */
    const place = new Map([...numbers].map((object, i) => [object, i]));
    const ways = new Map();
    own.moving.forEach((object, i) => ways.set(place.get(object), own.ways.subarray(3 * i, 3 * i + 3)));
    /** @type {?ReturnType<Data["extentOf"]>} */
    const extent = null;
    return { meshes, objects, numbers, place, ways, extent };
  }
  /** What of a scene is near together, and how much is far from it: {bounds, far: {objects, sensors}}. */
  extent(number) {
    const scene = this.scene(number);
    return (scene.extent ??= this.extentOf(number, scene.objects));
  }
  extentOf(number, objects) {
    const things = [];
    for (let i = 0; i < objects.count; ++i) things.push({ place: objects.centreOf(i), radius: objects.radius[i], isSensor: false });
    for (const answer of this.answers) {
      const { query, status } = answer;
      if (this.queries.scene[query] !== number) continue;
      const path = this.path(query, 0, status === "clear" ? 0 : answer.share), place = between(path[0], path.at(-1), 0.5);
      const reach = path.reduce((most, point) => Math.max(most, lengthOf(minus(point, place))), 0);
      things.push({ place, radius: this.sensors.radius[query] + reach, isSensor: true });
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
    const { objects, place } = this.scene(this.queries.scene[query]), { sensors } = this;
    const isSame = (i) => i !== undefined && objects.mesh[i] === sensors.mesh[query] &&
      [0, 1, 2].every((k) => objects.at[3 * i + k] === sensors.at[3 * query + k]) &&
      objects.linear.subarray(9 * i, 9 * i + 9).every((value, k) => value === sensors.linear[9 * query + k]);
    return (this.queries.ignored[query] ?? []).map((object) => place.get(object)).find(isSame);
  }
  /** An object's own name, or none. */
  nameOf(scene, object) {
    return this.scenes[scene].names[object] ?? "";
  }
  /** "object 3 (lid)": its own name, or that of its mesh. */
  called(scene, object) {
    const { objects, place } = this.scene(scene), i = place.get(object);
    const name = this.nameOf(scene, object) || (i === undefined ? "" : objects.meshOf(i).name);
    return `object ${object}${name ? ` (${name})` : ""}`;
  }
  /** From a time in the unit of t to a part of the way. */
  fractionOf(query, t) {
    const whole = this.queries.whole[query];
    return whole > 0 ? Math.min(t / whole, 1) : 0;
  }
  way(query) {
    return [...this.queries.way.subarray(3 * query, 3 * query + 3)];
  }
  /** The part of a way that leads no farther than out of the scene. */
  shareInReach(query) {
    const length = lengthOf(this.way(query)), reach = this.reach(this.queries.scene[query]);
    return length > reach ? reach / length : 1;
  }

  // Where a query's sensor is after a part of its way, during which it may turn

  /** Where something of it is that starts at a place. */
  moved(query, place, share) {
    const way = times(share, this.way(query)), turn = this.queries.turns[query];
    return plus(turn ? plus(turn.centre, turned(turn, minus(place, turn.centre), share)) : place, way);
  }
  placeAt(query, share) {
    return this.moved(query, this.sensors.centreOf(query), share);
  }
  /** Points of its way from a part to another, joined by lines. */
  path(query, from, to) {
    const turn = this.queries.turns[query];
    const parts = turn ? Math.min(Math.max(2, Math.ceil(5 * Math.abs(turn.angle * (to - from)))), 400) : 1;
    return Array.from({ length: parts + 1 }, (_, i) => this.placeAt(query, from + (i / parts) * (to - from)));
  }
  /** Where it goes from there. */
  heading(query, share) {
    const h = 1e-4;
    return this.queries.turns[query] ? minus(this.placeAt(query, share + h), this.placeAt(query, share - h)) : this.way(query);
  }
  /** What is placed, its number there, and how far it has moved from there. */
  sensorAt(query, share) {
    const { sensors } = this, turn = this.queries.turns[query];
    if (!turn || share === 0) return { placed: sensors, i: query, moved: times(share, this.way(query)) };
    const last = this.turnedSensors.get(query);
    if (last?.share === share) return last;
    const linear = new Float32Array(9), mesh = sensors.mesh.subarray(query, query + 1);
    for (let column = 0; column < 3; ++column) {
      const axis = [0, 1, 2].map((k) => sensors.linear[9 * query + 3 * k + column]);
      turned(turn, axis, share).forEach((value, k) => (linear[3 * k + column] = value));
    }
    const at = new Float64Array(this.moved(query, sensors.at.subarray(3 * query, 3 * query + 3), share));
    const placed = new Placed(() => sensors.meshesOf(query), { mesh, linear, at });
    const found = { share, placed, i: 0, moved: [0, 0, 0] };
    this.turnedSensors.set(query, found);
    return found;
  }
}
