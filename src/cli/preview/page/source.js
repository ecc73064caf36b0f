// The source with what is wrong in it: lines with numbers, spans underlined, and below each its message, hint, notes and
// code. Faults of values that no file holds stand above.

import { icon, make, plural } from "./dom.js";
import { colourLines } from "./syntax.js";

export class SourcePane {
  #element;
  #tabs = make("div", { className: "files", role: "tablist", "aria-label": "Files" });
  #loose = make("div", { className: "loose" });
  #code = make("div", { className: "code", tabIndex: 0, role: "region", "aria-label": "Source text" });
  #next = make("button", { className: "tool", title: "The next problem (N)", onclick: () => this.next() }, "Next problem");
  #sources = [];
  #diagnostics = [];
  #file = null;
  #at = -1;
  #drawn = "";

  constructor(element, onClose) {
    this.#element = element;
    const close = make("button", { className: "tool small", "aria-label": "Close the source", title: "Close (S)", onclick: onClose }, icon("close"));
    element.replaceChildren(make("div", { className: "drawer-head" }, this.#tabs, this.#next, close), this.#loose, this.#code);
  }

  /** Takes sources and diagnostics of an answer. */
  put({ sources, diagnostics }) {
    this.#sources = sources;
    this.#diagnostics = diagnostics;
    this.#at = -1;
    const names = sources.map(({ name }) => name);
    const faulty = diagnostics.find(({ severity, file }) => severity === "error" && names.includes(file));
    if (!names.includes(this.#file) || (faulty && !this.#here().length)) this.#file = faulty?.file ?? names[0] ?? null;
    this.#next.hidden = !diagnostics.some(({ file }) => names.includes(file));
    this.#loose.replaceChildren(...diagnostics.filter(({ file }) => !names.includes(file)).map((fault) => card(fault, this)));
    this.refresh();
  }

  /** Brings the next problem into sight. */
  next() {
    const names = this.#sources.map(({ name }) => name);
    const known = this.#diagnostics.filter(({ file }) => names.includes(file));
    if (known.length === 0) return;
    this.#at = (this.#at + 1) % known.length;
    this.go(known[this.#at].file, known[this.#at].line);
  }

  /** Brings a place into sight. */
  go(file, line) {
    if (!this.#sources.some(({ name }) => name === file)) return;
    this.#file = file;
    this.refresh();
    const row = this.#code.querySelector(`[data-line="${Number(line)}"]`);
    row?.scrollIntoView({ block: "center" });
  }

  /** Draws the file anew where it is another; nothing is done while the pane is closed. */
  refresh() {
    if (this.#element.hidden) return;
    const signature = JSON.stringify([this.#file, this.#sources, this.#diagnostics]);
    if (signature === this.#drawn) return;
    this.#drawn = signature;
    this.#tabs.replaceChildren(...this.#sources.map(({ name }) => this.#tab(name)));
    const source = this.#sources.find(({ name }) => name === this.#file);
    const top = this.#code.scrollTop;
    this.#code.replaceChildren(...(source ? this.#rows(source) : []));
    this.#code.scrollTop = top;
  }

  #here() {
    return this.#diagnostics.filter(({ file }) => file === this.#file);
  }

  #tab(name) {
    const faults = this.#diagnostics.filter(({ file }) => file === name).length;
    const select = () => {
      this.#file = name;
      this.refresh();
      this.#tabs.querySelector('[aria-selected="true"]')?.focus();
    };
    return make(
      "button",
      { role: "tab", className: "file", "aria-selected": String(name === this.#file), onclick: select },
      name,
      faults > 0 ? make("span", { className: "count", title: plural(faults, "problem") }, String(faults)) : null,
    );
  }

  #rows({ name, text }) {
    const faults = this.#here();
    return colourLines(name, text).flatMap((pieces, i) => {
      const line = i + 1;
      const marks = faults.filter((fault) => fault.line <= line && line <= Math.max(fault.line, fault.end_line));
      const code = make("code", {}, ...spans(pieces, marks, line));
      const row = make("div", { className: "line", "data-line": line }, make("span", { className: "number" }, String(line)), code);
      row.toggleAttribute("data-faulty", marks.length > 0);
      const cards = faults.filter((fault) => fault.line === line).map((fault) => card(fault, this));
      return [row, ...cards];
    });
  }
}

/** The pieces of a line as elements, cut where a problem's span starts and ends. */
function spans(pieces, marks, line) {
  const length = pieces.reduce((sum, [, text]) => sum + [...text].length, 0);
  const ranges = marks.map((mark) => {
    const start = mark.line === line ? mark.column - 1 : 0;
    const end = mark.end_line === line ? Math.max(mark.end_column - 1, start + 1) : Math.max(length, start + 1);
    return { start, end, severity: mark.severity };
  });
  const cuts = new Set(ranges.flatMap(({ start, end }) => [start, end]));
  const elements = [];
  let at = 0;
  const piece = (kind, characters) => {
    const isIn = ranges.filter(({ start, end }) => start <= at && at < end);
    const severity = isIn.some((range) => range.severity === "error") ? "error" : isIn[0]?.severity;
    const element = make("span", { className: kind ? `s-${kind}` : "" }, characters.join(""));
    if (severity) element.dataset.mark = severity;
    if (kind === "colour") element.style.setProperty("--colour", characters.join(""));
    elements.push(element);
    at += characters.length;
  };
  for (const [kind, text] of pieces) {
    let rest = [];
    for (const character of text) {
      if (rest.length > 0 && cuts.has(at + rest.length)) {
        piece(kind, rest);
        rest = [];
      }
      rest.push(character);
    }
    if (rest.length > 0) piece(kind, rest);
  }
  // A span may lie behind a line's last character.
  const behind = ranges.find(({ start }) => start >= length);
  if (behind) {
    const element = make("span", {}, " ");
    element.dataset.mark = behind.severity;
    elements.push(element);
  }
  return elements;
}

/** What is wrong, in words. */
function card(fault, pane) {
  const notes = (fault.notes ?? []).map(({ file, line, message }) => {
    const go = file ? make("button", { className: "quiet", onclick: () => pane.go(file, line) }, `${file}:${line}`) : null;
    return make("p", { className: "note" }, go, ` ${message}`);
  });
  return make(
    "div",
    { className: "problem", "data-severity": fault.severity, "data-code": fault.code },
    make("p", { className: "message" }, make("strong", {}, fault.severity), ` ${fault.message}`, make("code", { className: "fault-code" }, fault.code)),
    fault.label ? make("p", { className: "label" }, fault.label) : null,
    fault.hint ? make("p", { className: "hint" }, fault.hint) : null,
    ...notes,
  );
}
