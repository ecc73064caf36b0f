// Small help with the document: finding, making and naming elements. Text goes in as text, never as markup.

/** The element of this id, which the page has. */
export const $ = (id) => document.getElementById(id);

/**
 * Makes an element. Properties are set as such; `class`, `role`, `aria-…`, `data-…` and the like as attributes, `on…` as
 * listeners; children are elements or text.
 */
export function make(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && name !== "list") element[name] = value;
    else element.setAttribute(name === "className" ? "class" : name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

/** Makes an element of an SVG with these attributes. */
export function drawn(tag, attributes = {}, ...children) {
  const element = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  element.append(...children);
  return element;
}

/** One of the page's icons. */
export function icon(name) {
  return drawn("svg", { "aria-hidden": "true" }, drawn("use", { href: `#i-${name}` }));
}

/** Shows another icon in a button. */
export function setIcon(button, name) {
  button.querySelector("use").setAttribute("href", `#i-${name}`);
}

/** Whether keys typed now belong to a box of text. */
export function isTyping(target) {
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  return target instanceof HTMLInputElement && !["range", "checkbox", "radio", "color", "button"].includes(target.type);
}

/** A number for people: so many digits, thousands parted. */
export function figure(value, digits = 3) {
  const least = Number.isInteger(value) ? 1 : digits;
  return new Intl.NumberFormat("en-GB", { minimumSignificantDigits: least, maximumSignificantDigits: digits }).format(value).replace("-", "−");
}

/** A whole number for people. */
export function count(value) {
  return new Intl.NumberFormat("en-GB").format(value);
}

/** A plural in English. */
export const plural = (number, one, many = `${one}s`) => `${count(number)} ${number === 1 ? one : many}`;
