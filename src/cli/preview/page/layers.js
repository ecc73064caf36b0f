// What of the drawing is shown: layers, one paint alone, overlays.

import { icon, make, plural, setIcon } from "./dom.js";

/** The overlays, what they are called and what they show. */
export const OVERLAYS = [
  ["sites", "Sites", "A dot where each tile stands"],
  ["graph", "Graph", "The links between neighbours"],
  ["cells", "Cells", "The cell of each site"],
  ["angles", "Angles", "Each tile's direction, in its colour"],
  ["k", "k", "How many layers each tile has"],
  ["contrast", "Contrast", "How far neighbours are turned apart"],
];

/** Whether a layer is an overlay's or the veil below them: those come and go with the buttons above, and are many. */
const isOverlay = ({ name, groups }) => groups.some((group) => group.startsWith("overlay ")) || (name === "overlay veil" && groups.length === 0);

/** Layers by names that stay when others come or go: the second of a name has a number. Layers of overlays have none. */
export function keysOf(layers) {
  const seen = new Map();
  return layers.map((layer) => {
    if (isOverlay(layer)) return null;
    const { name } = layer;
    const times = (seen.get(name) ?? 0) + 1;
    seen.set(name, times);
    return times === 1 ? name : `${name} (${times})`;
  });
}

/** The numbers of the layers that are hidden. */
export function hiddenNumbers(layers, hidden) {
  return keysOf(layers).flatMap((key, i) => (hidden.includes(key) ? [i] : []));
}

/** The buttons for overlays. */
export class Overlays {
  #buttons;

  constructor(element, wish) {
    this.#buttons = OVERLAYS.map(([name, words, title]) =>
      make(
        "button",
        { className: "chip", title, "aria-pressed": "false", "data-overlay": name, onclick: () => toggle(wish, name) },
        words,
      ),
    );
    element.replaceChildren(...this.#buttons);
  }

  refresh({ overlays }) {
    for (const button of this.#buttons) {
      button.setAttribute("aria-pressed", String(overlays.includes(button.dataset.overlay)));
    }
  }
}

function toggle(wish, name) {
  const { overlays } = wish.now;
  const others = overlays.filter((other) => other !== name);
  const names = OVERLAYS.map(([known]) => known);
  const next = others.length < overlays.length ? others : names.filter((known) => known === name || others.includes(known));
  wish.show({ overlays: next });
}

/** The list of layers, topmost first as in other drawing programs. */
export class Layers {
  #list;
  #all;
  #wish;
  #rows = [];
  #signature = "";

  constructor(list, all, wish) {
    this.#list = list;
    this.#all = all;
    this.#wish = wish;
    all.addEventListener("click", () => wish.show({ hidden: [] }));
  }

  put({ layers: all }) {
    const layers = all.filter((layer) => !isOverlay(layer));
    const signature = JSON.stringify(layers.map(({ name, ink }) => [name, ink]));
    if (signature !== this.#signature) {
      const keys = keysOf(layers);
      this.#rows = layers.map((layer, i) => this.#row(layer, keys[i]));
      this.#list.replaceChildren(...this.#rows.map((row) => row.element).reverse());
      this.#signature = signature;
    }
    layers.forEach(({ marks }, i) => (this.#rows[i].marks.textContent = plural(marks, "mark")));
    this.refresh(this.#wish.now);
  }

  refresh({ hidden }) {
    for (const { key, element, eye } of this.#rows) {
      const isHidden = hidden.includes(key);
      element.toggleAttribute("data-hidden", isHidden);
      eye.setAttribute("aria-checked", String(!isHidden));
      setIcon(eye, isHidden ? "eye-off" : "eye");
    }
    this.#all.hidden = !this.#rows.some(({ key }) => hidden.includes(key));
  }

  #row({ name, ink }, key) {
    const flip = () => {
      const { hidden } = this.#wish.now;
      const others = hidden.filter((other) => other !== key);
      this.#wish.show({ hidden: others.length < hidden.length ? others : [...hidden, key] });
    };
    const eye = make("button", { className: "layer", role: "switch", "aria-checked": "true", "data-layer": key, onclick: flip }, icon("eye"));
    const swatch = make("span", { className: "swatch" });
    swatch.style.setProperty("--colour", ink ?? "transparent");
    const marks = make("span", { className: "soft marks", title: "Strokes, dots and outlines" });
    eye.append(swatch, make("span", { className: "layer-name" }, name), marks);
    const element = make("li", {}, eye);
    return { key, element, eye, marks };
  }
}

/** The list that chooses one paint to be drawn alone. */
export class Only {
  #row;
  #list;

  constructor(row, list, wish) {
    this.#row = row;
    this.#list = list;
    list.addEventListener("change", () => wish.show({ only: list.value === "" ? null : list.value.slice(1) }));
  }

  put({ paints }, { only }) {
    // A paint may be called anything: the values carry a sign before the name.
    const options = paints.map((name) => make("option", { value: `=${name}` }, `${name} alone`));
    const isThere = only === null || paints.includes(only);
    if (!isThere) options.push(make("option", { value: `=${only}` }, `${only} alone (not there)`));
    this.#list.replaceChildren(make("option", { value: "" }, "all paints"), ...options);
    this.#list.value = only === null ? "" : `=${only}`;
    this.#row.hidden = paints.length < 2 && only === null;
  }
}
