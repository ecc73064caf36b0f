// Four by four small pictures to choose from: seeds, or values of two parameters.

import { draw, thumbAddress } from "./api.js";
import { icon, make } from "./dom.js";
import { loadImage } from "./image.js";
import { seedAfter, toFragment } from "./link.js";
import { between } from "./values.js";

/** Pictures on a side. */
const SIDE = 4;

/** How many are drawn at the same time. */
const AT_ONCE = 2;

/** The side of a small picture, in its own pixels. */
const THUMB = 256;

const SEEDS = "";

export class Variations {
  #element;
  #wish;
  #params;
  #onToggle;
  #abort = null;
  #cells = [];
  #across = SEEDS;
  #down = SEEDS;
  #offset = 0;
  #seed = 0;

  /** `params()` gives the parameters as they are now, `onToggle(isOpen)` is told. */
  constructor(element, wish, params, onToggle) {
    this.#element = element;
    this.#wish = wish;
    this.#params = params;
    this.#onToggle = onToggle;
    element.addEventListener("keydown", (event) => this.#key(event));
  }

  get isOpen() {
    return !this.#element.hidden;
  }

  toggle() {
    if (this.isOpen) this.close();
    else this.open();
  }

  /** The seed of the picture that is shown: what variations start from. */
  from(seed) {
    this.#seed = seed;
  }

  open() {
    this.#element.hidden = false;
    this.#offset = 0;
    this.#onToggle(true);
    this.#draw();
    this.#cells[0]?.button.focus();
  }

  close() {
    this.#abort?.abort();
    this.#element.hidden = true;
    this.#element.replaceChildren();
    this.#onToggle(false);
  }

  /** Draws all anew: the scene has changed. */
  refresh() {
    if (this.isOpen) this.#draw();
  }

  #draw() {
    this.#abort?.abort();
    this.#abort = new AbortController();
    const able = this.#params().filter((param) => valuesOf(param).length > 1);
    const names = able.map(({ name }) => name);
    if (!names.includes(this.#across)) this.#across = SEEDS;
    if (!names.includes(this.#down) || this.#down === this.#across) this.#down = SEEDS;
    const wishes = this.#wishes(able);
    const grid = make("div", { className: "grid", role: "group", "aria-label": "Variations: arrows move, Enter chooses" });
    this.#cells = wishes.map((cell, i) => this.#cell(cell, i));
    grid.append(...this.#cells.map(({ button }) => button));
    this.#element.replaceChildren(this.#head(names), grid);
    this.#queue(this.#abort.signal);
  }

  #head(names) {
    const list = (label, value, options, take) => {
      const select = make("select", { className: "box", "aria-label": label });
      select.append(...options.map((name) => make("option", { value: name }, name === SEEDS ? "seeds" : name)));
      select.value = value;
      select.addEventListener("change", () => {
        take(select.value);
        this.#draw();
        this.#element.querySelector(`[aria-label="${label}"]`)?.focus();
      });
      return select;
    };
    const across = list("Across", this.#across, [SEEDS, ...names], (name) => {
      this.#across = name;
      // Two parameters are what the artist wants when there are two.
      if (name !== SEEDS && this.#down === SEEDS) this.#down = names.find((other) => other !== name) ?? SEEDS;
    });
    const down = list("Down", this.#down, [SEEDS, ...names.filter((name) => name !== this.#across)], (name) => (this.#down = name));
    const isSeeds = this.#across === SEEDS || this.#down === SEEDS;
    const further = () => {
      this.#offset += this.#across === SEEDS ? SIDE * SIDE : SIDE;
      this.#draw();
    };
    return make(
      "div",
      { className: "variations-head" },
      make("h2", {}, "Variations"),
      make("label", {}, "across ", across),
      this.#across === SEEDS ? null : make("label", {}, "down ", down),
      isSeeds ? make("button", { className: "tool", onclick: further }, icon("dice"), make("span", {}, "Further seeds")) : null,
      make("button", { className: "tool small close", "aria-label": "Close the variations", title: "Close (Escape)", onclick: () => this.close() }, icon("close")),
    );
  }

  /** What each picture is of, row by row. */
  #wishes(able) {
    const { now } = this.#wish;
    const find = (name) => able.find((param) => param.name === name);
    const seed = (i) => seedAfter(this.#seed, this.#offset + i);
    const across = this.#across === SEEDS ? null : find(this.#across);
    const down = this.#down === SEEDS || !across ? null : find(this.#down);
    const cells = [];
    this.#element.style.setProperty("--columns", across ? valuesOf(across).length : SIDE);
    if (!across) {
      for (let i = 0; i < SIDE * SIDE; i += 1) {
        cells.push({ part: { seed: seed(i) }, words: `seed ${seed(i)}` });
      }
      return cells;
    }
    for (let row = 0; row < SIDE; row += 1) {
      for (const value of valuesOf(across)) {
        const sets = { ...now.sets, [across.name]: value };
        if (!down) {
          cells.push({ part: { sets, seed: seed(row) }, words: `${across.name} ${value} · seed ${seed(row)}` });
          continue;
        }
        const other = valuesOf(down)[row];
        if (other === undefined) continue;
        sets[down.name] = other;
        cells.push({ part: { sets }, words: `${across.name} ${value} · ${down.name} ${other}` });
      }
    }
    return cells;
  }

  #cell({ part, words }, i) {
    const wish = { ...this.#wish.now, ...part };
    const choose = () => {
      this.close();
      this.#wish.change(part);
    };
    const isNow = toFragment({ ...wish, seed: wish.seed ?? this.#seed }) === toFragment({ ...this.#wish.now, seed: this.#seed });
    const button = make(
      "button",
      { className: "cell", tabIndex: i === 0 ? 0 : -1, "data-state": "waiting", "aria-current": isNow ? "true" : null, "aria-label": words, onclick: choose },
      make("span", { className: "thumb" }),
      make("span", { className: "caption" }, words),
    );
    return { wish, button };
  }

  /** Draws the pictures, the first ones first, a few at the same time. */
  #queue(signal) {
    const waiting = [...this.#cells];
    const work = async () => {
      for (let cell = waiting.shift(); cell && !signal.aborted; cell = waiting.shift()) {
        await this.#fill(cell, signal);
      }
    };
    for (let i = 0; i < AT_ONCE; i += 1) work();
  }

  async #fill({ wish, button }, signal) {
    try {
      const answer = await draw(wish, signal);
      if (!answer.ok) throw new Error(answer.diagnostics.find(({ severity }) => severity === "error")?.message ?? "no picture");
      const image = await loadImage(thumbAddress(answer.id, THUMB), signal);
      button.querySelector(".thumb").replaceChildren(image);
      button.dataset.state = "there";
    } catch (error) {
      if (error.name === "AbortError") return;
      button.dataset.state = "faulty";
      button.querySelector(".thumb").textContent = error.message;
    }
  }

  /** Arrows go from picture to picture. */
  #key(event) {
    if (event.key === "Escape") {
      event.stopPropagation();
      this.close();
      return;
    }
    const at = this.#cells.findIndex(({ button }) => button === document.activeElement);
    const columns = Number(this.#element.style.getPropertyValue("--columns"));
    const ways = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -columns, ArrowDown: columns, Home: -at, End: this.#cells.length - 1 - at };
    const way = ways[event.key];
    if (at < 0 || way === undefined) return;
    event.preventDefault();
    const next = this.#cells[at + way];
    if (!next) return;
    this.#cells[at].button.tabIndex = -1;
    next.button.tabIndex = 0;
    next.button.focus();
  }
}

/** Up to four values of a parameter, from one end of what it may be to the other. */
function valuesOf({ kind, range, choices }) {
  if (choices) return choices.slice(0, SIDE);
  if (kind === "bool") return ["false", "true"];
  if (!range) return [];
  return between(range.from, range.to, SIDE).map((value) => value + (range.unit ?? ""));
}
