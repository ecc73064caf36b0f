// Values as texts of the language: numbers with units, steps for sliders, colours.

/** What a unit is in the first unit of its kind. */
const UNITS = {
  mm: ["mm", 1],
  cm: ["mm", 10],
  in: ["mm", 25.4],
  pt: ["mm", 25.4 / 72],
  deg: ["deg", 1],
  rad: ["deg", 180 / Math.PI],
  turn: ["deg", 360],
  "%": ["%", 1],
};

const QUANTITY = /^\s*([-+]?(?:\d+(?:\.\d+)?|\.\d+)(?:e[-+]?\d+)?)\s*([a-z%]*)\s*$/i;

/** A number with its unit (empty for none), or null where the text is more than that. */
export function quantity(text) {
  const found = QUANTITY.exec(text);
  return found ? { value: Number(found[1]), unit: found[2] } : null;
}

/** The number that a text has in this unit, or null where it cannot be told. */
export function inUnit(text, unit) {
  const read = quantity(text);
  if (!read) return null;
  if (read.unit === unit || read.unit === "") return read.value;
  const [from, to] = [UNITS[read.unit], UNITS[unit]];
  if (!from || !to || from[0] !== to[0]) return null;
  return (read.value * from[1]) / to[1];
}

/** The step of a slider: about 200 over the range, one of 1, 2 or 5 times a power of ten. */
export function niceStep(from, to) {
  const rough = (to - from) / 200;
  if (!(rough > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(rough));
  const times = [1, 2, 5, 10].find((factor) => rough <= factor * power * 1.0001);
  return times * power;
}

/** How many digits after the point a step needs. */
const digits = (step) => Math.max(0, -Math.floor(Math.log10(step) + 1e-9));

/** A number to a step's digits, without idle noughts. */
export function toStep(value, step) {
  const text = value.toFixed(Math.min(digits(step), 12));
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

/** `count` values evenly from one end to the other. */
export function between(from, to, count) {
  // A few digits are enough to tell them apart.
  const step = niceStep(from, from + (to - from) * 8);
  return Array.from({ length: count }, (_, i) => toStep(from + ((to - from) * i) / (count - 1), step));
}

const COLOUR = /^#([0-9a-f]{3,4}|[0-9a-f]{6}|[0-9a-f]{8})$/i;

/** A colour's red, green and blue as `#rrggbb` and its alpha from 0 to 1, or null where it is none. */
export function colour(text) {
  const plain = text.trim();
  let hex = COLOUR.exec(plain)?.[1].toLowerCase();
  if (!hex) return named(plain);
  if (hex.length < 6) hex = [...hex].map((digit) => digit + digit).join("");
  const alpha = hex.length === 8 ? parseInt(hex.slice(6), 16) / 255 : 1;
  return { rgb: `#${hex.slice(0, 6)}`, alpha };
}

/** A colour of CSS by its name: the browser knows them. */
function named(text) {
  if (!/^[a-z]+$/i.test(text) || !CSS.supports("color", text)) return null;
  const context = document.createElement("canvas").getContext("2d");
  context.fillStyle = text;
  return context.fillStyle.startsWith("#") ? colour(context.fillStyle) : null;
}

/** A colour as text; alpha is left out where it is 1. */
export function colourText(rgb, alpha) {
  if (alpha >= 1) return rgb;
  const byte = Math.round(Math.max(0, alpha) * 255);
  return rgb + byte.toString(16).padStart(2, "0");
}
