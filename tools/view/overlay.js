// What is written over the picture: a legend, a scale, the axes, and labels of places.

import { COLOURS, SYMBOLS, viridis } from "./colours.js";
import { made, the } from "./elements.js";
import { inDigits, kindInWords } from "./words.js";

export class Overlay {
  /**
   * @param {import("./data.js").Data} data
   * @param {HTMLCanvasElement} canvas
   * @param {() => void} show  shows all, far things, too
   */
  constructor(data, canvas, show) {
    this.data = data;
    this.canvas = canvas;
    this.note = the("p", "note");
    this.far = the("button", "far");
    this.legend = the("ul", "legend");
    this.labels = the("div", "labels");
    this.scale = the("span", "scale");
    this.axes = the("canvas", "axes");
    this.key = "";
    this.tell();
    this.far.onclick = show;
  }

  /** What the page leaves out, and something else. */
  tell(more = "") {
    this.note.textContent = [...this.data.notes, more].join(" ");
  }

  draw(camera, look, labels) {
    this.drawFar(look.scene);
    this.drawLegend(look);
    this.drawLabels(camera, labels);
    this.drawScale(camera);
    this.drawAxes(camera);
  }

  drawFar(scene) {
    const { objects, sensors } = this.data.extent(scene).far;
    const counted = (count, name) => (count > 0 ? [`${count} ${name}${count > 1 ? "s" : ""}`] : []);
    const parts = [...counted(objects, "object"), ...counted(sensors, "sensor")];
    this.far.textContent = parts.length ? `${parts.join(" and ")} far away` : "";
  }

  /** [colour, symbol, words] of what is in sight. */
  entries(/** @type {import("./look.js").Look} */ { by, answer, scene }) {
    const { data } = this, entries = [];
    if (by === "status") {
      const kinds = new Set(data.answers.filter(({ query }) => data.queries.scene[query] === scene).map(({ kind }) => kind));
      for (const kind in SYMBOLS) if (kinds.has(kind)) entries.push([COLOURS[kind], SYMBOLS[kind], kindInWords(kind)]);
    } else if (by === "t") {
      for (const share of [0, 0.25, 0.5, 0.75, 1]) entries.push([viridis(share), "■", `t = ${inDigits(share * data.latest, 3)}`]);
      entries.push([COLOURS.invalid, "■", "no contact, or not known when"]);
    } else {
      entries.push([COLOURS.path, "■", "a colour for each object, and what touches it"]);
    }
    if (!answer) return entries;
    const { gap } = answer;
    if (data.left[answer.query]) entries.push([COLOURS.part, "◇", "left out: crosses at the start"]);
    if (answer.object !== data.none) entries.push([COLOURS.touched, "■", gap === 0 ? "touched" : "the nearest object"]);
    if (data.answers[answer.query].moments.length) entries.push([COLOURS.listed, "■", "listed moments"]);
    const triangles = gap === 0 ? "triangles that meet" : "the nearest triangles";
    if (answer.triA !== data.none) entries.push([[0.85, 0.7, 0], "▲", triangles]);
    if (answer.hasPoint) entries.push([[0, 0, 0], "●", gap === 0 ? "point of contact" : "nearest point"]);
    if (gap > 0 && answer.hasNormal) entries.push([COLOURS.gap, "━", "the gap"]);
    else if (gap === 0 && answer.hasNormal) entries.push([COLOURS.normal, "◆", "normal"]);
    if (answer.share > 0) entries.push([COLOURS[answer.kind], "◇", "where it starts (glass)"]);
    return entries;
  }
  drawLegend(look) {
    const key = `${look.by} ${look.chosen} ${look.contact} ${look.scene}`;
    if (key === this.key) return;
    this.key = key;
    this.legend.replaceChildren();
    for (const [colour, symbol, words] of this.entries(look)) {
      const line = made(this.legend, "li");
      made(line, "span", "", symbol).style.color = `rgb(${colour.map((c) => Math.round(255 * c)).join()})`;
      line.append(` ${words}`);
    }
  }

  drawLabels(camera, labels) {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.labels.replaceChildren();
    for (const { place, text } of labels) {
      const [x, y, depth] = camera.pixel(place, width, height);
      if (!(depth > 0 && x > 0 && x < width && y > 0 && y < height)) continue;
      Object.assign(made(this.labels, "span", "", text).style, { left: `${x + 10}px`, top: `${y - 10}px` });
    }
  }

  /** A round length, as it looks at the middle of the view. */
  drawScale(camera) {
    const pixel = (2 * camera.slope * camera.distance) / this.canvas.clientHeight, most = 140 * pixel;
    const power = 10 ** Math.floor(Math.log10(most)), length = [5, 2, 1].find((factor) => factor * power <= most) * power;
    this.scale.textContent = inDigits(length, 3);
    this.scale.style.width = `${length / pixel}px`;
  }

  drawAxes(camera) {
    const context = this.axes.getContext("2d"), [right, up, forward] = camera.axes(), middle = 36;
    context.clearRect(0, 0, 72, 72);
    Object.assign(context, { lineWidth: 2, font: "12px system-ui, sans-serif", textAlign: "center", textBaseline: "middle" });
    const axes = [["x", "#c22"], ["y", "#282"], ["z", "#22c"]].map(([name, colour], k) => ({ name, colour, k }));
    for (const { name, colour, k } of axes.sort((a, b) => forward[b.k] - forward[a.k])) {
      Object.assign(context, { strokeStyle: colour, fillStyle: colour });
      context.beginPath();
      context.moveTo(middle, middle);
      context.lineTo(middle + 22 * right[k], middle - 22 * up[k]);
      context.stroke();
      context.fillText(name, middle + 30 * right[k], middle - 30 * up[k]);
    }
  }
}
