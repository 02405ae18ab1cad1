// What the page shows, decoded: scenes, queries and their answers.

import { bodiesOf, linkPose, partsOf, placedBy, product } from "./chains.js";
import { Bounds, nearTogether } from "./extent.js";
import { Mesh, Placed } from "./meshes.js";
import { between, lengthOf, minus, plus, times, turned } from "./vectors.js";

/**
 * What page.cpp writes, of n things n numbers, or as many times as many as stated. By query: only of those that have some.
 * @typedef {import("./meshes.js").Poses} Poses
 * @typedef {Poses & {id: string, base: ?number, number: Uint32Array, names: Record<number, string>, moving: Uint32Array,
 *   ways: Float64Array, deforms: {mesh: number, positions: Float32Array}[]}} SceneRow  ways: 3
 * @typedef {Poses & {count: number, id: string[], scene: Uint32Array, way: Float64Array, whole: Float64Array,
 *   step: Uint8Array, turns: Record<number, {axis: number[], angle: number, centre: number[]}>, ignored: Record<number, number[]>,
 *   moves: Record<number, import("./chains.js").Move>, asked: Record<number, Record<string, number | string | boolean>>}} Queries
 *   way: 3; asked: options given
 * @typedef {{status: Uint8Array, t: Float64Array, lo: Float64Array, hi: Float64Array, object: Uint32Array,
 *   tri_a: Uint32Array, tri_b: Uint32Array, point: Float64Array, normal: Float64Array, gap: Float64Array,
 *   as?: Uint8Array, link?: Uint32Array, mesh?: Uint32Array, other_link?: Uint32Array, other_mesh?: Uint32Array}} Answers
 *   point, normal: 3; as: of moments alone; where there are chains, links and which of their meshes
 * @typedef {{width: number, height: number, pixel: number, d: number, length: number, R: Float32Array, M: Float32Array,
 *   L: Float32Array, origin: number[], right: number[], up: number[], forward: number[]}} Scopes
 * @typedef {{title: string, notes: string[], tour: {query?: number, play?: string}[], none: number, statuses: string[],
 *   meshes: object[], chains: import("./chains.js").Chain[], scenes: SceneRow[], queries: Queries, answers: Answers,
 *   moments: Answers & {first: Uint32Array}, left: Record<number, number[]>,
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

// What a chain without meshes shows.
const NOTHING = new Mesh({ name: "no mesh", positions: new Float32Array(3), indices: new Uint32Array(3) });

function joined(first, second) {
  const all = new first.constructor(first.length + second.length);
  all.set(first);
  all.set(second, first.length);
  return all;
}

/** An answer to a query, or a moment of its way that it lists. Ids are Data.none, numbers NaN, where there is none. */
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
    /** Of what is listed: a contact, the closest approach, or the last contact. */
    this.as = isListed ? ["contact", "closest", "exit"][from.as?.[i] ?? 0] : "";
    /** @type {?Answer[]} */
    this.list = null;
    this.status = data.statuses[from.status[i]];
    this.t = from.t[i];
    this.lo = from.lo[i];
    this.hi = from.hi[i];
    this.object = from.object[i];
    /** Of a chain: which body touches something, and which other one, if it is none of the scene's; else -1. */
    this.body = data.bodyOf(query, from.link?.[i], from.mesh?.[i]);
    this.otherBody = data.bodyOf(query, from.other_link?.[i], from.other_mesh?.[i]);
    this.triA = from.tri_a[i];
    this.triB = from.tri_b[i];
    this.point = [...from.point.subarray(3 * i, 3 * i + 3)];
    this.normal = [...from.normal.subarray(3 * i, 3 * i + 3)];
    this.hasPoint = this.point.every(Number.isFinite);
    this.hasNormal = this.normal.every(Number.isFinite);
    /** Whether only that is known. */
    this.saysOnlyWhether = this.status === "hit" && asked.any_hit === true && !isListed;
    /** When it touches something; NaN if it is not known. */
    this.time = Number.isFinite(this.t) && !this.saysOnlyWhether && this.status !== "undecided" ? this.t : NaN;
    const { isRound, radius } = data.sensors.meshOf(query);
    /** Beyond the surface that is drawn. */
    this.clearance = Number(asked.clearance ?? 0) + (isRound ? 0 : radius);
    /** Counts only what blocks. */
    this.leaves = asked.ignore_leaving === true;
    /** The distance of the surfaces then; NaN if it is not known. */
    this.gap = this.as === "closest" || (this.clearance > 0 && !this.saysOnlyWhether) ? from.gap[i] - (isRound ? radius : 0) : 0;
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
  /** The moments that the query lists: the first contacts with several objects, the closest approach, the last contact. */
  get moments() {
    return (this.list ??= this.listed());
  }
  /** @returns {Answer[]} */
  listed() {
    const { data, query } = this, { moments } = data, begin = moments.first[query], count = moments.first[query + 1] - begin;
    const all = Array.from({ length: count }, (_, i) => new Answer(data, query, moments, begin + i, true));
    // One contact is the answer itself.
    return all.filter(({ as }) => as === "contact").length > 1 ? all : all.filter(({ as }) => as !== "contact");
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
    this.chains = written.chains.map((chain) => ({ ...chain, bodies: bodiesOf(chain) }));
    this.scenes = written.scenes;
    this.queries = written.queries;
    this.moments = written.moments;
    this.left = written.left;
    this.reasons = written.reasons;
    this.others = written.others;
    this.scopes = written.scopes;
    this.meshes = written.meshes.map((mesh) => new Mesh(/** @type {Mesh} */ (mesh)));
    /** @type {Map<number, ReturnType<Data["makeScene"]>>} */
    this.shown = new Map();
    // A chain's place among sensors is that of a mesh of it: the one that touches something, or the last one.
    for (const query in this.queries.moves) this.putBody(Number(query), written.answers);
    this.sensors = new Placed((i) => this.scene(this.queries.scene[i]).meshes, this.queries);
    this.answers = Array.from({ length: this.queries.count }, (_, query) => new Answer(this, query, written.answers, query));
    /**
     * Of each query the last that bodiesAt() made.
     * @type {Map<number, {share: number, bodies: {placed: Placed, i: number, moved: number[]}[]}>}
     */
    this.turnedBodies = new Map();
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
      const balls = this.swept(query, status === "clear" ? 0 : answer.share);
      const place = between(balls[0].place, balls.at(-1).place, 0.5);
      const radius = balls.reduce((most, ball) => Math.max(most, ball.radius + lengthOf(minus(ball.place, place))), 0);
      things.push({ place, radius, isSensor: true });
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
  /** Of a chain, where that mesh of it is that stands among the sensors. */
  placeAt(query, share) {
    const move = this.queries.moves[query];
    if (!move) return this.moved(query, this.sensors.centreOf(query), share);
    const chain = this.chains[move.chain], body = chain.bodies[this.shownBody(query)];
    if (!body) return placedBy(move.base, [0, 0, 0]);
    return placedBy(product(linkPose(chain, move, share, body.link), body.pose), this.sensors.meshOf(query).middle);
  }
  /** Points of its way from a part to another, joined by lines. */
  path(query, from, to) {
    const turn = this.queries.turns[query], move = this.queries.moves[query];
    let parts = turn ? Math.min(Math.max(2, Math.ceil(5 * Math.abs(turn.angle * (to - from)))), 400) : 1;
    if (move) parts = partsOf(this.chains[move.chain], move, to - from);
    return Array.from({ length: parts + 1 }, (_, i) => this.placeAt(query, from + (i / parts) * (to - from)));
  }
  /** Balls around its meshes, at places of its way up to a part. */
  swept(query, share) {
    const move = this.queries.moves[query];
    if (!move) return this.path(query, 0, share).map((place) => ({ place, radius: this.sensors.radius[query] }));
    const bodies = [0, 0.25, 0.5, 0.75, 1].flatMap((part) => this.bodiesAt(query, part * share));
    const balls = bodies.map(({ placed, i }) => ({ place: placed.centreOf(i), radius: placed.radius[i] }));
    return [{ place: placedBy(move.base, [0, 0, 0]), radius: 0 }, ...balls];
  }
  /** Where it goes from there. */
  heading(query, share) {
    const h = 1e-4;
    const bends = this.queries.turns[query] || this.queries.moves[query];
    return bends ? minus(this.placeAt(query, share + h), this.placeAt(query, share - h)) : this.way(query);
  }
  /** What moves: one sensor, or a chain's meshes. Of each what is placed, its number there, and how far it has moved. */
  bodiesAt(query, share) {
    const { sensors } = this, turn = this.queries.turns[query], move = this.queries.moves[query], rest = [0, 0, 0];
    if (!move && (!turn || share === 0)) return [{ placed: sensors, i: query, moved: times(share, this.way(query)) }];
    const last = this.turnedBodies.get(query);
    if (last?.share === share) return last.bodies;
    const poses = move ? this.posesOf(move, share) : this.turnedPose(query, share);
    const placed = new Placed(() => sensors.meshesOf(query), poses);
    const bodies = Array.from({ length: placed.count }, (_, i) => ({ placed, i, moved: rest }));
    this.turnedBodies.set(query, { share, bodies });
    return bodies;
  }
  turnedPose(query, share) {
    const { sensors } = this, turn = this.queries.turns[query];
    const linear = new Float32Array(9), mesh = sensors.mesh.subarray(query, query + 1);
    for (let column = 0; column < 3; ++column) {
      const axis = [0, 1, 2].map((k) => sensors.linear[9 * query + 3 * k + column]);
      turned(turn, axis, share).forEach((value, k) => (linear[3 * k + column] = value));
    }
    return { mesh, linear, at: new Float64Array(this.moved(query, sensors.at.subarray(3 * query, 3 * query + 3), share)) };
  }

  // Chains

  /** Of all meshes of a chain. */
  posesOf(/** @type {import("./chains.js").Move} */ move, share) {
    const chain = this.chains[move.chain], of = chain.links.map((_, link) => linkPose(chain, move, share, link));
    const poses = chain.bodies.map(({ link, pose }) => product(of[link], pose));
    return {
      mesh: new Uint32Array(chain.bodies.map(({ mesh }) => mesh)),
      linear: new Float32Array(poses.flatMap((pose) => pose.filter((_, k) => k % 4 < 3))),
      at: new Float64Array(poses.flatMap((pose) => pose.filter((_, k) => k % 4 === 3))),
    };
  }
  /** A mesh of a link among all of its chain; -1: none. */
  bodyOf(query, link, mesh) {
    const move = this.queries.moves[query];
    return move ? this.chains[move.chain].bodies.findIndex((body) => body.link === link && body.number === mesh) : -1;
  }
  /** The one that stands among the sensors. */
  shownBody(query) {
    const { body } = this.answers[query];
    return body < 0 ? this.chains[this.queries.moves[query].chain].bodies.length - 1 : body;
  }
  /** Its name, or none. */
  linkName(query, body) {
    const chain = body < 0 ? null : this.chains[this.queries.moves[query].chain];
    return chain ? chain.links[chain.bodies[body].link].name : "";
  }
  putBody(query, /** @type {Answers} */ { link, mesh }) {
    const { queries } = this, move = queries.moves[query], poses = this.posesOf(move, 0);
    const found = this.bodyOf(query, link[query], mesh[query]), body = found < 0 ? poses.mesh.length - 1 : found;
    if (body < 0) {
      queries.mesh[query] = this.meshes.push(NOTHING) - 1;
      queries.linear.set([1, 0, 0, 0, 1, 0, 0, 0, 1], 9 * query);
      queries.at.set([3, 7, 11].map((k) => move.base[k]), 3 * query);
      return;
    }
    queries.mesh[query] = poses.mesh[body];
    queries.linear.set(poses.linear.subarray(9 * body, 9 * body + 9), 9 * query);
    queries.at.set(poses.at.subarray(3 * body, 3 * body + 3), 3 * query);
  }
}
