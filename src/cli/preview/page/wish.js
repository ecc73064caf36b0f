// What the artist wishes to see: values of parameters, seed, overlays, one paint alone, hidden layers. Values and seed can be
// undone and redone; a drag of a slider is undone as one.

/** Changes of one control that follow each other within this many milliseconds are one step of undoing. */
const TOGETHER = 900;

/** How many steps can be undone. */
const DEPTH = 200;

export class Wish extends EventTarget {
  #now = { sets: {}, seed: null, overlays: [], only: null, hidden: [] };
  #past = [];
  #future = [];
  #control = null;
  #at = 0;

  get now() {
    return this.#now;
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  /** Whether anything differs from the scene's own values. */
  get isChanged() {
    return Object.keys(this.#now.sets).length > 0 || this.#now.seed !== null;
  }

  /** Sets a parameter to a text, or back to the scene's own value where the text is null. */
  set(name, text) {
    const sets = { ...this.#now.sets };
    if (text === null) delete sets[name];
    else sets[name] = text;
    this.change({ sets }, name);
  }

  /** Takes another seed, or the scene's own where it is null. */
  seed(seed) {
    this.change({ seed }, "seed");
  }

  /** Changes values and seed, so that it can be undone; changes by one control soon after each other are one. */
  change(part, control = null) {
    const next = { ...this.#now, ...part };
    if (same(next, this.#now)) return;
    const now = performance.now();
    const isSame = control !== null && control === this.#control && now - this.#at < TOGETHER;
    if (!isSame) this.#past.push(this.#now);
    if (this.#past.length > DEPTH) this.#past.shift();
    this.#future = [];
    this.#control = control;
    this.#at = now;
    this.#take(next);
  }

  /** Changes what is shown of the drawing; this is no step of undoing. */
  show(part) {
    this.#take({ ...this.#now, ...part });
  }

  undo() {
    this.#step(this.#past, this.#future);
  }

  redo() {
    this.#step(this.#future, this.#past);
  }

  /** Forgets values and steps: the scene's file has taken them over, or a link has brought others. */
  begin(part) {
    this.#past = [];
    this.#future = [];
    this.#control = null;
    this.#take({ ...this.#now, ...part });
  }

  #step(from, to) {
    const next = from.pop();
    if (!next) return;
    to.push(this.#now);
    this.#control = null;
    this.#take({ ...this.#now, sets: next.sets, seed: next.seed });
  }

  #take(next) {
    const before = this.#now;
    this.#now = next;
    const isOfPicture = before.hidden !== next.hidden;
    const isOfDrawing =
      !same(before, next) || before.only !== next.only || before.overlays.join() !== next.overlays.join();
    this.dispatchEvent(new CustomEvent("change", { detail: { isOfDrawing, isOfPicture } }));
  }
}

/** Whether two wishes have the same values and seed. */
function same(a, b) {
  const names = Object.keys(a.sets);
  if (a.seed !== b.seed || names.length !== Object.keys(b.sets).length) return false;
  return names.every((name) => a.sets[name] === b.sets[name]);
}
