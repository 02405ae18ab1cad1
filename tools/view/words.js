// Answers in words: what was asked decides how they are said.

const inDigits = (value, digits = 6) => {
  if (Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return "∞";
  const rounded = Number(value.toPrecision(digits));
  return rounded !== 0 && Math.abs(rounded) < 1e-4 ? rounded.toExponential() : `${rounded}`;
};

function sizeInWords(what, mesh) {
  const sides = mesh.half.map((half) => inDigits(2 * half, 4)).join(" × ");
  return `${what}: ${mesh.name}, ${mesh.triangles} triangles, ${sides}`;
}

/** "object 1 (lid), object 2 (box) and 3 others" */
function listed(data, scene, objects) {
  const shown = objects.slice(0, 5).map((object) => data.called(scene, object)), others = objects.length - shown.length;
  return shown.join(", ") + (others > 0 ? ` and ${others} other${others > 1 ? "s" : ""}` : "");
}

/** The answer itself, in a sentence or two. */
function answerInWords(data, query) {
  const { answers, queries } = data, t = (value) => inDigits(value, 9), scene = queries.scene[query];
  const clearance = queries.clearance[query], isNear = clearance > 0, gap = data.gap(query), step = queries.step[query];
  const object = answers.object[query], what = object === data.none ? "something" : data.called(scene, object);
  const after = (value) => `${t(value)}${step ? " of the step" : ""}`;
  const within = step ? "during the step" : `within ${t(queries.whole[query])}`, rest = data.left[query] ? " else" : "";
  if (data.saysOnlyWhether(query)) {
    const does = isNear ? `Comes within ${t(clearance)} of something` : "Touches something";
    return `${does} ${within}. Asked was only whether (any_hit): not what or when; at the start counts, too.`;
  }
  switch (data.status(query)) {
    case "hit":
      if (!isNear) return `Free for ${after(answers.t[query])}, then it touches ${what}.`;
      return `Comes within ${t(clearance)} of ${what} after ${after(answers.t[query])}.`;
    case "clear":
      return isNear ? `Comes within ${t(clearance)} of nothing${rest}, ${within}.` : `Touches nothing${rest} ${within}.`;
    case "overlap":
      if (!isNear || gap === 0) return `Touches ${what} where it starts.`;
      return `Is within ${t(clearance)} of ${what} at the start already.`;
    case "undecided":
      if (!isNear) return `Free for ${after(answers.lo[query])}; contact after that is possible.`;
      return `Keeps a distance of ${t(clearance)} for ${after(answers.lo[query])}; after that it may come nearer.`;
  }
  return "Not answered.";
}

/** All that is known of an answer, in sentences. */
function inWords(data, query) {
  const { answers, queries } = data, t = (value) => inDigits(value, 9), scene = queries.scene[query], lines = [];
  const left = data.left[query], gap = data.gap(query), hasGap = gap !== 0;
  if (left) {
    lines.push(`Crosses ${listed(data, scene, left)} where it starts; left out of the answer (skip_overlapping, pink glass).`);
  }
  lines.push(answerInWords(data, query));
  if (gap > 0) lines.push(`The gap is then ${t(gap)} long (drawn).`);
  if (data.reasons[query]) lines.push(data.reasons[query]);
  const [lo, hi] = [answers.lo[query], answers.hi[query]];
  if (lo < hi && Number.isFinite(lo) && !data.saysOnlyWhether(query) && data.status(query) !== "undecided") {
    const isClose = t(lo) === t(hi);
    lines.push(isClose ? `The bracket is ${inDigits(hi - lo, 2)} wide.` : `The bracket: ${t(lo)} to ${t(hi)}.`);
  }
  if (answers.triA[query] !== data.none) {
    const [a, b] = [answers.triA[query], answers.triB[query]];
    lines.push(hasGap ? `The nearest points lie on its triangle ${a} and on the object's triangle ${b} (yellow).`
      : `Its triangle ${a} meets the object's triangle ${b} (yellow).`);
  }
  for (const name of ["point", "normal"]) {
    const numbers = data.vector(name, query);
    if (!numbers.every(Number.isFinite)) continue;
    lines.push(`${name === "point" && hasGap ? "the object's nearest point" : name} ${numbers.map((x) => inDigits(x)).join(", ")}`);
  }
  if (data.others[query]) lines.push(data.others[query].words);
  lines.push(sizeInWords("Sensor", data.sensors.meshOf(query)));
  const ignored = queries.ignored[query];
  if (ignored) lines.push(`Takes no account of ${listed(data, scene, ignored)} (like glass).`);
  return lines;
}

const KINDS_IN_WORDS = { part: "clear, some left out" };
const kindInWords = (kind) => KINDS_IN_WORDS[kind] ?? kind;
