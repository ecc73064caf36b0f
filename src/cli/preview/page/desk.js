// The desk around the picture: the edges that are dragged, the tabs of the panel, dark and light. What the artist has chosen
// is kept by the browser.

import { $ } from "./dom.js";

/** What is kept is a comfort only: a browser may refuse. */
function keep(name, value) {
  try {
    if (value === null) localStorage.removeItem(`kake-${name}`);
    else localStorage.setItem(`kake-${name}`, value);
  } catch {
    // Then it is chosen again next time.
  }
}

function kept(name) {
  try {
    return localStorage.getItem(`kake-${name}`);
  } catch {
    return null;
  }
}

/**
 * Makes an edge draggable, by keys too. The size in pixels goes into a property of the desk's style; `sign` says whether
 * dragging to the right or down makes more (1) or less (-1) of it.
 */
export function splitter(edge, { property, least, most, start, sign }) {
  const desk = $("desk");
  const isAcross = edge.classList.contains("across");
  let size = start;
  const take = (next) => {
    size = Math.round(Math.min(most(), Math.max(least, next)));
    desk.style.setProperty(property, `${size}px`);
    edge.setAttribute("aria-valuenow", size);
    edge.setAttribute("aria-valuemin", least);
    edge.setAttribute("aria-valuemax", Math.round(most()));
  };
  take(Number(kept(property)) || start);
  edge.addEventListener("pointerdown", (event) => {
    edge.setPointerCapture(event.pointerId);
    const at = (where) => (isAcross ? where.clientY : where.clientX);
    const [from, before] = [at(event), size];
    const move = (next) => take(before + sign * (at(next) - from));
    edge.addEventListener("pointermove", move);
    const end = () => {
      edge.removeEventListener("pointermove", move);
      keep(property, size);
    };
    edge.addEventListener("pointerup", end, { once: true });
    edge.addEventListener("pointercancel", end, { once: true });
  });
  edge.addEventListener("keydown", (event) => {
    const ways = isAcross ? { ArrowUp: -1, ArrowDown: 1 } : { ArrowLeft: -1, ArrowRight: 1 };
    const way = ways[event.key];
    if (!way) return;
    event.preventDefault();
    take(size + sign * way * 24);
    keep(property, size);
  });
  window.addEventListener("resize", () => take(size));
}

/** Tabs that arrows go through; `onSelect(id)` is told. */
export function tabs(list, onSelect) {
  const buttons = [...list.querySelectorAll('[role="tab"]')];
  const select = (chosen) => {
    for (const button of buttons) {
      const isChosen = button === chosen;
      button.setAttribute("aria-selected", String(isChosen));
      button.tabIndex = isChosen ? 0 : -1;
      $(button.getAttribute("aria-controls")).hidden = !isChosen;
    }
    onSelect(chosen.id);
  };
  list.addEventListener("click", (event) => {
    const button = event.target.closest('[role="tab"]');
    if (button) select(button);
  });
  list.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const at = buttons.indexOf(document.activeElement);
    const next = buttons[(at + way + buttons.length) % buttons.length];
    select(next);
    next.focus();
  });
  return (id) => select($(id));
}

const THEME = "theme";

/** Takes the theme that was chosen before; without one the system's holds. */
export function startTheme() {
  const chosen = kept(THEME);
  if (chosen === "dark" || chosen === "light") document.documentElement.dataset.theme = chosen;
}

/** Changes between dark and light. */
export function switchTheme() {
  const root = document.documentElement;
  const isDark = (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  root.dataset.theme = isDark ? "light" : "dark";
  keep(THEME, root.dataset.theme);
}
