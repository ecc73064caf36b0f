// Words about what goes on: the server's state, the banner over an old picture, figures of the drawing, and short messages.

import { $, count, icon, make, plural } from "./dom.js";

/** How long a message stays, in milliseconds. */
const STAY = 6000;

/** What the server is doing; `kind` is one of `ready`, `busy`, `faulty`, `stopped`, `gone`. */
export function state(kind, words, title = "") {
  const element = $("state");
  if (element.dataset.kind === kind && element.textContent === words) return;
  element.dataset.kind = kind;
  element.textContent = words;
  element.title = title;
}

/** Says over the picture why it is old, or nothing. */
export function banner(words, lead = "") {
  const element = $("banner");
  const isShown = words !== null;
  if (isShown && element.textContent !== lead + words) element.replaceChildren(make("strong", {}, lead), words);
  element.hidden = !isShown;
  $("viewport").toggleAttribute("data-old", isShown);
}

/** A message that goes by itself; the same words said again take the place of those before. */
export function toast(words, kind = "done") {
  for (const other of [...$("toasts").children]) if (other.dataset.words === words) other.remove();
  const close = make("button", { className: "tool small", "aria-label": "Close", onclick: () => element.remove() }, icon("close"));
  const element = make("div", { className: "toast", "data-kind": kind, "data-words": words }, make("span", {}, words), close);
  $("toasts").append(element);
  while ($("toasts").children.length > 4) $("toasts").firstElementChild.remove();
  setTimeout(() => element.remove(), STAY);
}

/** The figures of a drawing. */
export function figures({ tiles, marks, page, bytes, ms, steps }) {
  const size = (value) => (value >= 1e6 ? `${(value / 1e6).toFixed(1)} MB` : `${Math.max(1, Math.round(value / 1e3))} kB`);
  const words = [plural(tiles, "tile"), plural(marks, "mark"), `${page.width} × ${page.height} mm`];
  if (bytes) words.push(size(bytes));
  words.push(`${ms.toFixed(ms < 10 ? 1 : 0)} ms`);
  const element = $("figures");
  element.textContent = words.join(" · ");
  const spent = steps.map(([name, time]) => `${name}: ${time} ms`);
  element.title = ["Tiles: all that were placed, whether anything of them is drawn or not", ...spent].join("\n");
}

/** How many problems there are. */
export function problems(diagnostics) {
  const errors = diagnostics.filter(({ severity }) => severity === "error").length;
  const element = $("problems");
  element.hidden = diagnostics.length === 0;
  element.textContent = count(diagnostics.length);
  element.title = plural(diagnostics.length, "problem");
  element.dataset.severity = errors > 0 ? "error" : "warning";
}
