// A way of looking at the answers, and what it puts on the stage.

import { COLOURS, MARKS, hashed, viridis } from "./colours.js";
import { frameOf } from "./scopes.js";
import { between, cross, minus, plus, times, unit } from "./vectors.js";
import { inDigits } from "./words.js";

/** @typedef {import("./data.js").Answer} Answer */

// Of moments in a list.
const MOST_LABELS = 20;

/** A way of looking at the answers: which queries, how far along their ways, and what is chosen. */
export class Look {
  /** @param {import("./data.js").Data} data */
  constructor(data) {
    this.data = data;
    this.scene = data.queries.count ? data.queries.scene[0] : 0;
    /** A query; -1: none. */
    this.chosen = -1;
    /** Which of the moments that it lists is looked at; -1: its answer. */
    this.contact = -1;
    /** Where it is in the scene; -1: none. */
    this.object = -1;
    /** @type {number[]} queries that the table shows */
    this.visible = [];
    this.time = 1;
    this.alone = false;
    this.by = "status";
  }

  /** What is looked at of a query: its answer, or of the chosen one a contact that it lists; undefined of no query. */
  answerTo(query) {
    const answer = this.data.answers[query];
    return query === this.chosen && this.contact >= 0 ? answer.moments[this.contact] : answer;
  }
  get answer() {
    return this.answerTo(this.chosen);
  }
  /** The part of its way that a query's sensor has gone. */
  gone(query) {
    const { share } = this.answerTo(query);
    return this.alone && query === this.chosen ? this.time * share : Math.min(this.time, share);
  }
  /** The part of the step that has passed, for objects. */
  passed() {
    return this.chosen >= 0 && this.alone ? this.gone(this.chosen) : this.time;
  }

  colourOf(query) {
    const { data, by } = this, { time, object, kind } = data.answers[query];
    if (by === "t") return Number.isNaN(time) ? COLOURS.invalid : viridis(time / (data.latest || 1));
    if (by === "object") {
      const own = data.ownObject(query), number = own === undefined ? object : data.scene(this.scene).numbers[own];
      return number === data.none ? COLOURS.invalid : hashed(number);
    }
    return COLOURS[kind];
  }

  /** The place that nothing is to hide: of the chosen sensor's contact, or where it stops. */
  seen() {
    const { data, answer, chosen } = this;
    if (!answer) return null;
    return answer.hasPoint ? answer.point : data.placeAt(chosen, answer.share);
  }

  /** Puts everything on a stage. */
  fill(stage) {
    const { data, chosen } = this, shown = this.visible.filter((query) => data.queries.scene[query] === this.scene);
    const drawn = this.alone && chosen >= 0 ? [chosen] : shown, seen = this.seen();
    this.fillObjects(stage, seen, new Set(drawn.map((query) => data.ownObject(query))));
    // Many marks and lines are small and pale, or they would hide the rest.
    const crowd = Math.min(1, Math.sqrt(150 / drawn.length));
    for (const query of drawn) this.fillSensor(stage, query, seen, crowd);
    if (chosen >= 0 && !drawn.includes(chosen)) this.fillSensor(stage, chosen, seen, 1);
  }

  /** `moving`: those that are drawn as sensors. */
  fillObjects(stage, seen, moving) {
    const { data, chosen } = this, { objects, numbers, place: places, ways } = data.scene(this.scene);
    const passed = this.passed(), rest = [0, 0, 0], touched = places.get(this.answer?.touched);
    const ignored = new Set(data.queries.ignored[chosen]), left = new Set(data.left[chosen]);
    const rank = new Map((data.answers[chosen]?.moments ?? []).map(({ object }, i) => [object, i + 1]));
    for (let i = 0; i < objects.count; ++i) {
      if (moving.has(i)) continue;
      const number = numbers[i], isLeft = left.has(number), isTouched = i === touched || i === this.object;
      const isMarked = isTouched || isLeft || rank.has(number);
      let colour = this.by === "object" ? hashed(number) : COLOURS.object;
      if (isMarked) colour = isLeft ? COLOURS.part : isTouched ? COLOURS.touched : COLOURS.listed;
      const moved = ways.has(i) ? times(passed, ways.get(i)) : rest;
      const isGlass = isLeft || ignored.has(number) || (seen && stage.hides(objects, i, moved, seen));
      if (isGlass) stage.glass(objects, i, moved, colour, isMarked);
      else stage.add(objects, i, moved, colour, 1 + i);
      if (!isMarked) continue;
      const place = plus(objects.centreOf(i), moved);
      if (objects.radius[i] < 0.02 * stage.camera.distance) stage.mark(place, colour, 22, "ring");
      if (!isTouched && !isLeft && rank.get(number) > MOST_LABELS) continue;
      const name = data.called(this.scene, number), label = rank.has(number) ? `${rank.get(number)}: ${name}` : name;
      stage.label(minus(place, times(0.7 * objects.radius[i], stage.up)), isLeft ? `${label}, left out` : label);
    }
  }

  fillSensor(stage, query, seen, crowd) {
    const { data, chosen } = this, isChosen = query === chosen;
    const { kind, hasPoint, saysOnlyWhether, share } = this.answerTo(query);
    const colour = this.colourOf(query), isPale = chosen >= 0 && !isChosen;
    if (isChosen) this.explain(stage, this.answer);
    if (kind !== "invalid") {
      const isSeen = isChosen && !hasPoint, shade = isPale ? between(colour, [0.9, 0.9, 0.92], 0.4) : colour;
      for (const { placed, i, moved } of data.bodiesAt(query, this.gone(query))) {
        if (seen && !isSeen && stage.hides(placed, i, moved, seen)) stage.glass(placed, i, moved, colour, isChosen);
        else stage.add(placed, i, moved, shade, this.numberOf(query));
      }
    }
    if (crowd < Math.sqrt(150 / 2000) && !isChosen) return;
    const path = data.path(query, 0, saysOnlyWhether ? 1 : share);
    const dash = { clear: 6, part: 6, undecided: 2 }[kind] ?? (saysOnlyWhether ? 3 : 0);
    stage.path(path, isChosen ? colour : [...colour, isPale ? 0.5 * crowd : crowd], isChosen ? 3 : 1.5, dash);
    stage.mark(saysOnlyWhether ? path[0] : path.at(-1), colour, isChosen ? 11 : Math.max(3, 7 * crowd), MARKS[kind]);
  }
  /** For picking. */
  numberOf(query) {
    return 1 + this.data.scene(this.scene).objects.count + query;
  }

  /** The chosen query: where its sensor starts, its bracket, what it touches. */
  explain(stage, /** @type {Answer} */ answer) {
    const { data, chosen } = this, { sensors } = data;
    const { share, saysOnlyWhether: whether, otherShare: other } = answer;
    for (const { placed, i, moved } of share > 0 ? data.bodiesAt(chosen, 0) : []) {
      stage.glass(placed, i, moved, COLOURS[answer.kind], true);
    }
    const at = (part) => data.placeAt(chosen, part);
    if (!whether) stage.path(data.path(chosen, share, Math.max(share, data.shareInReach(chosen))), [...COLOURS.path, 0.5], 1.5, 4);
    for (const t of whether ? [] : [answer.lo, answer.hi]) {
      if (!Number.isFinite(t)) continue;
      const part = data.fractionOf(chosen, t), tick = at(part);
      const across = times(0.25 * sensors.radius[chosen], unit(cross(data.heading(chosen, part), stage.forward)));
      stage.line(minus(tick, across), plus(tick, across), COLOURS.path, 2);
    }
    for (const contact of data.answers[chosen].moments) stage.mark(at(contact.share), COLOURS.listed, 9, "ring");
    this.explainContact(stage, answer);
    if (other !== null && Math.abs(other - share) > 1e-3) {
      const [{ placed, i, moved }] = data.bodiesAt(chosen, other);
      stage.glass(placed, i, moved, COLOURS.path, false);
      stage.mark(at(other), COLOURS.path, 13, "ring");
    }
    const scopes = data.scopes[chosen];
    if (scopes) {
      for (const [a, b] of frameOf(scopes)) stage.line(a, b, COLOURS.normal, 1.5);
    }
  }

  explainContact(stage, /** @type {Answer} */ answer) {
    const { triA, triB, share, point, hasPoint, normal, hasNormal, gap } = answer;
    const { data, chosen } = this, { sensors } = data, { objects, place: places, ways } = data.scene(this.scene);
    const object = places.get(answer.object), bodies = data.bodiesAt(chosen, share), own = bodies[Math.max(answer.body, 0)];
    const way = ways.get(object), moved = way ? times(share, way) : [0, 0, 0];
    const other = object === undefined ? bodies[answer.otherBody] : { placed: objects, i: object, moved };
    if (!other || !own) return;
    const triangles = [];
    for (const [body, triangle] of /** @type {const} */ ([[own, triA], [other, triB]])) {
      const mesh = body.placed.meshOf(body.i);
      // A mesh of which the page has only the box, or which is drawn as a ball or cutter, has other triangles.
      if (triangle === data.none || mesh.isBox || mesh.isRound || mesh.parts) continue;
      triangles.push(mesh.corners(triangle).map((corner) => plus(body.placed.toWorld(body.i, corner), body.moved)));
    }
    for (const corners of triangles) {
      stage.triangle(corners, COLOURS.triangle);
      for (let k = 0; k < 3; ++k) stage.line(corners[k], corners[(k + 1) % 3], COLOURS.path, 2);
    }
    if (!hasPoint) return;
    stage.mark(point, [0, 0, 0], 9, "disc");
    if (!hasNormal) return;
    if (gap > 0) {
      const end = plus(point, times(gap, normal));
      stage.line(point, end, COLOURS.gap, 4);
      stage.mark(end, [0, 0, 0], 9, "disc");
      stage.label(between(point, end, 0.5), inDigits(gap, 4));
      return;
    }
    // Where the length of a gap is not known, a normal would be taken for it.
    if (Number.isNaN(gap)) return;
    const tip = plus(point, times(0.8 * sensors.radius[chosen], normal));
    stage.line(point, tip, COLOURS.normal, 3);
    stage.mark(tip, COLOURS.normal, 8, "diamond");
  }
}
