// Text into the clipboard.

import { make } from "./dom.js";

/** Copies a text; says whether it could be. */
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copyByHand(text);
  }
}

/** The way of browsers that keep the clipboard from pages: a selected text and the command to copy it. */
function copyByHand(text) {
  const focus = document.activeElement;
  const area = make("textarea", { value: text, className: "offstage", "aria-hidden": "true" });
  document.body.append(area);
  area.select();
  const isDone = document.execCommand("copy");
  area.remove();
  focus?.focus();
  return isDone;
}
