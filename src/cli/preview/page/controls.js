// The controls of parameters, one for each kind of value. A control gives an element and `put(text, isFaulty)`, and calls
// `give(text)` when the artist has chosen another text.

import { make } from "./dom.js";
import { colour, colourText, inUnit, niceStep, quantity, toStep } from "./values.js";

/** As many choices, with as many letters in all, stand side by side as buttons; more are a list. */
const FEW = 4;
const SHORT = 26;

/** The control for a parameter. `label` is the id of the element that names it. */
export function control(param, label, give) {
  if (param.choices) return choices(param, label, give);
  switch (param.kind) {
    case "bool":
      return toggle(label, give);
    case "colour":
      return colours(label, give);
    case "number":
    case "length":
    case "angle":
    case "percentage":
      return numbers(param, label, give);
    default:
      return text(label, give);
  }
}

/** A box of text that gives its text on Enter and when it is left, and takes it back on Escape. */
function box(label, give, properties = {}) {
  const input = make("input", {
    className: "box",
    type: "text",
    autocomplete: "off",
    spellcheck: false,
    "aria-labelledby": label,
    ...properties,
  });
  let put = "";
  const commit = () => {
    delete input.dataset.edited;
    if (input.value !== put) give(input.value);
  };
  input.addEventListener("input", () => (input.dataset.edited = ""));
  input.addEventListener("change", commit);
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter") commit();
    if (event.key === "Escape" && "edited" in input.dataset) {
      input.value = put;
      delete input.dataset.edited;
      event.stopPropagation();
    }
  });
  return {
    input,
    put: (text) => {
      // What is being typed is not taken from under the artist's hands.
      if ("edited" in input.dataset && document.activeElement === input) return;
      put = text;
      input.value = text;
    },
  };
}

function text(label, give) {
  const { input, put } = box(label, give, { className: "box wide" });
  return { element: input, put };
}

/** A box for a number with its unit, and where there is a range a slider. */
function numbers({ range, default: own }, label, give) {
  const unit = range?.unit ?? quantity(own)?.unit ?? "";
  const step = range ? niceStep(range.from, range.to) : stepOf(quantity(own)?.value ?? 1);
  // A rounded number must not leave the range that it was in.
  const plainly = (value) => {
    const text = toStep(value, step);
    if (!range) return text;
    return Number(text) >= range.to ? String(range.to) : Number(text) <= range.from ? String(range.from) : text;
  };
  // Artists part a number from its unit or leave the unit out; the language wants `5mm`.
  const joined = (text) => {
    const read = quantity(text);
    return read ? text.replace(/\s+/g, "") + (read.unit === "" ? unit : "") : text;
  };
  let typed = { text: "", given: null };
  const number = box(
    label,
    (text) => {
      typed = { text, given: joined(text) };
      give(typed.given);
    },
    { inputMode: "decimal" },
  );
  const slider = range
    ? make("input", { type: "range", min: range.from, max: range.to, step, "aria-labelledby": label })
    : null;
  const fill = () => {
    const share = (slider.value - range.from) / (range.to - range.from || 1);
    slider.style.setProperty("--share", share);
    slider.setAttribute("aria-valuetext", `${toStep(Number(slider.value), step)} ${unit}`.trim());
  };
  const take = (value) => {
    const plain = plainly(value);
    number.put(plain);
    if (slider) {
      slider.value = plain;
      fill();
    }
    give(plain + unit);
  };
  slider?.addEventListener("input", () => {
    // The last whole step may lie before the end.
    const value = Number(slider.value);
    take(value + step > range.to ? range.to : value);
  });
  number.input.addEventListener("keydown", (event) => {
    const ways = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 };
    const way = ways[event.key];
    const value = way && inUnit(number.input.value, unit);
    if (!way || value === null) return;
    event.preventDefault();
    take(value + way * step * (event.shiftKey ? 10 : 1));
  });
  const sign = make("span", { className: "unit" }, unit);
  const element = make(
    "div",
    { className: slider ? "slide" : "slide alone" },
    slider,
    make("span", { className: "measure" }, number.input, unit ? sign : null),
  );
  const put = (text, isFaulty) => {
    const value = inUnit(text, unit);
    const own = quantity(text)?.unit;
    const isOwnUnit = own === unit || own === "";
    // What is wrong stays as it was typed, so that it can be seen and mended.
    const isTyped = isFaulty && text === typed.given;
    const shown = isTyped ? typed.text : isOwnUnit ? text.trim().slice(0, text.trim().length - own.length).trim() : text;
    number.put(shown);
    // A text with a unit says its own.
    sign.hidden = isTyped ? quantity(shown)?.unit !== "" : !isOwnUnit;
    if (!slider) return;
    slider.disabled = value === null;
    if (value !== null) slider.value = value;
    fill();
  };
  return { element, put };
}

/** The step of a number without a range: about a fiftieth of it. */
const stepOf = (value) => niceStep(0, Math.abs(value) * 4 || 1);

function toggle(label, give) {
  const input = make("input", { type: "checkbox", className: "switch", role: "switch", "aria-labelledby": label });
  input.addEventListener("change", () => give(String(input.checked)));
  return { element: input, put: (text) => (input.checked = text.trim() === "true") };
}

/** A colour's box, its alpha, and its text. */
function colours(label, give) {
  const picker = make("input", { type: "color", "aria-labelledby": label });
  const alpha = make("input", { type: "range", min: 0, max: 1, step: 0.01, "aria-label": "Alpha", title: "Alpha" });
  const hex = box(label, give);
  const shade = () => {
    alpha.style.setProperty("--share", alpha.value);
    alpha.setAttribute("aria-valuetext", `${Math.round(alpha.value * 100)} %`);
  };
  const take = () => {
    shade();
    const text = colourText(picker.value, Number(alpha.value));
    hex.put(text);
    give(text);
  };
  picker.addEventListener("input", take);
  alpha.addEventListener("input", take);
  const put = (text) => {
    hex.put(text);
    const read = colour(text);
    if (!read) return;
    picker.value = read.rgb;
    alpha.value = read.alpha;
    shade();
  };
  return { element: make("div", { className: "colour" }, picker, alpha, hex.input), put };
}

/** One of some texts. */
function choices(param, label, give) {
  const letters = param.choices.join("").length;
  if (param.choices.length <= FEW && letters <= SHORT) return segments(param, label, give);
  const list = make("select", { className: "box wide", "aria-labelledby": label });
  list.append(...param.choices.map((choice) => make("option", { value: choice }, choice)));
  list.addEventListener("change", () => give(list.value));
  return { element: list, put: (text) => (list.value = text) };
}

function segments({ name, choices }, label, give) {
  const radios = choices.map((choice) => make("input", { type: "radio", name: `param-${name}`, value: choice }));
  const labels = radios.map((radio) => make("label", {}, radio, make("span", {}, radio.value)));
  const element = make("div", { className: "segments", role: "radiogroup", "aria-labelledby": label }, ...labels);
  element.addEventListener("change", (event) => give(event.target.value));
  const put = (text) => {
    for (const radio of radios) radio.checked = radio.value === text;
  };
  return { element, put };
}
