// The list of queries: sorted, filtered, and drawn only where it is scrolled to.

const ROW_HEIGHT = 24;
/** Of its bracket; NaN if it says nothing. */
const widthOf = (data, i) => (data.saysOnlyWhether(i) ? NaN : data.answers.hi[i] - data.answers.lo[i]);
const COLUMNS = [
  { name: "status", value: (data, i) => data.answers.status[i] },
  { name: "query", value: (data, i) => data.queries.id[i] },
  { name: "t", value: (data, i) => (data.saysOnlyWhether(i) ? data.answers.hi : data.answers.t)[i] },
  { name: "hi − lo", value: (data, i) => widthOf(data, i) },
  { name: "object", value: (data, i) => data.answers.object[i] },
];

function made(parent, tag, className = "", text = "") {
  const element = document.createElement(tag);
  element.className = className;
  element.textContent = text;
  parent.append(element);
  return element;
}

class Table {
  /** Calls `choose` with a query's number; `show` with the numbers that the filters leave. */
  constructor(data, place, { choose, show }) {
    Object.assign(this, { data, choose, show, column: null, descending: false, statuses: new Set(), rows: [] });
    this.order = Uint32Array.from({ length: data.queries.count }, (_, i) => i);
    this.makeFilters(made(place, "div", "filters"));
    this.scroller = made(place, "div", "scroller");
    this.scroller.tabIndex = 0;
    // Within what scrolls, so that a scrollbar moves them as it moves the columns.
    const heads = made(this.scroller, "div", "row heads");
    for (const column of COLUMNS) {
      const head = made(heads, "button", "", column.name);
      head.title = `Sort by ${column.name}`;
      head.onclick = () => this.sort(column);
    }
    this.room = made(this.scroller, "div", "room");
    this.scroller.onscroll = () => this.draw();
    new ResizeObserver(() => this.draw()).observe(this.scroller);
    this.filter();
  }

  makeFilters(place) {
    const { data } = this, counts = new Map();
    for (let i = 0; i < data.queries.count; ++i) counts.set(data.kind(i), (counts.get(data.kind(i)) ?? 0) + 1);
    for (const [status, count] of counts) {
      const button = made(place, "button", `chip ${status}`, `${SYMBOLS[status]} ${kindInWords(status)} ${count}`);
      button.onclick = () => {
        if (!this.statuses.delete(status)) this.statuses.add(status);
        button.classList.toggle("on", this.statuses.has(status));
        this.filter();
      };
    }
    const field = (hint, width) => {
      const input = made(place, "input");
      Object.assign(input, { placeholder: hint, oninput: () => this.filter() });
      input.style.width = width;
      return input;
    };
    this.id = field("part of an id", "7.5em");
    this.object = field("object", "4.5em");
  }

  /** Applies the filters, or those that are given: {statuses, id, object}. */
  filter(given = {}) {
    const { data } = this, { object } = data.answers;
    if (given.statuses) this.statuses = new Set(given.statuses);
    if (given.id !== undefined) this.id.value = given.id;
    if (given.object !== undefined) this.object.value = given.object;
    const id = this.id.value.toLowerCase(), number = this.object.value.trim();
    this.rows = this.order.filter((i) =>
      (this.statuses.size === 0 || this.statuses.has(data.kind(i))) &&
      (id === "" || data.queries.id[i].toLowerCase().includes(id)) &&
      (number === "" || `${object[i]}` === number));
    this.show([...this.rows]);
    this.draw();
  }

  sort(column) {
    this.descending = this.column === column && !this.descending;
    this.column = column;
    const sign = this.descending ? -1 : 1, values = Array.from(this.order, (_, i) => column.value(this.data, i));
    const compare = (a, b) => (a < b ? -1 : a > b ? 1 : Number.isNaN(a) - Number.isNaN(b));
    this.order.sort((i, j) => sign * compare(values[i], values[j]) || i - j);
    this.filter();
  }

  /** Marks a query and scrolls to it. */
  mark(query) {
    this.chosen = query;
    const row = this.rows.indexOf(query), top = row * ROW_HEIGHT, { scrollTop, clientHeight } = this.scroller;
    if (row >= 0 && (top < scrollTop || top + 2 * ROW_HEIGHT > scrollTop + clientHeight)) {
      this.scroller.scrollTop = top - 0.4 * clientHeight;
    }
    this.draw();
  }

  /** The query `steps` rows below the marked one. */
  beside(steps) {
    const row = this.rows.indexOf(this.chosen);
    return this.rows[Math.min(Math.max(row < 0 ? 0 : row + steps, 0), this.rows.length - 1)];
  }

  draw() {
    const { data, room, scroller } = this, { answers, queries } = data;
    room.style.height = `${this.rows.length * ROW_HEIGHT}px`;
    room.replaceChildren();
    const first = Math.max(0, Math.floor(scroller.scrollTop / ROW_HEIGHT) - 4);
    const end = Math.min(this.rows.length, first + Math.ceil(scroller.clientHeight / ROW_HEIGHT) + 8);
    for (let place = first; place < end; ++place) {
      const i = this.rows[place], kind = data.kind(i), object = answers.object[i];
      const row = made(room, "div", `row ${i === this.chosen ? "chosen" : ""}`);
      row.style.top = `${place * ROW_HEIGHT}px`;
      row.onclick = () => this.choose(i);
      const name = object === data.none ? "" : data.nameOf(queries.scene[i], object);
      const texts = [`${SYMBOLS[kind]} ${kind === "part" ? `clear, ${data.left[i].length} left out` : kind}`, queries.id[i],
        data.saysOnlyWhether(i) ? `≤ ${inDigits(answers.hi[i])}` : inDigits(answers.t[i]), inDigits(widthOf(data, i), 2),
        object === data.none ? "" : name ? `${object} (${name})` : `${object}`];
      texts.forEach((text, k) => (made(row, "span", k === 0 ? kind : k > 1 ? "number" : "", text).title = text));
    }
  }
}
