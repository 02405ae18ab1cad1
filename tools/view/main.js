// The page: the scene and the table beside it, and what keys, mouse and buttons do to them.

import { SYMBOLS } from "./colours.js";
import { Data } from "./data.js";
import { made, the } from "./elements.js";
import { Bounds, LARGEST } from "./extent.js";
import { Hands } from "./hands.js";
import { Look } from "./look.js";
import { Overlay } from "./overlay.js";
import { Renderer } from "./renderer.js";
import { drawScopes } from "./scopes.js";
import { BOX, Stage, TRIANGLE } from "./stage.js";
import { Table } from "./table.js";
import { Camera, between } from "./vectors.js";
import { momentInWords, inWords, kindInWords, sizeInWords } from "./words.js";

class Page {
  /** @param {string} text */
  constructor(text) {
    const data = new Data(text), canvas = the("canvas", "scene");
    this.data = data;
    this.canvas = canvas;
    this.camera = new Camera();
    this.hands = new Hands(this.camera, canvas);
    this.renderer = new Renderer(canvas);
    this.stage = new Stage(this.camera, canvas);
    this.look = new Look(data);
    /** Triangles of a picture. */
    this.budget = 300000;
    this.playing = false;
    this.flight = null;
    /** Whether there is something new to be seen, was so in the last picture, and since when there is not. */
    this.stale = this.wasStale = true;
    this.restless = this.last = performance.now();
    document.querySelector("h1").textContent = document.title = data.title;
    this.overlay = new Overlay(data, canvas, () => this.whole(true, true));
    this.table = new Table(data, the("div", "table"), {
      choose: (query) => this.choose(query, { fly: true }),
      show: (visible) => this.change({ visible }),
    });
    this.listen();
    this.whole(false);
    this.tour = data.tour;
    this.follow(data.tour[0] ?? {});
    if (!this.tour.length) this.choose(this.firstToSee());
    requestAnimationFrame(() => this.frame());
  }

  /** The first hit, or else what comes first; undefined if there is no query. */
  firstToSee() {
    const { answers } = this.data, isOf = (...kinds) => answers.find(({ kind }) => kinds.includes(kind));
    return (isOf("hit") ?? isOf("overlap", "part") ?? answers[0])?.query;
  }

  /** Something to be seen has changed. */
  change(changes = {}) {
    Object.assign(this.look, changes);
    this.stale = true;
    this.restless = performance.now();
  }

  /** Chooses a query; -1: none. */
  choose(query, { fly = false } = {}) {
    if (query === undefined) return;
    this.change({ chosen: query, contact: -1, object: -1, scene: query < 0 ? this.look.scene : this.data.queries.scene[query] });
    // The words leave the table less room, in which the row is to be seen.
    this.describe();
    this.table.mark(query);
    if (fly && query >= 0) this.flyTo(query);
  }

  seek(time) {
    this.change({ time });
    the("input", "time").value = `${time}`;
  }

  play(playing = !this.playing) {
    if (playing && this.look.time >= 1) this.seek(0);
    this.playing = playing;
    the("button", "play").textContent = playing ? "❚❚" : "▶";
    this.change();
  }

  // Where to look

  /** A box to be seen. */
  lookAt(bounds, smooth = true) {
    if (bounds.isEmpty) return;
    const end = this.camera.looking(bounds, this.canvas.clientWidth / this.canvas.clientHeight);
    if (!smooth || matchMedia("(prefers-reduced-motion: reduce)").matches) Object.assign(this.camera, end);
    else this.flight = { from: { ...this.camera }, end, begun: performance.now() };
    this.change();
  }
  /** All that is near together, or `all` that can be drawn. */
  whole(smooth = true, all = false) {
    const { data, look } = this, { objects } = data.scene(look.scene), bounds = new Bounds();
    const near = data.extent(look.scene).bounds, slack = data.reach(look.scene);
    const add = (place, radius) => {
      const isNear = place.every((x, k) => x >= near.lo[k] - slack && x <= near.hi[k] + slack);
      if (isNear || (all && Math.max(...place.map(Math.abs), radius) < LARGEST)) bounds.add(place, radius);
    };
    for (let i = 0; i < objects.count; ++i) add(objects.centreOf(i), objects.radius[i]);
    for (let i = 0; i < data.queries.count; ++i) {
      if (data.queries.scene[i] !== look.scene) continue;
      for (const { place, radius } of data.swept(i, data.answers[i].share)) add(place, radius);
    }
    this.lookAt(bounds, smooth);
  }
  flyTo(query) {
    const { data } = this;
    const bounds = new Bounds(), { objects, place } = data.scene(data.queries.scene[query]), answer = this.look.answerTo(query);
    const listed = answer.isListed ? [] : answer.moments;
    const farthest = Math.max(answer.share, answer.otherShare ?? 0, ...listed.map((contact) => contact.share));
    for (const { place, radius } of data.swept(query, farthest)) bounds.add(place, radius);
    // What it meets, or what was left out, if it is not much larger.
    const most = bounds.diagonal;
    for (const object of [answer.touched, ...listed.map((contact) => contact.object), ...(data.left[query] ?? [])]) {
      const i = place.get(object);
      if (i !== undefined && objects.radius[i] < most) bounds.add(objects.centreOf(i), objects.radius[i]);
    }
    this.lookAt(bounds);
  }
  fly(now) {
    const { from, end, begun } = this.flight, share = Math.min((now - begun) / 500, 1), s = share * share * (3 - 2 * share);
    this.camera.target = between(from.target, end.target, s);
    this.camera.distance = from.distance * (end.distance / from.distance) ** s;
    if (share === 1) this.flight = null;
    this.change();
  }

  // Drawing

  frame() {
    const now = performance.now(), passed = now - this.last;
    this.last = now;
    const { clientWidth, clientHeight } = this.canvas, scale = devicePixelRatio;
    if (this.canvas.width !== Math.round(clientWidth * scale) || this.canvas.height !== Math.round(clientHeight * scale)) {
      Object.assign(this.canvas, { width: Math.round(clientWidth * scale), height: Math.round(clientHeight * scale) });
      this.change();
    }
    if (this.flight) this.fly(now);
    if (this.playing) this.advance(Math.min(passed, 200));
    if (this.stale) {
      // What moves gets as many triangles as can be drawn in time.
      if (this.wasStale && passed > 0) {
        this.budget = Math.min(Math.max(this.budget * (passed > 60 ? 0.8 : passed < 30 ? 1.1 : 1), 10000), 4e6);
      }
      this.draw(this.budget);
    } else if (this.stage.simplified && now - this.restless > 250) {
      this.draw(4e6);
    }
    this.wasStale = this.stale;
    this.stale = false;
    requestAnimationFrame(() => this.frame());
  }
  draw(budget) {
    if (this.renderer.gl.isContextLost()) return;
    const { scene } = this.look;
    if (scene !== this.drawnScene) this.renderer.keepOnly([...this.data.scene(scene).meshes, BOX, TRIANGLE]);
    this.drawnScene = scene;
    this.stage.begin(budget);
    this.look.fill(this.stage);
    this.stage.settle();
    this.stage.drawWith(this.renderer);
    this.overlay.draw(this.camera, this.look, this.stage.labels);
  }

  advance(passed) {
    const time = this.look.time + passed / 3000;
    this.seek(Math.min(time, 1));
    if (time < 1) return;
    this.play(false);
    this.tour.shift();
    if (this.tour.length > 0) setTimeout(() => this.tour.length > 0 && this.follow(this.tour[0]), 2500);
  }
  /** A part of the tour: {query, play: "alone" or "all"}. */
  follow(/** @type {{query?: number, play?: string}} */ { query, play }) {
    if (query !== undefined) this.choose(query, { fly: true });
    if (!play) return;
    if (play === "all") {
      this.choose(-1);
      this.whole();
    }
    this.setAlone(play === "alone");
    this.seek(0);
    this.play(true);
  }
  setAlone(alone) {
    the("input", "alone").checked = alone;
    this.change({ alone });
  }

  // In words

  describe() {
    const { data, look } = this, place = the("div", "chosen"), query = look.chosen;
    place.replaceChildren();
    if (look.object >= 0) {
      const { objects, numbers } = data.scene(look.scene), number = numbers[look.object];
      made(place, "h2", "", `Object ${number}`);
      const name = data.nameOf(look.scene, number);
      if (name) made(place, "p", "", name);
      made(place, "p", "", sizeInWords("Mesh", objects.meshOf(look.object)));
      const only = made(place, "button", "", "Show what meets it");
      only.onclick = () => this.table.filter({ object: `${number}` });
    }
    if (query < 0) return;
    const { kind } = look.answer, head = made(place, "h2", kind, `${SYMBOLS[kind]} ${data.queries.id[query]}`);
    head.title = kindInWords(kind);
    for (const line of inWords(look.answer)) made(place, "p", "", line);
    const { moments } = data.answers[query];
    if (moments.length) this.describeMoments(place, moments);
    if (data.scopes[query]) drawScopes(place, data.scopes[query]);
  }
  /** Buttons that show the moments that a query lists. */
  describeMoments(place, moments) {
    made(place, "p", "", moments[0].as === "contact" ? "First contacts, one with each object:" : "On its way:");
    const list = made(place, "ol"), { as, object } = this.look.answer;
    moments.forEach((moment, i) => {
      const button = made(made(list, "li"), "button", moment.status, momentInWords(moment));
      button.ariaPressed = `${moment.object === object && moment.as === (as || "contact")}`;
      button.onclick = () => {
        this.change({ contact: i });
        this.describe();
        place.querySelectorAll("button")[i].focus();
        this.flyTo(moment.query);
      };
    });
  }

  // Hands on

  pick(x, y) {
    const { data, look } = this, scale = devicePixelRatio;
    this.stage.drawWith(this.renderer, true);
    const number = this.renderer.numberAt(Math.floor(x * scale), Math.floor(y * scale));
    const objects = data.scene(look.scene).objects.count;
    this.change();
    if (number > objects) {
      this.choose(number - 1 - objects);
    } else {
      this.choose(-1);
      this.change({ object: number - 1 });
      this.describe();
    }
  }
  /** Hands have moved the camera. */
  moved() {
    this.flight = null;
    this.change();
  }

  listen() {
    const { canvas, hands } = this, time = the("input", "time"), alone = the("input", "alone"), by = the("select", "by");
    canvas.onpointerdown = (event) => {
      hands.press(event);
      canvas.setPointerCapture(event.pointerId);
    };
    canvas.onpointermove = (event) => hands.move(event) && this.moved();
    canvas.onpointerup = (event) => hands.release(event) && this.pick(event.offsetX, event.offsetY);
    canvas.onpointercancel = (event) => hands.release(event);
    // A click leaves the arrows to the rows, but takes the keys from a field.
    canvas.onmousedown = (event) => {
      event.preventDefault();
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    };
    canvas.oncontextmenu = (event) => event.preventDefault();
    canvas.onwheel = (event) => {
      event.preventDefault();
      this.camera.zoom(Math.exp(0.0015 * event.deltaY));
      this.moved();
    };
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.overlay.tell("The browser has lost its graphics device; the picture returns with it.");
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.renderer.create();
      this.overlay.tell();
      this.change();
    });
    time.oninput = () => this.seek(Number(time.value));
    alone.oninput = () => this.setAlone(alone.checked);
    by.oninput = () => this.change({ by: by.value });
    the("button", "play").onclick = () => this.play();
    document.onkeydown = (event) => this.key(event);
  }
  key(event) {
    const { target, key } = event, is = (selector) => target.matches(selector);
    if (event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey || is("select, input:not([type])")) return;
    // What has the focus needs its own keys.
    if ((key === " " && is("button, [type=checkbox]")) || (key.startsWith("Arrow") && is("[type=range]"))) return;
    if ((is("canvas") || !key.startsWith("Arrow")) && this.hands.key(event)) this.moved();
    else if (this.keys()[key]) this.keys()[key]();
    else return;
    event.preventDefault();
  }
  keys() {
    return {
      " ": () => this.play(),
      ArrowDown: () => this.choose(this.table.beside(1), { fly: true }),
      ArrowUp: () => this.choose(this.table.beside(-1), { fly: true }),
      f: () => this.look.chosen >= 0 && this.flyTo(this.look.chosen),
      a: () => this.setAlone(!this.look.alone),
      h: () => this.whole(),
      Escape: () => this.choose(-1),
    };
  }
}

try {
  Object.assign(window, { view: new Page(the("script", "data").textContent) });
} catch (error) {
  the("p", "note").textContent = error.message;
  throw error;
}
