// Where the page lies in the window: zoom at the pointer, pan, fit, and one millimetre as one millimetre. Lengths are in
// pixels of the browser (1/96 inch), scales in such pixels for a millimetre.

import { isTyping } from "./dom.js";

/** The scale at which a millimetre of the page is one on the screen, as browsers count. */
export const REAL = 96 / 25.4;

/** The least and the greatest scale. */
const LEAST = 0.02;
const MOST = 1500;

/** The least room around a page that is fitted. */
const ROOM = 32;

/** How much a key or a button zooms, and how far an arrow pans. */
const ZOOM = 1.25;
const PAN = 60;

/** How much a wheel zooms for each of its pixels; a pinch on a touch pad sends less of them. */
const WHEEL = 0.0018;
const PINCH = 0.01;

/** What a wheel counts in, in pixels: pixels, lines, pages. */
const WHEEL_UNITS = [1, 18, 400];

export class View {
  #window;
  #page = null;
  #isFitted = true;
  #covered;
  #pointers = new Map();

  scale = REAL;
  x = 0;
  y = 0;

  /**
   * `onMove` is called whenever page or window have moved; `onPoint` with the place under the pointer, or null; `covered()`
   * says how many pixels at the window's top and bottom lie under something.
   */
  constructor(element, onMove, onPoint, covered) {
    this.#window = element;
    this.onMove = onMove;
    this.#covered = covered;
    new ResizeObserver(() => (this.#isFitted ? this.fit() : this.#moved())).observe(element);
    element.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    element.addEventListener("pointerdown", (event) => this.#down(event));
    element.addEventListener("pointermove", (event) => this.#move(event, onPoint));
    element.addEventListener("pointerleave", () => onPoint(null));
    for (const name of ["pointerup", "pointercancel"]) {
      element.addEventListener(name, (event) => this.#up(event));
    }
    element.addEventListener("dblclick", (event) => this.zoom(event.shiftKey ? 0.5 : 2, this.#at(event)));
    element.addEventListener("keydown", (event) => this.#key(event));
  }

  /** The window's width and height. */
  get size() {
    return { width: this.#window.clientWidth, height: this.#window.clientHeight };
  }

  /** Takes a page of this size in millimetres; a page of another size is fitted. */
  page({ width, height }) {
    const before = this.#page;
    this.#page = { width, height };
    if (this.#isFitted || !before || before.width !== width || before.height !== height) this.fit();
    else this.#moved();
  }

  /** Fits the page again where it was fitted: something has come to lie over the window's edge, or has gone. */
  refit() {
    if (this.#isFitted) this.fit();
  }

  /** Shows the whole page. */
  fit() {
    if (!this.#page) return;
    const { width, height } = this.size;
    if (width === 0 || height === 0) return;
    const room = Math.min(ROOM, width / 12, height / 12);
    const covered = this.#covered();
    const [top, bottom] = [covered.top, covered.bottom].map((part) => Math.min(Math.max(room, part), height / 3));
    const scale = Math.min((width - 2 * room) / this.#page.width, (height - top - bottom) / this.#page.height);
    this.scale = clamp(scale);
    this.x = (width - this.#page.width * this.scale) / 2;
    // In the middle, as far as nothing covers it there.
    const middle = (height - this.#page.height * this.scale) / 2;
    this.y = Math.max(top, Math.min(middle, height - bottom - this.#page.height * this.scale));
    this.#isFitted = true;
    this.#moved();
  }

  /** Zooms to the scale at which a millimetre is a millimetre. */
  real() {
    this.zoom(REAL / this.scale);
  }

  /** Zooms by a factor around a point of the window, its middle by default. */
  zoom(factor, at = { x: this.size.width / 2, y: this.size.height / 2 }) {
    if (!this.#page) return;
    const scale = clamp(this.scale * factor);
    const share = scale / this.scale;
    this.x = at.x - (at.x - this.x) * share;
    this.y = at.y - (at.y - this.y) * share;
    this.scale = scale;
    this.#isFitted = false;
    this.#moved();
  }

  zoomIn() {
    this.zoom(ZOOM);
  }

  zoomOut() {
    this.zoom(1 / ZOOM);
  }

  /** Moves the page. */
  pan(x, y) {
    if (!this.#page) return;
    this.x += x;
    this.y += y;
    this.#isFitted = false;
    this.#moved();
  }

  /** Some of the page always stays in the window. */
  #moved() {
    if (!this.#page) return;
    const { width, height } = this.size;
    const keep = Math.min(40, width / 4, height / 4);
    this.x = Math.min(width - keep, Math.max(keep - this.#page.width * this.scale, this.x));
    this.y = Math.min(height - keep, Math.max(keep - this.#page.height * this.scale, this.y));
    this.onMove(this);
  }

  #at(event) {
    const box = this.#window.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  #wheel(event) {
    event.preventDefault();
    const unit = WHEEL_UNITS[event.deltaMode];
    if (event.shiftKey) {
      this.pan(-(event.deltaX + event.deltaY) * unit, 0);
      return;
    }
    const speed = event.ctrlKey ? PINCH : WHEEL;
    const most = Math.log(2);
    const power = Math.max(-most, Math.min(most, -event.deltaY * unit * speed));
    this.zoom(Math.exp(power), this.#at(event));
  }

  #down(event) {
    if (event.pointerType === "mouse" && event.button > 1) return;
    this.#window.setPointerCapture(event.pointerId);
    this.#window.dataset.dragging = "";
    this.#pointers.set(event.pointerId, this.#at(event));
  }

  #move(event, onPoint) {
    const at = this.#at(event);
    onPoint(this.#page && { x: (at.x - this.x) / this.scale, y: (at.y - this.y) / this.scale });
    const before = this.#pointers.get(event.pointerId);
    if (!before) return;
    const others = [...this.#pointers].filter(([id]) => id !== event.pointerId).map(([, point]) => point);
    this.#pointers.set(event.pointerId, at);
    if (others.length === 0) {
      this.pan(at.x - before.x, at.y - before.y);
      return;
    }
    // Two fingers: what is between them stays between them.
    const [other] = others;
    const [was, is] = [distance(before, other), distance(at, other)];
    this.pan((at.x - before.x) / 2, (at.y - before.y) / 2);
    if (was > 0 && is > 0) this.zoom(is / was, { x: (at.x + other.x) / 2, y: (at.y + other.y) / 2 });
  }

  #up(event) {
    this.#pointers.delete(event.pointerId);
    if (this.#pointers.size === 0) delete this.#window.dataset.dragging;
  }

  #key(event) {
    if (isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    const far = event.shiftKey ? 4 * PAN : PAN;
    const ways = { ArrowLeft: [far, 0], ArrowRight: [-far, 0], ArrowUp: [0, far], ArrowDown: [0, -far] };
    const way = ways[event.key];
    if (!way) return;
    event.preventDefault();
    this.pan(...way);
  }
}

const clamp = (scale) => Math.min(MOST, Math.max(LEAST, scale));

const distance = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);

/** The longest of 1, 2 or 5 times a power of ten millimetres that is at most this many pixels, as length and words. */
export function ruleOf(scale, pixels) {
  const most = pixels / scale;
  const power = 10 ** Math.floor(Math.log10(most));
  const length = [5, 2, 1].map((factor) => factor * power).find((mm) => mm <= most) ?? power;
  const plain = (value) => Number(value.toPrecision(3)).toString();
  if (length >= 10) return { length, words: `${plain(length / 10)} cm` };
  if (length < 0.1) return { length, words: `${plain(length * 1000)} µm` };
  return { length, words: `${plain(length)} mm` };
}
