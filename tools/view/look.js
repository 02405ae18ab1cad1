// A way of looking at the answers, and what it puts on the stage.

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
    const { data, by } = this, { object } = data.answers;
    if (by === "t") {
      const time = data.time(query);
      return Number.isNaN(time) ? COLOURS.invalid : viridis(time / (data.latest || 1));
    }
    if (by === "object") {
      const own = data.ownObject(query), number = own === undefined ? object[query] : data.scene(this.scene).objects.number[own];
      return number === data.none ? COLOURS.invalid : hashed(number);
    }
    return COLOURS[data.kind(query)];
  }

  /** The place that nothing is to hide: of the chosen sensor's contact, or where it stops. */
  seen() {
    const { data, chosen } = this;
    if (chosen < 0) return null;
    const point = data.vector("point", chosen);
    return point.every(Number.isFinite) ? point : plus(data.sensors.centreOf(chosen), times(data.share(chosen), data.way(chosen)));
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
    const { data, chosen } = this, { objects, ways } = data.scene(this.scene), passed = this.passed(), rest = [0, 0, 0];
    const touched = chosen >= 0 ? objects.place.get(data.touched(chosen)) : undefined;
    const ignored = new Set(data.queries.ignored[chosen]), left = new Set(data.left[chosen]);
    for (let i = 0; i < objects.count; ++i) {
      if (moving.has(i)) continue;
      const number = objects.number[i], isLeft = left.has(number), isMarked = i === touched || i === this.object || isLeft;
      let colour = this.by === "object" ? hashed(number) : COLOURS.object;
      if (isMarked) colour = isLeft ? COLOURS.part : COLOURS.touched;
      const moved = ways.has(i) ? times(passed, ways.get(i)) : rest;
      const isGlass = isLeft || ignored.has(number) || (seen && stage.hides(objects, i, moved, seen));
      if (isGlass) stage.glass(objects, i, moved, colour, isMarked);
      else stage.add(objects, i, moved, colour, 1 + i);
      if (!isMarked) continue;
      const place = plus(objects.centreOf(i), moved);
      if (objects.radius[i] < 0.02 * stage.camera.distance) stage.mark(place, colour, 22, "ring");
      stage.label(minus(place, times(0.7 * objects.radius[i], stage.up)), isLeft ? `${data.called(this.scene, number)}, left out` : data.called(this.scene, number));
    }
  }

  fillSensor(stage, query, seen, crowd) {
    const { data, chosen } = this, { sensors } = data, way = data.way(query), isChosen = query === chosen;
    const colour = this.colourOf(query), isPale = chosen >= 0 && !isChosen, status = data.status(query), kind = data.kind(query);
    if (isChosen) this.explain(stage, data.scene(this.scene));
    if (status !== "invalid") {
      const moved = times(this.gone(query), way);
      const isSeen = isChosen && !data.vector("point", query).every(Number.isFinite);
      if (seen && !isSeen && stage.hides(sensors, query, moved, seen)) stage.glass(sensors, query, moved, colour, isChosen);
      else stage.add(sensors, query, moved, isPale ? between(colour, [0.9, 0.9, 0.92], 0.4) : colour, this.numberOf(query));
    }
    if (crowd < Math.sqrt(150 / 2000) && !isChosen) return;
    const start = sensors.centreOf(query), share = data.saysOnlyWhether(query) ? 1 : data.share(query);
    const end = plus(start, times(share, way)), dash = { clear: 6, part: 6, undecided: 2 }[kind] ?? (data.saysOnlyWhether(query) ? 3 : 0);
    stage.line(start, end, isChosen ? colour : [...colour, isPale ? 0.5 * crowd : crowd], isChosen ? 3 : 1.5, dash);
    const place = data.saysOnlyWhether(query) ? start : end;
    stage.mark(place, colour, isChosen ? 11 : Math.max(3, 7 * crowd), MARKS[kind]);
  }
  /** For picking. */
  numberOf(query) {
    return 1 + this.data.scene(this.scene).objects.count + query;
  }

  /** The chosen query: where its sensor starts, its bracket, what it touches. */
  explain(stage, { objects, ways }) {
    const { data, chosen } = this, { sensors, answers } = data, way = data.way(chosen);
    const colour = COLOURS[data.kind(chosen)], start = sensors.centreOf(chosen), whether = data.saysOnlyWhether(chosen);
    if (data.share(chosen) > 0) stage.glass(sensors, chosen, [0, 0, 0], colour, true);
    const at = (share) => plus(start, times(share, way)), share = data.share(chosen);
    const beyond = Math.min(1, Math.max(share, data.reach(this.scene) / (lengthOf(way) || 1)));
    if (!whether) stage.line(at(share), at(beyond), [...COLOURS.path, 0.5], 1.5, 4);
    const across = times(0.25 * sensors.radius[chosen], unit(cross(way, stage.forward)));
    for (const t of whether ? [] : [answers.lo[chosen], answers.hi[chosen]]) {
      if (!Number.isFinite(t)) continue;
      const tick = at(data.fractionOf(chosen, t));
      stage.line(minus(tick, across), plus(tick, across), COLOURS.path, 2);
    }
    this.explainContact(stage, objects, ways, share);
    const other = data.otherShare(chosen);
    if (other !== null && Math.abs(other - share) > 1e-3) {
      const moved = times(other, way);
      stage.glass(sensors, chosen, moved, COLOURS.path, false);
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
    const point = data.vector("point", chosen), normal = data.vector("normal", chosen), gap = data.gap(chosen);
    if (!point.every(Number.isFinite)) return;
    stage.mark(point, [0, 0, 0], 9, "disc");
    if (!normal.every(Number.isFinite)) return;
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
