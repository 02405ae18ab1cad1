// The page's modules without a browser: node --test. tests/view/page_test.py looks at the page itself.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Data } from "../../tools/view/data.js";
import { Hands } from "../../tools/view/hands.js";
import { Look } from "../../tools/view/look.js";
import { Renderer } from "../../tools/view/renderer.js";
import { COLUMNS, Listing } from "../../tools/view/table.js";
import { Stage } from "../../tools/view/stage.js";
import { Camera, lengthOf, minus, plus, unit } from "../../tools/view/vectors.js";
import { momentInWords, inWords } from "../../tools/view/words.js";

const NONE = 0xffffffff, TYPES = { u1: Uint8Array, u4: Uint32Array, f4: Float32Array, f8: Float64Array };
const array = (type, values) => ({ [type]: Buffer.from(new TYPES[type](values).buffer).toString("base64") });
const UNIT = [1, 0, 0, 0, 1, 0, 0, 0, 1];

const poses = (places) =>
  ({ mesh: array("u4", places.map(() => 0)), linear: array("f4", places.flatMap(() => UNIT)), at: array("f8", places.flat()) });

function answersOf(rows) {
  const of = (type, name, none) => array(type, rows.flatMap((row) => row[name] ?? none));
  const numbers = Object.fromEntries(["t", "lo", "hi", "gap"].map((name) => [name, of("f8", name, NaN)]));
  const names = ["object", "tri_a", "tri_b", "link", "mesh", "other_link", "other_mesh"];
  const ids = Object.fromEntries(names.map((name) => [name, of("u4", name, NONE)]));
  const places = Object.fromEntries(["point", "normal"].map((name) => [name, of("f8", name, [NaN, NaN, NaN])]));
  return { status: array("u1", rows.map(({ status }) => STATUSES.indexOf(status))), ...numbers, ...ids, ...places };
}
const firstOf = (rows) => rows.reduce((first, { moments = [] }) => [...first, first.at(-1) + moments.length], [0]);
const STATUSES = ["hit", "clear", "overlap", "undecided", "invalid"];

/**
 * What page.cpp writes of a scene of cubes of side 2 at x = 0, 10, 20, and sensors like them, which move 10 along x.
 * `mesh`: what else is said of the cube. `rows`: of each query its answer, what it lists, and what was asked: {..., moments, left,
 * ignored, id, at, asked, step, turn, move}.
 */
function dataOf(rows, { chains = [], mesh = {} } = {}) {
  const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1, i & 2, i & 4].map((bit) => (bit ? 1 : -1)));
  const by = (name) => Object.fromEntries(rows.flatMap((row, i) => (row[name] ? [[i, row[name]]] : [])));
  const objects = [0, 10, 20].map((x) => [x, 0, 0]);
  const scene = {
    ...poses(objects), id: "", base: null, number: array("u4", [0, 1, 2]), names: { 1: "lid" }, moving: array("u4", []),
    ways: array("f8", []), deforms: [],
  };
  const queries = {
    ...poses(rows.map(({ at = [-5, 0, 0] }) => at)), count: rows.length, id: rows.map(({ id }, i) => id ?? `${i}`),
    scene: array("u4", rows.map(() => 0)), way: array("f8", rows.flatMap(() => [10, 0, 0])),
    whole: array("f8", rows.map(({ step }) => (step ? 1 : 10))), step: array("u1", rows.map(({ step }) => (step ? 1 : 0))),
    asked: by("asked"), ignored: by("ignored"), turns: by("turn"), moves: by("move"),
  };
  return new Data(JSON.stringify({
    title: "", notes: [], tour: [], none: NONE, statuses: STATUSES, chains, scenes: [scene], queries, answers: answersOf(rows),
    moments: {
      ...answersOf(rows.flatMap(({ moments = [] }) => moments)), first: array("u4", firstOf(rows)),
      as: array("u1", rows.flatMap(({ moments = [] }) => moments.map(({ as = 0 }) => as))),
    },
    meshes: [{ name: "cube", positions: array("f4", corners), indices: array("u4", [0, 1, 3, 4, 5, 7]), ...mesh }],
    left: by("left"), reasons: by("reasons"), others: by("others"), scopes: {},
  }));
}
const HIT = { status: "hit", t: 3, lo: 3, hi: 3, object: 0, tri_a: 0, tri_b: 1, gap: 0, point: [-1, 0, 0], normal: [-1, 0, 0] };
const CLEAR = { status: "clear", t: Infinity, lo: Infinity, hi: Infinity };

test("a ball touches, and keeps its clearance, beyond its radius; a rounded mesh says how near it comes, a cutter which part", () => {
  const near = { ...HIT, gap: 2.5, asked: { clearance: 0.5 } };
  const wordsOf = (sensor, row) => inWords(dataOf([row], { mesh: sensor }).answers[0]);
  const ball = { isRound: true, radius: 2, name: "ball" };
  const touching = wordsOf(ball, { ...HIT, gap: 2 });
  assert.equal(touching[0], "Free for 3, then it touches object 0 (ball).");
  assert.ok(touching.includes("It meets the object's triangle 1 (yellow)."));
  assert.ok(touching.includes("Sensor: ball, drawn with 2 triangles, 2 × 2 × 2"), touching.join("\n"));
  assert.equal(wordsOf(ball, near)[0], "Comes within 0.5 of object 0 (ball) after 3.");
  assert.ok(wordsOf(ball, near).includes("The gap is then 0.5 long (drawn)."));
  const cutter = { parts: 2, name: "mill" };
  assert.ok(wordsOf(cutter, HIT).includes("Its cutting end meets the object's triangle 1 (yellow)."));
  assert.ok(wordsOf(cutter, { ...HIT, tri_a: 1 }).includes("Its part 1 meets the object's triangle 1 (yellow)."));
  assert.ok(wordsOf(cutter, HIT).includes("Sensor: mill, drawn with 2 triangles, 2 × 2 × 2"));
  const rounded = wordsOf({ radius: 2 }, near);
  assert.equal(rounded[0], "Comes within 2.5 of object 0 (cube) after 3.");
  assert.ok(rounded.includes("Sensor: cube, 2 triangles, 2 × 2 × 2, rounded by 2, which is not drawn"));
});

test("an answer says how far its sensor goes, and when it touches something", () => {
  const data = dataOf([
    HIT, CLEAR, { ...CLEAR, left: [1] }, { status: "overlap", t: 0, lo: 0, hi: 0, object: 1 },
    { status: "undecided", t: 4, lo: 4, hi: Infinity }, { status: "invalid" },
    { status: "hit", t: 10, lo: 0, hi: 10, asked: { any_hit: true } }, { ...HIT, t: 0.5, lo: 0.5, hi: 0.5, step: true },
  ]);
  assert.deepEqual(data.answers.map(({ kind }) => kind),
    ["hit", "clear", "part", "overlap", "undecided", "invalid", "hit", "hit"]);
  assert.deepEqual(data.answers.map(({ share }) => share), [0.3, 1, 1, 0, 0.4, 0, 0, 0.5]);
  assert.deepEqual(data.answers.map(({ time }) => time), [3, NaN, NaN, 0, NaN, NaN, NaN, 0.5]);
  assert.equal(data.latest, 3);
  assert.deepEqual([data.answers[0].hasPoint, data.answers[1].hasPoint], [true, false]);
  assert.deepEqual([data.answers[0].point, data.answers[0].normal], [HIT.point, HIT.normal]);
});

test("a sensor that turns goes round its centre, which goes straight", () => {
  const turn = { axis: [0, 0, 1e-310], angle: Math.PI, centre: [-5, 4, 0] };
  const hit = { ...HIT, t: 0.5, lo: 0.5, hi: 0.75, step: true };
  const data = dataOf([{ ...hit, turn }, { ...CLEAR, step: true, turn }, { ...HIT, step: true, t: 0.5 },
    { ...CLEAR, step: true, turn: { axis: [0, 0, 0], angle: 0, centre: [0, 0, 0] } }]);
  const rounded = (v) => v.map((x) => Number(x.toFixed(9)) + 0);
  assert.deepEqual([0, 0.5, 1].map((share) => rounded(data.placeAt(0, share))), [[-5, 0, 0], [4, 4, 0], [5, 8, 0]]);
  assert.deepEqual(data.placeAt(2, 0.5), [0, 0, 0]);
  assert.deepEqual(data.placeAt(3, 0.5), [0, 0, 0]);
  // A corner of the cube, by the pose that is drawn.
  for (const share of [0, 0.3, 0.5]) {
    const { placed, i, moved } = data.bodiesAt(0, share)[0], c = Math.cos(share * Math.PI), s = Math.sin(share * Math.PI);
    const place = plus(placed.toWorld(i, [1, -1, 1]), moved), arm = [1, -5, 1];
    const expected = [-5 + 10 * share + c * arm[0] - s * arm[1], 4 + s * arm[0] + c * arm[1], 1];
    assert.ok(lengthOf(minus(place, expected)) < 1e-6, `${place}`);
  }
  assert.equal(data.bodiesAt(0, 0.5), data.bodiesAt(0, 0.5));
  assert.deepEqual(data.bodiesAt(2, 0.5), [{ placed: data.sensors, i: 2, moved: [5, 0, 0] }]);
  const path = data.path(0, 0, 0.5);
  assert.equal(path.length, 9);
  assert.deepEqual([rounded(path[0]), rounded(path.at(-1))], [[-5, 0, 0], [4, 4, 0]]);
  assert.equal(data.path(2, 0, 1).length, 2);
  assert.ok(unit(data.heading(0, 0.5))[1] > 0.7 && data.heading(2, 0.5)[1] === 0);
  // The whole way is looked at, whose middle point is the farthest.
  assert.ok(data.extent(0).bounds.hi[1] >= 5);
  assert.deepEqual(data.answers.map(({ share }) => share), [0.5, 1, 0.5, 1]);
  assert.equal(inWords(data.answers[0])[1], "It turns by 180° about (0, 0, 1e-310) through (-5, 4, 0).");
  assert.equal(inWords(data.answers[0])[0], "Free for 0.5 of the step, then it touches object 0 (cube).");
});

test("a chain's meshes are where its joints take them", () => {
  const here = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0], up = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 4];
  const links = [
    { name: "rail", parent: null, origin: here, joint: "prismatic", axis: [0, 1e-310, 0], variable: 1, meshes: [] },
    { name: "arm", parent: 0, origin: up, joint: "revolute", axis: [0, 2, 0], variable: 0, meshes: [{ mesh: 0, pose: up }] },
    { name: "hand", parent: 1, origin: up, joint: "fixed", axis: [1, 0, 0], variable: 0,
      meshes: [{ mesh: 0, pose: here }, { mesh: 0, pose: up }] },
  ];
  const move = { chain: 0, from: [0, 1], to: [Math.PI, 3], base: [1, 0, 0, 100, 0, 1, 0, 0, 0, 0, 1, 0] };
  const hit = { ...HIT, object: NONE, t: 0.5, lo: 0.5, hi: 0.6, step: true, move, link: 2, mesh: 1, other_link: 1, other_mesh: 0 };
  const data = dataOf([hit, { ...HIT, t: 0.5, step: true, move, link: 1, mesh: 0 }, { ...CLEAR, step: true, move },
    { ...CLEAR, step: true, move: { ...move, chain: 1 } }], { chains: [{ links }, { links: links.slice(0, 1) }] });
  const rounded = (v) => v.map((x) => Number(x.toFixed(9)) + 0);
  const centres = (share) => data.bodiesAt(0, share).map(({ placed, i }) => rounded(placed.centreOf(i)));
  assert.deepEqual(centres(0), [[100, 1, 8], [100, 1, 8], [100, 1, 12]]);
  assert.deepEqual(centres(0.5), [[104, 2, 4], [104, 2, 4], [108, 2, 4]]);
  assert.deepEqual(centres(1), [[100, 3, 0], [100, 3, 0], [100, 3, -4]]);
  // The mesh that touches stands among the sensors, or else the last one; a chain without meshes stands on its base.
  assert.deepEqual([0, 1, 2, 3].map((query) => rounded(data.sensors.centreOf(query))),
    [[100, 1, 12], [100, 1, 8], [100, 1, 12], [100, 0, 0]]);
  assert.deepEqual([0, 1, 2, 3].map((query) => rounded(data.placeAt(query, 0.5))),
    [[108, 2, 4], [104, 2, 4], [108, 2, 4], [100, 0, 0]]);
  assert.equal(data.path(0, 0, 0.5).length, 9);
  assert.ok(data.extent(0).bounds.hi[2] > 12);
  assert.equal(inWords(data.answers[0])[0], "Free for 0.5 of the step, then its link hand touches its link arm.");
  assert.ok(inWords(data.answers[0]).includes("Triangle 0 of its link hand meets triangle 1 of its link arm (yellow)."));
  assert.ok(inWords(data.answers[0]).includes("Chain: 3 links, 3 meshes, 6 triangles"));
  assert.equal(inWords(data.answers[1])[0], "Free for 0.5 of the step, then its link arm touches object 0 (cube).");
  const object = COLUMNS.find(({ name }) => name === "object");
  assert.deepEqual(data.answers.slice(0, 3).map(object.text), ["arm", "0 (lid)".slice(0, 1), ""]);
  // Its triangles, of two links, are marked.
  const look = new Look(data), stage = { triangles: [], triangle: (corners) => stage.triangles.push(corners), line() {}, mark() {} };
  look.chosen = 0;
  look.explainContact(stage, data.answers[0]);
  assert.deepEqual(stage.triangles.map(([corner]) => rounded(corner).map(Math.round)), [[107, 1, 5], [105, 1, 5]]);
});

test("a turn's path is drawn as lines, dashed by leaving out every other", () => {
  const lines = [], stage = { line: (...line) => lines.push(line), path: Stage.prototype.path };
  stage.path([0, 1, 2, 3, 4], "red", 2);
  stage.path([0, 1, 2, 3, 4], "red", 2, 6);
  stage.path([0, 1], "red", 2, 6);
  assert.deepEqual(lines, [[0, 1, "red", 2, 0], [1, 2, "red", 2, 0], [2, 3, "red", 2, 0], [3, 4, "red", 2, 0],
    [0, 1, "red", 2, 0], [2, 3, "red", 2, 0], [0, 1, "red", 2, 6]]);
});

test("another mode's answer names what is touched where the page's own names nothing", () => {
  const [answer] = dataOf([{ ...CLEAR, others: { words: "", t: 5, object: 2 } }]).answers;
  assert.deepEqual([answer.touched, answer.otherShare], [2, 0.5]);
});

test("colours by t look at each time once", () => {
  const data = dataOf(Array.from({ length: 1000 }, (_, i) => ({ ...HIT, t: i / 100 }))), look = new Look(data);
  let looks = 0;
  for (const answer of data.answers) {
    const { time } = answer;
    Object.defineProperty(answer, "time", { get: () => (++looks, time) });
  }
  look.by = "t";
  const colours = data.answers.map(({ query }) => look.colourOf(query));
  assert.equal(looks, 1000);
  assert.notDeepEqual(colours[0], colours[999]);
});

test("a list is filtered by kind, id and object, and sorted by a column, numbers that are none last", () => {
  const rows = [
    { ...HIT, id: "Ab" }, { ...CLEAR, id: "b" }, { ...HIT, id: "ba", t: 1, object: 1 }, { status: "invalid", id: "c" },
  ];
  const listing = new Listing(dataOf(rows));
  const after = (change) => (change(), listing.rows);
  assert.deepEqual(listing.rows, [0, 1, 2, 3]);
  assert.deepEqual(after(() => listing.filter({ kinds: new Set(["hit"]) })), [0, 2]);
  assert.deepEqual(after(() => listing.filter({ object: " 1 " })), [2]);
  assert.deepEqual(after(() => listing.filter({ kinds: new Set(), object: "", id: "AB" })), [0]);
  assert.deepEqual(after(() => listing.filter({ id: "" })), [0, 1, 2, 3]);
  const column = (name) => COLUMNS.find((one) => one.name === name);
  assert.deepEqual(after(() => listing.sort(column("t"))), [2, 0, 1, 3]);
  assert.deepEqual(after(() => listing.sort(column("t"))), [3, 1, 0, 2]);
  assert.deepEqual(after(() => listing.sort(column("query"))), [0, 1, 2, 3]);
  assert.deepEqual([[1, 1], [1, -9], [1, Infinity], [-1, 1]].map(([query, steps]) => listing.beside(query, steps)), [2, 0, 3, 0]);
  listing.filter({ id: "nothing" });
  assert.equal(listing.beside(0, 1), undefined);
});

test("a pointer turns and moves, two zoom by how far apart they are, and only one that rests clicks", () => {
  const camera = new Camera(), hands = new Hands(camera, { clientHeight: 100 });
  const event = (pointerId, clientX, clientY, more = {}) => ({ pointerId, clientX, clientY, buttons: 1, ...more });
  assert.equal(hands.move(event(1, 5, 5)), false);
  hands.press(event(1, 0, 0));
  hands.move(event(1, 1, 0));
  assert.equal(hands.release(event(1, 1, 0)), true);
  hands.press(event(1, 0, 0));
  hands.move(event(1, 100, 1000));
  assert.deepEqual([camera.yaw.toFixed(3), camera.pitch], ["-1.506", 1.57]);
  assert.equal(hands.release(event(1, 100, 1000)), false);

  Object.assign(camera, new Camera());
  hands.press(event(1, 0, 0));
  hands.press(event(2, 10, 0));
  hands.move(event(2, 20, 0));
  assert.equal(camera.distance, 0.5);
  const middle = camera.pixel([0, 0, 0], 100, 100).map((x) => Number(x.toFixed(9)));
  assert.deepEqual(middle, [55, 50, 0.5]);  // twice as large, and the middle of the two has moved by 5
  assert.deepEqual([hands.release(event(2, 20, 0)), hands.release(event(1, 0, 0))], [false, false]);
  hands.press(event(1, 0, 0));
  hands.move(event(1, 10, 0, { shiftKey: true }));
  assert.equal(camera.pixel([0, 0, 0], 100, 100)[0].toFixed(6), "65.000000");
});

test("arrows turn the view and move it with shift, plus and minus zoom", () => {
  const camera = new Camera(), hands = new Hands(camera, { clientHeight: 100 }), start = { ...camera };
  assert.equal(hands.key({ key: "x" }), false);
  for (const key of ["ArrowLeft", "ArrowUp", "+"]) assert.equal(hands.key({ key }), true);
  assert.ok(camera.yaw < start.yaw && camera.pitch > start.pitch && camera.distance < start.distance);
  for (const key of ["ArrowRight", "ArrowDown", "-"]) hands.key({ key });
  for (const name of ["yaw", "pitch", "distance"]) assert.ok(Math.abs(camera[name] - start[name]) < 1e-12, name);
  hands.key({ key: "ArrowRight", shiftKey: true });
  assert.ok(camera.pixel([0, 0, 0], 100, 100)[0] < 50);
});

test("buffers of meshes that another scene has not are freed", () => {
  const freed = [], meshes = ["own", "shared", "box"];
  const renderer = {
    gl: { deleteBuffer: (buffer) => freed.push(buffer) },
    meshBuffers: new Map(meshes.map((mesh) => [mesh, { positions: `${mesh} p`, indices: `${mesh} i` }])),
  };
  Renderer.prototype.keepOnly.call(renderer, ["shared", "box", "new"]);
  assert.deepEqual(freed, ["own p", "own i"]);
  assert.deepEqual([...renderer.meshBuffers.keys()], ["shared", "box"]);
});

test("contacts that a query lists are answers of their own, and filters find their objects", () => {
  const maybe = { status: "undecided", t: Infinity, lo: 8, hi: Infinity, object: 1 };
  const hits = [HIT, { ...HIT, t: 6, lo: 6, hi: 6, object: 2 }, maybe];
  const data = dataOf([{ ...HIT, moments: [HIT] }, { ...HIT, moments: hits }, CLEAR]), [one, several] = data.answers, look = new Look(data);
  assert.deepEqual(one.moments, []);
  assert.deepEqual(several.moments.map(momentInWords),
    ["3: object 0 (cube)", "6: object 2 (cube)", "not before 8, if at all: object 1 (lid)"]);
  assert.match(inWords(several.moments[1])[0], /^Touches object 2 \(cube\) after 6, if nothing stops it before\.$/);
  const listing = new Listing(data);
  listing.filter({ object: "2" });
  assert.deepEqual(listing.rows, [1]);
  assert.deepEqual(data.answers.map(COLUMNS.find(({ name }) => name === "object").text), ["0", "0 + 2", ""]);
  Object.assign(look, { chosen: 1, contact: 1 });
  assert.deepEqual([look.gone(1), look.gone(0), look.answer.object], [0.6, 0.3, 2]);
});

test("the closest approach and the last contact are moments of the way", () => {
  const near = { ...HIT, t: 4, lo: 4, hi: 4, gap: 2.5, object: 1, as: 1 }, out = { ...HIT, t: 7, lo: 7, hi: 7, as: 2 };
  const stuck = { ...out, t: 10, lo: 10, hi: 10 };
  const data = dataOf([{ ...CLEAR, moments: [near] }, { ...HIT, moments: [HIT, out] }, { ...HIT, moments: [stuck] }]);
  const [[closest], exits, [still]] = data.answers.map(({ moments }) => moments);
  assert.deepEqual([closest, ...exits, still].map(momentInWords),
    ["4: nearest, 2.5 from object 1 (lid)", "7: out of all, object 0 (cube)", "10: out of all, object 0 (cube)"]);
  assert.equal(inWords(closest)[0], "Comes nearest to object 1 (lid) after 4.");
  assert.match(inWords(closest)[1], /^The gap is then 2\.5 long/);
  assert.equal(inWords(exits[0])[0], "Is out of everything after 7; the last contact is with object 0 (cube).");
  assert.equal(inWords(still)[0], "Is still in contact with object 0 (cube) at the end of its way.");
  assert.equal(closest.share, 0.4);
});

test("words say what was asked: to touch, to come near, or to block", () => {
  const answers = [
    HIT, CLEAR, { status: "overlap", t: 0, lo: 0, hi: 0, object: 1, gap: 0.25 },
    { status: "undecided", t: Infinity, lo: 4, hi: Infinity },
    { status: "hit", t: 10, lo: 0, hi: 10, any_hit: true },
  ];
  const said = (asked) => dataOf(answers.map(({ any_hit, ...answer }) =>
    ({ ...answer, asked: any_hit ? { ...asked, any_hit } : asked }))).answers.map((answer) => inWords(answer));
  const first = (lines) => lines.map(([line]) => line.split(". Asked")[0]);
  assert.deepEqual(first(said({})), [
    "Free for 3, then it touches object 0 (cube).", "Touches nothing within 10.", "Touches object 1 (lid) where it starts.",
    "Free for 4; contact after that is possible.", "Touches something within 10",
  ]);
  const near = said({ clearance: 0.75 });
  assert.deepEqual(first(near), [
    "Comes within 0.75 of object 0 (cube) after 3.", "Comes within 0.75 of nothing, within 10.",
    "Is within 0.75 of object 1 (lid) at the start already.", "Keeps a distance of 0.75 for 4; after that it may come nearer.",
    "Comes within 0.75 of something within 10",
  ]);
  const blocked = said({ ignore_leaving: true });
  assert.deepEqual(first(blocked), [
    "Free for 3, then object 0 (cube) blocks it.", "Nothing blocks it within 10.",
    "It is blocked where it starts, by object 1 (lid).", "Free for 4; after that, something may block it.",
    "Something blocks it within 10",
  ]);
  assert.equal(blocked[0][1], "It may leave what it rests on, or slide along it (ignore_leaving).");
  assert.equal(said({ ignore_leaving: true, clearance: 0.5 })[1][1],
    "What blocks it comes within 0.5, and nearer than it starts (ignore_leaving).");
  const [words] = dataOf([{ ...CLEAR, left: [1], ignored: [0, 2] }]).answers.map((answer) => inWords(answer));
  assert.match(words[0], /^Crosses object 1 \(lid\) where it starts; left out/);
  assert.equal(words[1], "Touches nothing else within 10.");
  assert.equal(words.at(-1), "Takes no account of object 0 (cube), object 2 (cube) (like glass).");
  // With a gap, nothing touches; "contact" is no word for it.
  for (const line of near.flatMap((lines, i) => (answers[i].gap === 0 ? [] : lines))) assert.doesNotMatch(line, /touch|meet|contact/i);
});
