// The list of queries: sorted, filtered, and drawn only where it is scrolled to.

import { SYMBOLS } from "./colours.js";
import { made } from "./elements.js";
import { askedInWords, inDigits, kindInWords } from "./words.js";

/**
 * @typedef {import("./data.js").Answer} Answer
 * @typedef {{name: string, isNumber?: boolean, value: (answer: Answer) => number | string,
 *   text: (answer: Answer) => string}} Column
 */

/** @type {Column[]} `value` sorts. */
export const COLUMNS = [
  {
    name: "status", value: ({ data, status }) => data.statuses.indexOf(status),
    text: ({ data, query, kind }) => `${SYMBOLS[kind]} ${kind === "part" ? `clear, ${data.left[query].length} left out` : kind}`,
  },
  { name: "query", value: ({ data, query }) => data.queries.id[query], text: ({ data, query }) => data.queries.id[query] },
  {
    name: "t", isNumber: true, value: ({ saysOnlyWhether, t, hi }) => (saysOnlyWhether ? hi : t),
    text: ({ saysOnlyWhether, t, hi }) => (saysOnlyWhether ? `≤ ${inDigits(hi)}` : inDigits(t)),
  },
  { name: "hi − lo", isNumber: true, value: ({ width }) => width, text: ({ width }) => inDigits(width, 2) },
  {
    name: "object", isNumber: true, value: ({ object }) => object,
    text: ({ data, query, object, otherBody, moments }) => {
      if (object === data.none) return data.linkName(query, otherBody);
      const name = data.nameOf(data.queries.scene[query], object), others = moments.filter(({ as }) => as === "contact").length - 1;
      return `${object}${name ? ` (${name})` : ""}${others > 0 ? ` + ${others}` : ""}`;
    },
  },
  { name: "asked", value: askedInWords, text: askedInWords },
];

/** The queries that filters leave, in the order of a column. */
export class Listing {
  /** @param {import("./data.js").Data} data */
  constructor(data) {
    this.answers = [...data.answers];
    /** Kinds of answers; empty: all. */
    this.kinds = new Set();
    /** A part of ids, and a number of an object; empty: any. */
    this.id = "";
    this.object = "";
    /** @type {?Column} */
    this.column = null;
    this.descending = false;
    /** @type {number[]} queries */
    this.rows = [];
    this.filter();
  }

  /** What is not given stays as it is. */
  filter({ kinds = this.kinds, id = this.id, object = this.object } = {}) {
    Object.assign(this, { kinds, id, object });
    const part = id.toLowerCase(), number = object.trim();
    this.rows = this.answers.filter((answer) =>
      (kinds.size === 0 || kinds.has(answer.kind)) &&
      (part === "" || answer.data.queries.id[answer.query].toLowerCase().includes(part)) &&
      (number === "" || [answer, ...answer.moments].some(({ object }) => `${object}` === number))).map(({ query }) => query);
  }

  /** By a column; again: the other way round. */
  sort(/** @type {Column} */ column) {
    this.descending = this.column === column && !this.descending;
    this.column = column;
    const sign = this.descending ? -1 : 1, values = new Map(this.answers.map((answer) => [answer, column.value(answer)]));
    const compare = (a, b) => (a < b ? -1 : a > b ? 1 : Number(Number.isNaN(a)) - Number(Number.isNaN(b)));
    this.answers.sort((a, b) => sign * compare(values.get(a), values.get(b)) || a.query - b.query);
    this.filter();
  }

  /** The query that stands so many rows below; the first if that query has no row; undefined if there are none. */
  beside(query, steps) {
    const row = this.rows.indexOf(query);
    return this.rows[Math.min(Math.max(row < 0 ? 0 : row + steps, 0), this.rows.length - 1)];
  }
}

const ROW_HEIGHT = 24;

export class Table {
  /**
   * `choose`: called with a query; `show`: with those that the filters leave.
   * @param {import("./data.js").Data} data
   * @param {HTMLElement} place
   * @param {{choose: (query: number) => void, show: (queries: number[]) => void}} calls
   */
  constructor(data, place, { choose, show }) {
    this.data = data;
    this.listing = new Listing(data);
    this.choose = choose;
    this.show = show;
    this.chosen = -1;
    this.columns = Object.keys(data.queries.asked).length ? COLUMNS : COLUMNS.filter(({ value }) => value !== askedInWords);
    place.classList.toggle("asks", this.columns === COLUMNS);
    const filters = made(place, "div", "filters");
    this.makeChips(filters);
    this.id = this.field(filters, "id", "part of an id", "7.5em");
    this.object = this.field(filters, "object", "object", "4.5em");
    this.scroller = made(place, "div", "scroller", "", "grid");
    Object.assign(this.scroller, { tabIndex: 0, ariaLabel: "Queries and their answers" });
    this.heads = this.makeHeads();
    this.room = made(this.scroller, "div", "room", "", "rowgroup");
    this.scroller.onscroll = () => this.draw();
    this.scroller.onkeydown = (event) => this.page(event);
    new ResizeObserver(() => this.draw()).observe(this.scroller);
    this.filter();
  }

  makeChips(place) {
    const { listing } = this, counts = new Map();
    for (const { kind } of this.data.answers) counts.set(kind, (counts.get(kind) ?? 0) + 1);
    for (const [kind, count] of counts) {
      const button = made(place, "button", `chip ${kind}`, `${SYMBOLS[kind]} ${kindInWords(kind)} ${count}`);
      button.ariaPressed = "false";
      button.onclick = () => {
        if (!listing.kinds.delete(kind)) listing.kinds.add(kind);
        button.ariaPressed = `${listing.kinds.has(kind)}`;
        this.filter();
      };
    }
  }
  field(place, name, hint, width) {
    const input = made(place, "input");
    Object.assign(input, { placeholder: hint, ariaLabel: `Filter by ${hint}` });
    input.oninput = () => this.filter({ [name]: input.value });
    input.style.width = width;
    return input;
  }
  makeHeads() {
    // Within what scrolls, so that a scrollbar moves them as it moves the columns.
    const row = made(this.scroller, "div", "row heads", "", "row");
    row.ariaRowIndex = "1";
    return this.columns.map((column) => {
      const cell = made(row, "span", column.isNumber ? "number" : "", "", "columnheader");
      const head = made(cell, "button", "", column.name);
      head.title = `Sort by ${column.name}`;
      head.onclick = () => {
        this.listing.sort(column);
        this.filter();
      };
      return cell;
    });
  }

  /** Applies filters, as Listing.filter does, and shows them. */
  filter(given = {}) {
    const { listing } = this;
    listing.filter(given);
    for (const name of ["id", "object"]) if (this[name].value !== listing[name]) this[name].value = listing[name];
    this.show([...listing.rows]);
    this.draw();
  }

  /** Marks a query and scrolls to it. */
  mark(query) {
    this.chosen = query;
    const row = this.listing.rows.indexOf(query), top = row * ROW_HEIGHT, { scrollTop, clientHeight } = this.scroller;
    if (row >= 0 && (top < scrollTop || top + 2 * ROW_HEIGHT > scrollTop + clientHeight)) {
      this.scroller.scrollTop = top - 0.4 * clientHeight;
    }
    this.draw();
  }

  /** The query `steps` rows below the marked one. */
  beside(steps) {
    return this.listing.beside(this.chosen, steps);
  }
  /** Keys that would scroll choose a row. */
  page(event) {
    const rows = Math.max(1, Math.floor(this.scroller.clientHeight / ROW_HEIGHT) - 2);
    const steps = { PageDown: rows, PageUp: -rows, Home: -Infinity, End: Infinity }[event.key];
    if (steps === undefined) return;
    event.preventDefault();
    this.choose(this.beside(steps));
  }

  draw() {
    const { data, room, scroller, listing: { rows, column, descending } } = this;
    scroller.ariaRowCount = `${rows.length + 1}`;
    this.columns.forEach((one, i) => (this.heads[i].ariaSort = one !== column ? "none" : descending ? "descending" : "ascending"));
    room.style.height = `${rows.length * ROW_HEIGHT}px`;
    room.replaceChildren();
    const first = Math.max(0, Math.floor(scroller.scrollTop / ROW_HEIGHT) - 4);
    const end = Math.min(rows.length, first + Math.ceil(scroller.clientHeight / ROW_HEIGHT) + 8);
    for (let place = first; place < end; ++place) this.drawRow(data.answers[rows[place]], place);
    const chosen = rows.indexOf(this.chosen);
    if (chosen >= first && chosen < end) scroller.setAttribute("aria-activedescendant", `row${this.chosen}`);
    else scroller.removeAttribute("aria-activedescendant");
  }
  drawRow(/** @type {Answer} */ answer, /** @type {number} */ place) {
    const { query, kind } = answer, row = made(this.room, "div", "row", "", "row");
    Object.assign(row, { id: `row${query}`, ariaRowIndex: `${place + 2}`, ariaSelected: `${query === this.chosen}` });
    row.style.top = `${place * ROW_HEIGHT}px`;
    row.onclick = () => this.choose(query);
    this.columns.forEach((column, k) => {
      const text = column.text(answer), name = k === 0 ? kind : column.isNumber ? "number" : "";
      made(row, "span", name, text, "gridcell").title = text;
    });
  }
}
