// A large drawing as tiles of its raster. Zoomed to another level, the old level stays below until every tile in sight of
// the new one is there.

import { tileAddress } from "./api.js";
import { make } from "./dom.js";
import { loadImage } from "./image.js";

/** A tile's side in its own pixels. */
const SIDE = 512;

/** Level z has 2^z pixels a millimetre. */
const COARSEST = -6;
const FINEST = 10;

/** How many tiles beyond the window's edge are kept. */
const BEYOND = 2;

/** The level with at least as many pixels as the screen has, a little less being taken for enough. */
export function levelFor(scale, ratio) {
  const z = Math.ceil(Math.log2(scale * ratio) - 0.2);
  return Math.min(FINEST, Math.max(COARSEST, z));
}

export class Tiles {
  #answer;
  #hide;
  #levels = new Map();
  #isDropped = false;
  #onLost;

  /** `onLost` is called when the server does not know the drawing any more. */
  constructor(answer, hide, onLost) {
    this.#answer = answer;
    this.#hide = hide;
    this.#onLost = onLost;
    this.element = make("div", { className: "tiles" });
  }

  /** Waits for every tile in sight: until then the picture before stays. */
  async load(sight, signal) {
    const coming = this.#bring(sight);
    const abort = new Promise((_, reject) => {
      signal?.addEventListener("abort", () => reject(signal.reason), { once: true });
    });
    let isComing = true;
    abort.catch(() => isComing && this.drop());
    await Promise.race([coming, abort]);
    // Whoever gives up later gives up something else.
    isComing = false;
    this.#put(sight);
  }

  /** Shows what is in sight now. */
  look(sight) {
    const coming = this.#bring(sight);
    this.#put(sight);
    const level = this.#level(sight);
    coming.then(() => this.#leave(level), () => {});
  }

  drop() {
    this.#isDropped = true;
    for (const level of this.#levels.values()) for (const tile of level.values()) tile.abort.abort();
    this.element.remove();
  }

  #level({ scale }) {
    return levelFor(scale, window.devicePixelRatio || 1);
  }

  /** Asks for the tiles in sight that are not there, the middle first, and ends when all are. */
  #bring(sight) {
    const z = this.#level(sight);
    const level = this.#levels.get(z) ?? new Map();
    this.#levels.set(z, level);
    const side = SIDE / 2 ** z;
    const range = (from, to, end) => {
      const last = Math.max(0, Math.ceil(end / side) - 1);
      return [Math.min(last, Math.max(0, Math.floor(from / side))), Math.min(last, Math.max(0, Math.floor(to / side)))];
    };
    const [left, right] = range(sight.left, sight.right, this.#answer.page.width);
    const [top, bottom] = range(sight.top, sight.bottom, this.#answer.page.height);
    const wanted = [];
    for (let y = top; y <= bottom; y += 1) for (let x = left; x <= right; x += 1) wanted.push([x, y]);
    const far = ([x, y]) => Math.hypot(x - (left + right) / 2, y - (top + bottom) / 2);
    wanted.sort((a, b) => far(a) - far(b));
    this.#forget(level, { left, right, top, bottom });
    this.#giveUp(z);
    return Promise.all(wanted.map(([x, y]) => this.#tile(level, z, x, y)));
  }

  /** One tile, asked for once. */
  #tile(level, z, x, y) {
    const key = `${x},${y}`;
    const known = level.get(key);
    if (known) return known.coming;
    const tile = { z, x, y, image: null, abort: new AbortController() };
    const address = tileAddress(this.#answer.id, z, x, y, this.#hide);
    tile.coming = loadImage(address, tile.abort.signal).then(
      (image) => {
        if (this.#isDropped) return;
        tile.image = image;
        // Finer tiles lie over coarser ones.
        image.style.zIndex = z - COARSEST;
        this.element.append(image);
        if (this.scale) place(tile, this.scale);
      },
      (error) => {
        level.delete(key);
        if (error.name !== "AbortError") this.#onLost();
      },
    );
    level.set(key, tile);
    return tile.coming;
  }

  /** Puts every tile where it belongs. */
  #put({ scale }) {
    this.scale = scale;
    for (const level of this.#levels.values()) {
      for (const tile of level.values()) if (tile.image) place(tile, scale);
    }
  }

  /** Lets tiles of a level go that are far out of sight, asked for or there. */
  #forget(level, { left, right, top, bottom }) {
    for (const [key, tile] of level) {
      const isNear =
        tile.x >= left - BEYOND && tile.x <= right + BEYOND && tile.y >= top - BEYOND && tile.y <= bottom + BEYOND;
      if (isNear) continue;
      tile.abort.abort();
      tile.image?.remove();
      level.delete(key);
    }
  }

  /** Asks no more for tiles of other levels. */
  #giveUp(z) {
    for (const [other, level] of this.#levels) {
      if (other === z) continue;
      for (const [key, tile] of level) {
        if (tile.image) continue;
        tile.abort.abort();
        level.delete(key);
      }
    }
  }

  /** Leaves this level alone, now that it is complete. */
  #leave(z) {
    if (this.#isDropped || !this.scale || this.#level({ scale: this.scale }) !== z) return;
    for (const [other, level] of this.#levels) {
      if (other === z) continue;
      for (const tile of level.values()) {
        tile.abort.abort();
        tile.image?.remove();
      }
      this.#levels.delete(other);
    }
  }
}

/** Tiles end on whole pixels, so that no gap shows between them. Those at the page's edge may be smaller. */
function place({ z, x, y, image }, scale) {
  const pixel = scale / 2 ** z;
  const edges = (at, size) => [at * SIDE, at * SIDE + size].map((edge) => Math.round(edge * pixel));
  const [left, right] = edges(x, image.naturalWidth);
  const [top, bottom] = edges(y, image.naturalHeight);
  image.style.left = `${left}px`;
  image.style.top = `${top}px`;
  image.style.width = `${right - left}px`;
  image.style.height = `${bottom - top}px`;
}
