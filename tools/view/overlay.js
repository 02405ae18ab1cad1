// What is written over the picture: a legend, a scale, the axes, and labels of places.

class Overlay {
  /** `show`: shows all, far things, too. */
  constructor(data, canvas, show) {
    Object.assign(this, { data, canvas });
    for (const name of ["note", "far", "legend", "labels", "scale", "axes"]) this[name] = document.querySelector(`#${name}`);
    this.note.textContent = data.notes.join(" ");
    this.far.onclick = show;
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
  entries({ by, chosen, scene }) {
    const { data } = this, { scene: scenes } = data.queries, entries = [];
    if (by === "status") {
      const kinds = new Set();
      for (let i = 0; i < scenes.length; ++i) if (scenes[i] === scene) kinds.add(data.kind(i));
      for (const kind in SYMBOLS) if (kinds.has(kind)) entries.push([COLOURS[kind], SYMBOLS[kind], kindInWords(kind)]);
    } else if (by === "t") {
      for (const share of [0, 0.25, 0.5, 0.75, 1]) entries.push([viridis(share), "■", `t = ${inDigits(share * data.latest, 3)}`]);
      entries.push([COLOURS.invalid, "■", "no contact, or not known when"]);
    } else {
      entries.push([COLOURS.path, "■", "a colour for each object, and what touches it"]);
    }
    if (chosen < 0) return entries;
    const gap = data.gap(chosen), has = (name) => data.vector(name, chosen).every(Number.isFinite);
    if (data.left[chosen]) entries.push([COLOURS.part, "◇", "left out: crosses at the start"]);
    if (data.answers.object[chosen] !== data.none) entries.push([COLOURS.touched, "■", gap === 0 ? "touched" : "the nearest object"]);
    if (data.answers.triA[chosen] !== data.none) entries.push([[0.85, 0.7, 0], "▲", gap === 0 ? "triangles that meet" : "the nearest triangles"]);
    if (has("point")) entries.push([[0, 0, 0], "●", gap === 0 ? "point of contact" : "nearest point"]);
    if (gap > 0 && has("normal")) entries.push([COLOURS.gap, "━", "the gap"]);
    else if (gap === 0 && has("normal")) entries.push([COLOURS.normal, "◆", "normal"]);
    if (data.share(chosen) > 0) entries.push([COLOURS[data.kind(chosen)], "◇", "where it starts (glass)"]);
    return entries;
  }
  drawLegend(look) {
    const key = `${look.by} ${look.chosen} ${look.scene}`;
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
