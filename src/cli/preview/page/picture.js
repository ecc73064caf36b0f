// The picture on the page's sheet. A small drawing is one SVG, which stays sharp at any zoom; a large one is tiles. The old
// picture stays until the new one is there.

import { svgAddress } from "./api.js";
import { make } from "./dom.js";
import { loadImage } from "./image.js";
import { Tiles } from "./tiles.js";

/** The next time that the screen has been painted. */
const painted = () =>
  new Promise((resolve) => {
    const timer = setTimeout(resolve, 100); // A page in the background is not painted.
    requestAnimationFrame(() => {
      clearTimeout(timer);
      setTimeout(resolve);
    });
  });

export class Picture {
  #sheet;
  #view;
  #content = null;
  #onLost;

  /** The answer whose picture is shown, and which of its layers are not. */
  shown = null;

  /** `onLost` is called when the server does not know the drawing that is shown any more. */
  constructor(sheet, view, onLost) {
    this.#sheet = sheet;
    this.#view = view;
    this.#onLost = onLost;
  }

  /** Shows a drawing without the layers of these numbers, and returns when it is on the screen. */
  async show(answer, hide, signal) {
    const content = answer.show === "tiles" ? new Tiles(answer, hide, this.#onLost) : new Whole(answer, hide);
    const { page } = answer;
    await content.load(this.#sight(page), signal);
    signal?.throwIfAborted();
    const before = this.#content;
    this.#content = content;
    this.shown = { answer, hide };
    this.#sheet.append(content.element);
    before?.drop();
    this.#sheet.dataset.paper = page.paper === null ? "none" : "";
    this.#sheet.style.setProperty("--paper", page.paper ?? "transparent");
    this.#view.page(page);
    await painted();
  }

  /** Puts the sheet where the view says. */
  place() {
    const { page } = this.shown?.answer ?? {};
    if (!page) return;
    const { x, y, scale } = this.#view;
    const grain = 1 / (window.devicePixelRatio || 1);
    const whole = (value) => Math.round(value / grain) * grain;
    this.#sheet.style.transform = `translate(${whole(x)}px, ${whole(y)}px)`;
    this.#sheet.style.width = `${page.width * scale}px`;
    this.#sheet.style.height = `${page.height * scale}px`;
    this.#content.look(this.#sight(page));
  }

  /** What of a page is seen, in millimetres, and how large it is: as far as it is known where a new page will lie. */
  #sight(page) {
    const { x, y, scale, size } = this.#view;
    const old = this.shown?.answer.page;
    const isNew = !old || old.width !== page.width || old.height !== page.height;
    if (isNew) {
      const fitted = Math.min(size.width / page.width, size.height / page.height);
      return { left: 0, top: 0, right: page.width, bottom: page.height, scale: fitted };
    }
    return {
      left: Math.max(0, -x / scale),
      top: Math.max(0, -y / scale),
      right: Math.min(page.width, (size.width - x) / scale),
      bottom: Math.min(page.height, (size.height - y) / scale),
      scale,
    };
  }
}

/** A drawing as one SVG. */
class Whole {
  constructor(answer, hide) {
    this.address = svgAddress(answer.id, hide);
    this.element = make("div", { className: "whole" });
  }

  async load(sight, signal) {
    this.element.append(await loadImage(this.address, signal));
  }

  look() {
    // The browser draws the SVG anew at any size.
  }

  drop() {
    this.element.remove();
  }
}
