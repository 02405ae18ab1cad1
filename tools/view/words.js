// Answers in words: what was asked decides how they are said.

/** @typedef {import("./data.js").Answer} Answer */

export const inDigits = (value, digits = 6) => {
  if (Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return "∞";
  const rounded = Number(value.toPrecision(digits));
  return rounded !== 0 && Math.abs(rounded) < 1e-4 ? rounded.toExponential() : `${rounded}`;
};

export function sizeInWords(/** @type {string} */ what, /** @type {import("./meshes.js").Mesh} */ mesh) {
  const sides = mesh.half.map((half) => inDigits(2 * half, 4)).join(" × ");
  const { name, triangles, isRound, radius, parts } = mesh;
  const rounding = radius > 0 && !isRound ? `, rounded by ${inDigits(radius, 4)}, which is not drawn` : "";
  return `${what}: ${name}, ${isRound || parts ? "drawn with " : ""}${triangles} triangles, ${sides}${rounding}`;
}

function chainInWords(data, { links, bodies }) {
  const triangles = bodies.reduce((sum, { mesh }) => sum + data.meshes[mesh].triangles, 0);
  return `Chain: ${links.length} links, ${bodies.length} meshes, ${triangles} triangles`;
}

/** "object 1 (lid), object 2 (box) and 3 others" */
function listed(data, scene, objects) {
  const shown = objects.slice(0, 5).map((object) => data.called(scene, object)), others = objects.length - shown.length;
  return shown.join(", ") + (others > 0 ? ` and ${others} other${others > 1 ? "s" : ""}` : "");
}

const precisely = (value) => inDigits(value, 9);

/** Sentences by what counts as contact: with what a query leaves, near, or touching. */
function sentencesOf({ leaves, clearance, gap }, { it, what, time, within, other }) {
  const near = precisely(clearance), touching = `Touches ${what} where it starts.`;
  if (leaves) {
    return {
      whether: `Something blocks it ${within}.`, hit: `Free for ${time}, then ${what} blocks it.`,
      listed: `After ${time}, ${what} blocks it, if nothing does before.`,
      clear: `Nothing${other} blocks it ${within}.`, overlap: `It is blocked where it starts, by ${what}.`,
      undecided: `Free for ${time}; after that, something may block it.`,
    };
  }
  if (clearance > 0) {
    return {
      whether: `Comes within ${near} of something ${within}.`, hit: it === "it" ? `Comes within ${near} of ${what} after ${time}.`
        : `Free for ${time}, then ${it} comes within ${near} of ${what}.`,
      listed: `Comes within ${near} of ${what} after ${time}, if nothing stops it before.`,
      clear: `Comes within ${near} of nothing${other}, ${within}.`,
      overlap: gap === 0 ? touching : `Is within ${near} of ${what} at the start already.`,
      undecided: `Keeps a distance of ${near} for ${time}; after that it may come nearer.`,
    };
  }
  return {
    whether: `Touches something ${within}.`, hit: `Free for ${time}, then ${it} touches ${what}.`,
    listed: `Touches ${what} after ${time}, if nothing stops it before.`,
    clear: `Touches nothing${other} ${within}.`, overlap: touching,
    undecided: `Free for ${time}; contact after that is possible.`,
  };
}

/** The answer itself, in a sentence or two. */
function answerInWords(/** @type {Answer} */ answer) {
  const { data, query, object, status, body, otherBody } = answer, { queries } = data, step = queries.step[query];
  const link = data.linkName(query, body), other = data.linkName(query, otherBody);
  const time = precisely(status === "undecided" ? answer.lo : answer.t);
  const sentences = sentencesOf(answer, {
    it: link ? `its link ${link}` : "it",
    what: other ? `its link ${other}` : object === data.none ? "something" : data.called(queries.scene[query], object),
    time: step ? `${time} of the step` : time,
    within: step ? "during the step" : `within ${precisely(queries.whole[query])}`,
    other: data.left[query] ? " else" : "",
  });
  if (answer.as === "closest") {
    return answer.gap > 0 ? `Comes nearest to ${data.called(queries.scene[query], object)} after ${step ? `${time} of the step` : time}.`
      : "Its surface meets another on its way: it comes no nearer.";
  }
  if (answer.as === "exit") {
    const isStuck = answer.lo === queries.whole[query];
    return isStuck ? `Is still in contact with ${data.called(queries.scene[query], object)} at the end of its way.`
      : `Is out of everything after ${step ? `${time} of the step` : time}; the last contact is with ${data.called(queries.scene[query], object)}.`;
  }
  if (!answer.saysOnlyWhether) return sentences[status === "hit" && answer.isListed ? "listed" : status] ?? "Not answered.";
  return `${sentences.whether} Asked was only whether (any_hit): not what or when; at the start counts, too.`;
}

/** A moment in a list: "0.5: object 3 (lid)". */
export function momentInWords(/** @type {Answer} */ { data, query, object, status, t, lo, gap, as }) {
  const kinds = { contact: "", closest: `nearest, ${inDigits(Math.max(gap, 0))} from `, exit: "out of all, " };
  const name = kinds[as] + data.called(data.queries.scene[query], object);
  return status === "undecided" ? `not before ${inDigits(lo)}, if at all: ${name}` : `${inDigits(t)}: ${name}`;
}

/** All that is known of an answer, in sentences. */
export function inWords(/** @type {Answer} */ answer) {
  const { data, query, lo, hi, triA, triB, gap } = answer, scene = data.queries.scene[query], lines = [];
  const left = data.left[query], hasGap = gap !== 0;
  if (left) {
    lines.push(`Crosses ${listed(data, scene, left)} where it starts; left out of the answer (skip_overlapping, pink glass).`);
  }
  lines.push(answerInWords(answer));
  if (answer.leaves) {
    lines.push(answer.clearance > 0
      ? `What blocks it comes within ${precisely(answer.clearance)}, and nearer than it starts (ignore_leaving).`
      : "It may leave what it rests on, or slide along it (ignore_leaving).");
  }
  const turn = data.queries.turns[query], vector = (numbers) => `(${numbers.map((x) => inDigits(x)).join(", ")})`;
  if (turn?.angle && answer.status !== "invalid") {
    const degrees = inDigits((turn.angle * 180) / Math.PI, 4);
    lines.push(`It turns by ${degrees}° about ${vector(turn.axis)} through ${vector(turn.centre)}.`);
  }
  if (gap > 0) lines.push(`The gap is then ${precisely(gap)} long (drawn).`);
  if (data.reasons[query]) lines.push(data.reasons[query]);
  if (lo < hi && Number.isFinite(lo) && !answer.saysOnlyWhether && answer.status !== "undecided") {
    const isClose = precisely(lo) === precisely(hi);
    lines.push(isClose ? `The bracket is ${inDigits(hi - lo, 2)} wide.` : `The bracket: ${precisely(lo)} to ${precisely(hi)}.`);
  }
  const link = data.linkName(query, answer.body), other = data.linkName(query, answer.otherBody);
  if (triA !== data.none) {
    const { isRound, parts } = link ? { isRound: false, parts: 0 } : data.sensors.meshOf(query);
    const ofCutter = triA === 0 ? "its cutting end" : `its part ${triA}`;
    const own = isRound ? "it" : parts ? ofCutter : link ? `triangle ${triA} of its link ${link}` : `its triangle ${triA}`;
    const touched = other ? `triangle ${triB} of its link ${other}` : `the object's triangle ${triB}`;
    lines.push(hasGap ? `The nearest points lie on ${own} and on ${touched} (yellow).`
      : `${own[0].toUpperCase()}${own.slice(1)} meets ${touched} (yellow).`);
  }
  const listedNumbers = (numbers) => numbers.map((x) => inDigits(x)).join(", ");
  if (answer.hasPoint) lines.push(`${hasGap ? "the object's nearest point" : "point"} ${listedNumbers(answer.point)}`);
  if (answer.hasNormal) lines.push(`normal ${listedNumbers(answer.normal)}`);
  if (data.others[query]) lines.push(data.others[query].words);
  const move = data.queries.moves[query];
  if (move) lines.push(chainInWords(data, data.chains[move.chain]));
  else lines.push(sizeInWords("Sensor", data.sensors.meshOf(query)));
  const ignored = data.queries.ignored[query];
  if (ignored) lines.push(`Takes no account of ${listed(data, scene, ignored)} (like glass).`);
  if (data.queries.asked[query]) lines.push(`Options: ${askedInWords(answer)}.`);
  return lines;
}

const KINDS_IN_WORDS = { part: "clear, some left out" };
export const kindInWords = (kind) => KINDS_IN_WORDS[kind] ?? kind;

/** The options that a query gives, in the words of query files: "clearance 0.5, hits all". */
export const askedInWords = (/** @type {Answer} */ { data, query }) =>
  Object.entries(data.queries.asked[query] ?? {}).map(([name, value]) => (value === true ? name : `${name} ${value}`)).join(", ");
