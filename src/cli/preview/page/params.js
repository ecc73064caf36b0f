// The list of parameters: name, doc comment, control, a way back to the scene's own value, and what is wrong with a value.

import { control } from "./controls.js";
import { icon, make } from "./dom.js";

export class Params {
  #element;
  #wish;
  #rows = new Map();
  #signature = "";
  #own = new Map();

  /** The parameters of the last answer. */
  list = [];

  constructor(element, wish) {
    this.#element = element;
    this.#wish = wish;
  }

  /** Takes what an answer to a wish says of parameters, and what is wrong with values that were given. */
  put({ params, diagnostics, ok }, { sets }) {
    this.list = params;
    // Without a wish a parameter has the scene's value, or the one that the preview was started with.
    for (const { name, value } of ok ? params : []) if (!(name in sets)) this.#own.set(name, value);
    // Controls are made anew only where the parameters are others, so that focus and drags stay.
    const signature = JSON.stringify(params.map(({ value, ...rest }) => rest));
    if (signature !== this.#signature) this.#make(params);
    this.#signature = signature;
    for (const [name, row] of this.#rows) {
      const faults = diagnostics.filter((diagnostic) => diagnostic.file === `--set ${name}`);
      row.faulty = faults.length > 0 ? sets[name] : null;
      row.fault.replaceChildren(...faults.map(faultWords));
      row.fault.hidden = faults.length === 0;
      row.element.toggleAttribute("data-faulty", faults.length > 0);
    }
    this.refresh();
  }

  /** The value that a parameter has when nothing is wished. */
  own({ name, default: text }) {
    return this.#own.get(name) ?? text;
  }

  /** Takes values that the scene's file has taken over. */
  settle(sets) {
    for (const [name, text] of Object.entries(sets)) this.#own.set(name, text);
  }

  /** Shows the values that are wished. */
  refresh() {
    const { sets } = this.#wish.now;
    for (const param of this.list) {
      const row = this.#rows.get(param.name);
      const text = sets[param.name] ?? this.own(param);
      row.control.put(text, text === row.faulty);
      const isOwn = !(param.name in sets);
      row.element.toggleAttribute("data-changed", !isOwn);
      row.reset.disabled = isOwn;
      row.reset.title = `Back to ${this.own(param)}`;
    }
  }

  #make(params) {
    this.#rows.clear();
    const rows = params.map((param) => this.#row(param));
    const none = make("p", { className: "soft" }, "This scene declares no parameters. ", make("code", {}, "param tile = 4mm in 2mm .. 8mm"), " would be a slider.");
    this.#element.replaceChildren(...(rows.length > 0 ? rows : [none]));
  }

  #row(param) {
    const { name, doc } = param;
    const label = `param-${name}`;
    const give = (text) => this.#wish.set(name, text === this.own(param) ? null : text);
    const made = control(param, label, give);
    const reset = make(
      "button",
      {
        className: "tool small reset",
        "aria-label": `Reset ${name}`,
        onclick: () => this.#wish.set(name, null),
      },
      icon("reset"),
    );
    const fault = make("p", { className: "fault", role: "alert", hidden: true });
    const head = make("div", { className: "param-head" }, make("span", { className: "param-name", id: label }, name), reset);
    const element = make(
      "div",
      { className: "param", "data-param": name, "data-kind": param.choices ? "choices" : param.kind },
      head,
      doc ? make("p", { className: "doc" }, doc) : null,
      made.element,
      fault,
    );
    this.#rows.set(name, { element, control: made, reset, fault, faulty: null });
    return element;
  }
}

function faultWords({ message, hint }) {
  return make("span", {}, message, hint ? make("em", {}, hint) : null);
}
