// Answers in words: what was asked decides how they are said.

export const inDigits = (value, digits = 6) => {
  if (Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return "∞";
  const rounded = Number(value.toPrecision(digits));
  return rounded !== 0 && Math.abs(rounded) < 1e-4 ? rounded.toExponential() : `${rounded}`;
};

export function sizeInWords(/** @type {string} */ what, /** @type {import("./meshes.js").Mesh} */ mesh) {
  const sides = mesh.half.map((half) => inDigits(2 * half, 4)).join(" × ");
  return `${what}: ${mesh.name}, ${mesh.triangles} triangles, ${sides}`;
}

/** "object 1 (lid), object 2 (box) and 3 others" */
function listed(data, scene, objects) {
  const shown = objects.slice(0, 5).map((object) => data.called(scene, object)), others = objects.length - shown.length;
  return shown.join(", ") + (others > 0 ? ` and ${others} other${others > 1 ? "s" : ""}` : "");
}

const precisely = (value) => inDigits(value, 9);

/** The answer itself, in a sentence or two. */
function answerInWords(/** @type {import("./data.js").Answer} */ answer) {
  const { data, query, object, gap, clearance } = answer, { queries } = data, isNear = clearance > 0;
  const step = queries.step[query];
  const what = object === data.none ? "something" : data.called(queries.scene[query], object);
  const after = (value) => `${precisely(value)}${step ? " of the step" : ""}`;
  const within = step ? "during the step" : `within ${precisely(queries.whole[query])}`, rest = data.left[query] ? " else" : "";
  if (answer.saysOnlyWhether) {
    const does = isNear ? `Comes within ${precisely(clearance)} of something` : "Touches something";
    return `${does} ${within}. Asked was only whether (decide): not what or when; at the start counts, too.`;
  }
  switch (answer.status) {
    case "hit":
      if (!isNear) return `Free for ${after(answer.t)}, then it touches ${what}.`;
      return `Comes within ${precisely(clearance)} of ${what} after ${after(answer.t)}.`;
    case "clear":
      return isNear ? `Comes within ${precisely(clearance)} of nothing${rest}, ${within}.` : `Touches nothing${rest} ${within}.`;
    case "overlap":
      if (!isNear || gap === 0) return `Touches ${what} where it starts.`;
      return `Is within ${precisely(clearance)} of ${what} at the start already.`;
    case "undecided":
      if (!isNear) return `Free for ${after(answer.lo)}; contact after that is possible.`;
      return `Keeps a distance of ${precisely(clearance)} for ${after(answer.lo)}; after that it may come nearer.`;
  }
  return "Not answered.";
}

/** All that is known of an answer, in sentences. */
export function inWords(/** @type {import("./data.js").Answer} */ answer) {
  const { data, query, lo, hi, triA, triB, gap } = answer, scene = data.queries.scene[query], lines = [];
  const left = data.left[query], hasGap = gap !== 0;
  if (left) {
    lines.push(`Crosses ${listed(data, scene, left)} where it starts; left out of the answer (skip_overlapping, pink glass).`);
  }
  lines.push(answerInWords(answer));
  if (gap > 0) lines.push(`The gap is then ${precisely(gap)} long (drawn).`);
  if (data.reasons[query]) lines.push(data.reasons[query]);
  if (lo < hi && Number.isFinite(lo) && !answer.saysOnlyWhether && answer.status !== "undecided") {
    const isClose = precisely(lo) === precisely(hi);
    lines.push(isClose ? `The bracket is ${inDigits(hi - lo, 2)} wide.` : `The bracket: ${precisely(lo)} to ${precisely(hi)}.`);
  }
  if (triA !== data.none) {
    lines.push(hasGap ? `The nearest points lie on its triangle ${triA} and on the object's triangle ${triB} (yellow).`
      : `Its triangle ${triA} meets the object's triangle ${triB} (yellow).`);
  }
  const listedNumbers = (numbers) => numbers.map((x) => inDigits(x)).join(", ");
  if (answer.hasPoint) lines.push(`${hasGap ? "the object's nearest point" : "point"} ${listedNumbers(answer.point)}`);
  if (answer.hasNormal) lines.push(`normal ${listedNumbers(answer.normal)}`);
  if (data.others[query]) lines.push(data.others[query].words);
  lines.push(sizeInWords("Sensor", data.sensors.meshOf(query)));
  const ignored = data.queries.ignored[query];
  if (ignored) lines.push(`Takes no account of ${listed(data, scene, ignored)} (like glass).`);
  return lines;
}

const KINDS_IN_WORDS = { part: "clear, some left out" };
export const kindInWords = (kind) => KINDS_IN_WORDS[kind] ?? kind;

/** The options that a query gives, in the words of query files: "clearance 0.5, hits all". */
export const askedInWords = (/** @type {import("./data.js").Answer} */ { data, query }) =>
  Object.entries(data.queries.asked[query] ?? {}).map(([name, value]) => (value === true ? name : `${name} ${value}`)).join(", ");
