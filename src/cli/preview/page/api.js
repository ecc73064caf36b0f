// What the page asks of the server. Each function gives a promise, and ends early when its signal says so.

const meta = (name) => document.querySelector(`meta[name="${name}"]`)?.content ?? "";

/** The scene's name as the command line was given it. */
export const scene = meta("kake-scene");

/** An answer that is not what was asked for. `gone` says that there was no answer at all. */
export class ServerError extends Error {
  constructor(message, { status = 0, gone = false } = {}) {
    super(message);
    this.status = status;
    this.gone = gone;
  }
}

async function ask(path, options = {}) {
  let response;
  try {
    response = await fetch(path, { cache: "no-store", ...options });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new ServerError("the server does not answer", { gone: true });
  }
  if (response.ok) return response;
  const said = await response.json().catch(() => ({}));
  throw new ServerError(said.error ?? `the server answered ${response.status}`, { status: response.status });
}

async function post(path, body, signal) {
  const headers = { "content-type": "application/json", "x-kake-token": meta("kake-token") };
  const response = await ask(path, { method: "POST", headers, body: JSON.stringify(body), signal });
  return response.json();
}

/** What of a wish the server has to know. */
const request = ({ sets, seed, overlays, only }) => ({ sets, seed, overlays, only });

/** Draws; the answer holds the drawing's id or what is wrong with the scene. What is told meanwhile names the job. */
export const draw = (wish, signal, job = null) => post("/api/draw", { ...request(wish), job }, signal);

/** Saves the picture as a file and says where. */
export const save = (wish, kind) => post("/api/save", { ...request(wish), kind });

/** Writes defaults and seed into the scene. */
export const write = ({ sets, seed }, revision) => post("/api/params", { sets, seed, revision });

/** What a drawing's patterns measure. */
export const measure = async (id, signal) => (await ask(`/api/picture/${id}/metrics`, { signal })).json();

const hiding = (hide) => (hide.length > 0 ? `?hide=${hide.join(",")}` : "");

/** Where a drawing's SVG is. */
export const svgAddress = (id, hide) => `/api/picture/${id}.svg${hiding(hide)}`;

/** Where a tile of a drawing's raster is. */
export const tileAddress = (id, z, x, y, hide) => `/api/picture/${id}/tile/${z}/${x}/${y}.png${hiding(hide)}`;

/** Where a small picture of a drawing is. */
export const thumbAddress = (id, size) => `/api/picture/${id}/thumb.png?size=${size}`;

/** How long to wait before the server is looked for again, in milliseconds. */
const AGAIN = 1500;

/**
 * Listens to the server for as long as the page is open. `on.changed` is told of changes on disk, `on.step` where a
 * drawing is that takes long, `on.there` each time the server answers, `on.gone` when it does not.
 */
export function listen(on) {
  const events = new EventSource("/api/events");
  events.addEventListener("open", () => on.there());
  events.addEventListener("changed", (event) => on.changed(JSON.parse(event.data)));
  events.addEventListener("step", (event) => on.step(JSON.parse(event.data)));
  events.addEventListener("error", () => {
    on.gone();
    // A browser that has given up is asked to try again.
    if (events.readyState === EventSource.CLOSED) setTimeout(() => listen(on), AGAIN);
  });
}
