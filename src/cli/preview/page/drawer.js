// Draws what is wished: the newest wish wins. One drawing is under way at a time, from the request to the picture on the
// screen, and of the wishes that come meanwhile only the last is kept.

import { draw } from "./api.js";

/**
 * How long a drawing may go on when a newer wish waits, in milliseconds from its start. Quick scenes so follow the hand
 * picture by picture, and slow ones are given up for the newest.
 */
const PATIENCE = 120;

/** How soon words say that a drawing is under way, in milliseconds: quick ones need none. */
const SOON = 150;

export class Drawer {
  #show;
  #on;
  #waiting = null;
  #running = null;
  #job = 0;

  /**
   * `show(answer, hidden, signal)` brings a picture to the screen. `on` is told: `busy` while it takes long, `answer` of each
   * answer whose picture is shown or that has none, `stopped`, `failed` with an error, `idle` when nothing is left to do.
   */
  constructor(show, on) {
    this.#show = show;
    this.#on = on;
  }

  /** The number of the job that is under way. */
  get job() {
    return this.#job;
  }

  get isIdle() {
    return this.#running === null;
  }

  /** Draws this as soon as it can be. */
  ask(wish) {
    this.#waiting = { wish, since: performance.now() };
    if (this.#running === null) {
      this.#next();
      return;
    }
    const left = this.#running.start + PATIENCE - performance.now();
    clearTimeout(this.#running.timer);
    if (left <= 0) this.#running.abort.abort();
    else this.#running.timer = setTimeout(() => this.#running?.abort.abort(), left);
  }

  /** Ends what is under way. */
  stop() {
    this.#waiting = null;
    this.#running?.abort.abort();
  }

  async #next() {
    const { wish, since } = this.#waiting;
    this.#waiting = null;
    const abort = new AbortController();
    this.#job += 1;
    this.#running = { start: performance.now(), abort, timer: 0 };
    const soon = setTimeout(() => this.#on.busy(), SOON);
    try {
      const answer = await draw(wish, abort.signal, this.#job);
      if (answer.ok) {
        await this.#show(answer, wish.hidden, abort.signal);
        // Figures for whoever measures how long it takes from a wish to its picture.
        performance.measure("kake-picture", { start: since, end: performance.now() });
      }
      this.#on.answer(answer, wish);
    } catch (error) {
      if (error.name !== "AbortError") this.#on.failed(error, wish);
      else if (this.#waiting === null) this.#on.stopped();
    } finally {
      clearTimeout(soon);
      clearTimeout(this.#running.timer);
      this.#running = null;
    }
    if (this.#waiting) this.#next();
    else this.#on.idle();
  }
}
