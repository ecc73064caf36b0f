// What the patterns measure, for each paint: a table with what has changed since the picture before, and charts. It comes
// after the picture and never holds it up.

import { measure } from "./api.js";
import { count, drawn, figure, make } from "./dom.js";

/** How long the hand has to rest before anything is measured, in milliseconds. */
const REST = 120;

/** The measures in the order of the table: key, words, what they say; the first are always shown. */
const CHIEF = [
  ["e_contrast", "Contrast of neighbours", "How far neighbours are turned apart, 0 to 1"],
  ["e_share", "Of the contrast possible", "The contrast as a share of the most that these links allow"],
  ["h_angle", "Evenness of directions", "How evenly directions are used, 0 to 1"],
  ["xi", "Likeness reaches, links", "Correlation length: over how many links tiles still have to do with each other"],
  ["c_cov", "Area covered by tiles", "The share of the region that tiles cover"],
  ["u_vor", "Unevenness of cells", "How much the cells' sizes differ"],
  ["density_contrast", "Ink contrast", "How much neighbours differ in ink"],
  ["grain", "Grain", "How much of a grain the pattern has, 0 to 1"],
];

const MORE = [
  ["e_bound", "Contrast possible", "The most contrast that these links allow"],
  ["p5_contrast", "Contrast of 95 % of links", "95 % of the links have more contrast than this"],
  ["min_contrast", "Least contrast of a link", "The least contrast of a link"],
  ["e_contrast_layers", "Contrast of layers", "Contrast of the nearest layers"],
  ["p5_contrast_layers", "Layers, 95 % of links", "95 % of the links have more contrast than this, layer against layer"],
  ["e_contrast_k", "Contrast weighted by k", "Contrast, weighted by k"],
  ["e_contrast_tangent", "Contrast at tiles' edges", "Contrast where strokes leave their tiles"],
  ["joint", "Contrast × directions", "Contrast times evenness of directions"],
  ["xi_r2", "Fit of the reach, R²", "How well the exponential fits, of which the reach is told"],
  ["decay_a", "Exponent of the decay", "Exponent of the power law that fits best"],
  ["r_hat_peak", "Strongest frequency", "In radians a link"],
  ["tile_isotropy", "Evenness within a tile", "How evenly strokes cross in a tile"],
  ["grain_contrast", "Grain: contrast", "Neighbours part everywhere"],
  ["grain_directions", "Grain: directions", "Many directions wherever one looks"],
  ["grain_evenness", "Grain: evenness", "Tiles lie evenly"],
  ["grain_disorder", "Grain: disorder", "Tiles stand in no rows"],
  ["grain_looseness", "Grain: looseness", "Cells are not cut to one measure"],
];

/** What is said in place of a reach that cannot be told. */
const AT_BOUND = "No reach can be told: likeness does not fall off with distance here, and the fit ended on its bound";

/** The charts in the order of the page. */
const CHARTS = ["correlogram", "directions", "contrast", "decay", "spectrum", "cells"];

export class Measures {
  #element;
  #enlarge;
  #timer = 0;
  #abort = null;
  #answer = null;
  #measured = null;
  #before = new Map();
  #after = new Map();
  #paint = null;
  #addresses = [];
  #isMore = false;

  /** `enlarge(address, title)` shows a chart large. */
  constructor(element, enlarge) {
    this.#element = element;
    this.#enlarge = enlarge;
  }

  /** Takes the drawing that is shown now. */
  put(answer) {
    this.cancel();
    this.#answer = answer;
    this.refresh();
  }

  /** Measures what is shown, if it is not and the pane is open. */
  refresh() {
    if (this.#element.hidden || !this.#answer || this.#measured === this.#answer.id || this.#abort) return;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#measure(this.#answer), REST);
  }

  /** Gives up what is under way: a newer picture comes. */
  cancel() {
    clearTimeout(this.#timer);
    this.#abort?.abort();
    this.#abort = null;
    this.#element.toggleAttribute("data-old", this.#measured !== null);
  }

  async #measure(answer) {
    const abort = new AbortController();
    this.#abort = abort;
    try {
      const said = await measure(answer.id, abort.signal);
      this.#measured = answer.id;
      this.#before = this.#after;
      this.#after = new Map(said.paints.map((paint) => [paint.paint, paint]));
      this.#draw(said);
    } catch (error) {
      if (error.name === "AbortError") return;
      this.#element.replaceChildren(make("p", { className: "soft" }, error.message));
    } finally {
      if (this.#abort === abort) this.#abort = null;
    }
    this.#element.removeAttribute("data-old");
  }

  #draw(said) {
    const names = said.paints.map(({ paint }) => paint);
    if (!names.includes(this.#paint)) this.#paint = names[0] ?? null;
    for (const address of this.#addresses) URL.revokeObjectURL(address);
    this.#addresses = [];
    if (this.#paint === null) {
      this.#element.replaceChildren(make("p", { className: "soft" }, "Nothing here has tiles to measure."));
      return;
    }
    const choose = make("select", { className: "box wide", "aria-label": "Paint" });
    choose.append(...names.map((name) => make("option", { value: name }, name)));
    choose.value = this.#paint;
    choose.addEventListener("change", () => {
      this.#paint = choose.value;
      this.#draw(said);
      this.#element.querySelector("select")?.focus();
    });
    const charts = said.charts?.[this.#paint] ?? {};
    const kinds = [...CHARTS.filter((kind) => kind in charts), ...Object.keys(charts).filter((kind) => !CHARTS.includes(kind))];
    const more = make("details", { className: "more", open: this.#isMore }, make("summary", {}, "More measures"), this.#table(MORE));
    more.addEventListener("toggle", () => (this.#isMore = more.open));
    const figures = kinds.map((kind) => this.#chart(kind, charts[kind]));
    this.#element.replaceChildren(
      ...(names.length > 1 ? [choose] : []),
      this.#table(CHIEF, true),
      ...figures.slice(0, 1),
      more,
      make("div", { className: "charts" }, ...figures.slice(1)),
    );
  }

  #table(rows, isChief = false) {
    const after = this.#after.get(this.#paint);
    const before = this.#before.get(this.#paint);
    const line = (words, title, value, change) =>
      make("tr", { title }, make("th", { scope: "row" }, words), make("td", { className: "change" }, change), make("td", { className: "value" }, value));
    const counts = isChief
      ? [
          line("Tiles inside", "Tiles whose sites lie in the region", count(after.tiles), difference(after.tiles, before?.tiles)),
          line("Links among them", "Links between neighbours inside", count(after.edges), difference(after.edges, before?.edges)),
        ]
      : [];
    const measured = rows.filter(([key]) => typeof after[key] === "number");
    const lines = measured.map(([key, words, title]) => {
      if (key === "xi" && after.xi_at_bound) return line(words, `${AT_BOUND} (${key})`, "at the bound", "");
      return line(words, `${title} (${key})`, figure(after[key]), difference(after[key], before?.[key]));
    });
    return make("table", { className: "measures" }, make("tbody", {}, ...counts, ...lines));
  }

  #chart(kind, svg) {
    const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    this.#addresses.push(address);
    const title = `${kind[0].toUpperCase()}${kind.slice(1)} of ${this.#paint}`;
    const open = () => this.#enlarge(address, title);
    const { r } = this.#after.get(this.#paint);
    const isSmall = kind === "correlogram" && Array.isArray(r) && r.length > 1 && r.every(Number.isFinite);
    const content = isSmall ? correlogram(r, title) : make("img", { src: address, alt: title });
    return make("button", { className: "chart", title: `${title}: show it large`, "aria-label": title, onclick: open }, content);
  }
}

/** The size of the small correlogram, in its own pixels, and the room for its letters. */
const SMALL = { width: 310, height: 180, left: 44, right: 10, top: 30, bottom: 44 };

/** The correlogram as the panel has room for: fewer letters than the large one, and in the page's colours. */
function correlogram(r, title) {
  const { width, height, left, right, top, bottom } = SMALL;
  const [least, most] = [Math.min(0, ...r), Math.max(0, ...r)];
  const x = (k) => left + ((k - 0.5) / r.length) * (width - left - right);
  const y = (value) => top + ((most - value) / (most - least || 1)) * (height - top - bottom);
  const words = (at, text, side = "middle") => drawn("text", { ...at, "text-anchor": side }, text);
  // Two ends that would lie on the zero line's letters are left out.
  const levels = [most, least].filter((level) => Math.abs(y(level) - y(0)) > 13);
  const distances = r.map((_, i) => i + 1).filter((k) => k === 1 || k % (r.length > 8 ? 5 : 1) === 0);
  return drawn(
    "svg",
    { class: "correlogram", viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": title },
    words({ x: width / 2, y: 15, class: "head" }, title),
    ...[0, ...levels].map((level) => words({ x: left - 6, y: y(level) + 4 }, figure(level, 2), "end")),
    ...distances.map((k) => words({ x: x(k), y: height - 19 }, String(k))),
    words({ x: (left + width - right) / 2, y: height - 4 }, "distance in links"),
    ...r.map((value, i) => drawn("line", { class: "stem", x1: x(i + 1), x2: x(i + 1), y1: y(0), y2: y(value) })),
    ...r.map((value, i) => drawn("circle", { cx: x(i + 1), cy: y(value), r: 3 })),
    drawn("line", { class: "zero", x1: left, x2: width - right, y1: y(0), y2: y(0) }),
  );
}

/** What has changed, with its sign; nothing where nothing has that the figures would show. */
function difference(after, before) {
  if (typeof before !== "number") return "";
  const change = after - before;
  if (Math.abs(change) < 0.0005 * Math.max(0.1, Math.abs(before))) return "";
  return `${change > 0 ? "+" : "−"}${figure(Math.abs(change), 2)}`;
}
