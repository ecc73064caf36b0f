// What the patterns measure, for each paint: a table with what has changed since the picture before, and charts. It comes
// after the picture and never holds it up.

import { measure } from "./api.js";
import { count, figure, make } from "./dom.js";

/** How long the hand has to rest before anything is measured, in milliseconds. */
const REST = 120;

/** The measures in the order of the table: key, words, what they say; the first are always shown. */
const CHIEF = [
  ["e_contrast", "Contrast", "How far neighbours are turned apart, 0 to 1"],
  ["e_share", "Share of the best", "The share of what these links allow"],
  ["h_angle", "Directions", "How evenly directions are used, 0 to 1"],
  ["xi", "Reach", "Correlation length, in links"],
  ["c_cov", "Covered", "The share of the region that tiles cover"],
  ["u_vor", "Unevenness", "How much the cells' sizes differ"],
  ["density_contrast", "Ink", "How much neighbours differ in ink"],
  ["grain", "Grain", "How much of a grain the pattern has, 0 to 1"],
];

const MORE = [
  ["e_bound", "Bound", "The most contrast that these links allow"],
  ["p5_contrast", "95 % have", "95 % of the links have more contrast"],
  ["min_contrast", "Least", "The least contrast of a link"],
  ["e_contrast_layers", "Layers", "Contrast of the nearest layers"],
  ["p5_contrast_layers", "95 % of layers", "95 % of the links have more, layer against layer"],
  ["e_contrast_k", "By k", "Contrast, weighted by k"],
  ["e_contrast_tangent", "Tangents", "Contrast where strokes leave their tiles"],
  ["joint", "Joint", "Contrast times directions"],
  ["xi_r2", "Fit", "How well the exponential fits"],
  ["decay_a", "Power", "Exponent of the power law"],
  ["r_hat_peak", "Peak", "Strongest frequency, radians a link"],
  ["tile_isotropy", "Isotropy", "How evenly strokes cross in a tile"],
  ["grain_contrast", "Parting", "Neighbours part everywhere"],
  ["grain_directions", "Many ways", "Many directions wherever one looks"],
  ["grain_evenness", "Evenness", "Tiles lie evenly"],
  ["grain_disorder", "Disorder", "Tiles stand in no rows"],
  ["grain_looseness", "Looseness", "Cells are not cut to one measure"],
];

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
      make("tr", { title }, make("th", { scope: "row" }, words), make("td", {}, value), make("td", { className: "change" }, change));
    const counts = isChief
      ? [
          line("Tiles", "Tiles whose sites lie in the region", count(after.tiles), difference(after.tiles, before?.tiles)),
          line("Links", "Links among them", count(after.edges), difference(after.edges, before?.edges)),
        ]
      : [];
    const measured = rows.filter(([key]) => typeof after[key] === "number");
    const lines = measured.map(([key, words, title]) => line(words, `${title} (${key})`, figure(after[key]), difference(after[key], before?.[key])));
    return make("table", { className: "measures" }, make("tbody", {}, ...counts, ...lines));
  }

  #chart(kind, svg) {
    const address = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    this.#addresses.push(address);
    const title = `${kind[0].toUpperCase()}${kind.slice(1)} of ${this.#paint}`;
    const open = () => this.#enlarge(address, title);
    return make("button", { className: "chart", title: `${title}: show it large`, onclick: open }, make("img", { src: address, alt: title }));
  }
}

/** What has changed, with its sign; nothing where nothing has that the figures would show. */
function difference(after, before) {
  if (typeof before !== "number") return "";
  const change = after - before;
  if (Math.abs(change) < 0.0005 * Math.max(0.1, Math.abs(before))) return "";
  return `${change > 0 ? "+" : "−"}${figure(Math.abs(change), 2)}`;
}
