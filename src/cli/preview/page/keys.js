// Keys for everything, and the page that lists them. A key alone does nothing while text is typed.

import { isTyping, make } from "./dom.js";

/** What else keys do, where something has the focus. */
const ELSEWHERE = [
  ["The picture", [["Arrows", "pan; with Shift farther"], ["Wheel, pinch", "zoom at the pointer"], ["Drag", "pan"]]],
  ["Sliders and number boxes", [["Arrows", "a step; in boxes with Shift ten steps"], ["Page Up, Page Down", "ten steps"], ["Home, End", "a slider's ends"]]],
  ["Variations", [["Arrows", "from picture to picture"], ["Enter", "choose"], ["Esc", "close"]]],
];

/**
 * Listens for keys. `commands` are groups `[title, [[keys, words, run]]]`, keys as `"Ctrl+Z"`, `"F"` or `"?"`; Ctrl is the
 * command key on a Mac.
 */
export function listen(commands) {
  const table = new Map();
  for (const [, rows] of commands) for (const [keys, , run] of rows) for (const key of keys) table.set(key, run);
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.isComposing || event.altKey || document.querySelector("dialog[open]")) return;
    const name = nameOf(event);
    const isPlain = !name.startsWith("Ctrl+");
    if (isTyping(event.target) && (isPlain || isEdited(event.target))) return;
    const run = table.get(name);
    if (!run || (isPlain && event.repeat && !["+", "-", "[", "]"].includes(name))) return;
    event.preventDefault();
    run();
  });
}

/** A key with what is held. Shift counts for letters only: signs are what they are on the keyboard at hand. */
function nameOf({ key, ctrlKey, metaKey, shiftKey }) {
  const isLetter = /^\p{L}$/u.test(key);
  const shift = shiftKey && isLetter ? "Shift+" : "";
  return (ctrlKey || metaKey ? "Ctrl+" : "") + shift + (isLetter ? key.toUpperCase() : key);
}

/** Whether a box holds text that is not given yet: undoing is then the box's own. */
const isEdited = (target) => "edited" in target.dataset;

/** Fills the page of keys. */
export function list(dialog, commands) {
  const groups = [
    ...commands.map(([title, rows]) => [title, rows.map(([keys, words]) => [keys.filter((key) => key !== "=" && key !== "Ctrl+Y"), words])]),
    ...ELSEWHERE.map(([title, rows]) => [title, rows.map(([keys, words]) => [[keys], words])]),
  ];
  const section = ([title, rows]) =>
    make(
      "section",
      {},
      make("h3", {}, title),
      make(
        "dl",
        {},
        ...rows.flatMap(([keys, words]) => [make("dt", {}, ...keys.flatMap((key, i) => [i > 0 ? " " : "", make("kbd", {}, key)])), make("dd", {}, words)]),
      ),
    );
  const close = make("button", { className: "tool", onclick: () => dialog.close() }, "Close");
  dialog.replaceChildren(
    make("div", { className: "help-head" }, make("h2", { id: "help-title" }, "Keys"), close),
    make("div", { className: "help-body" }, ...groups.map(section)),
  );
  dialog.addEventListener("click", (event) => {
    if (event.target === dialog) dialog.close();
  });
}
