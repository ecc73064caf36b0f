// The page of a preview: puts its parts together. A wish changes, the drawer asks the server for the picture, and every part
// shows what the answer says of it.

import * as api from "./api.js";
import { copy } from "./clipboard.js";
import * as desk from "./desk.js";
import { $, make, plural } from "./dom.js";
import { Drawer } from "./drawer.js";
import * as keys from "./keys.js";
import { Layers, Only, OVERLAYS, Overlays, hiddenNumbers } from "./layers.js";
import { fromFragment, seedAfter, toFragment, toSeed } from "./link.js";
import { Measures } from "./measures.js";
import { Params } from "./params.js";
import { Picture } from "./picture.js";
import { SourcePane } from "./source.js";
import { banner, figures, problems, state, toast } from "./status.js";
import { Variations } from "./variations.js";
import { REAL, View, ruleOf } from "./view.js";
import { Wish } from "./wish.js";

desk.startTheme();
document.title = `${api.scene} · kake preview`;
$("scene-name").textContent = api.scene;

const wish = new Wish();
const view = new View($("viewport"), moved, pointed, covered);
const picture = new Picture($("sheet"), view, redraw);
const params = new Params($("params"), wish);
const overlays = new Overlays($("overlays"), wish);
const layers = new Layers($("layers"), $("layers-all"), wish);
const only = new Only($("only-row"), $("only"), wish);
const measures = new Measures($("pane-measure"), enlarge);
const source = new SourcePane($("drawer"), () => showSource(false));
const variations = new Variations($("variations"), wish, () => params.list, (isOpen) => {
  $("vary").setAttribute("aria-expanded", String(isOpen));
  if (!isOpen) $("viewport").focus({ preventScroll: true });
});
const drawer = new Drawer(show, { busy, answer, stopped, failed, idle });

/** The last answer of the server, good or not. */
let last = null;

/** Whether the server has gone away since it was last heard of. */
let isGone = false;

/** Whether the source was opened for a fault and not by hand. */
let isSourceOpened = false;

// ------------------------------------------------------------------------------------------------------ the drawing

async function show(drawn, hidden, signal) {
  await picture.show(drawn, hiddenNumbers(drawn.layers, hidden), signal);
  const isFirst = document.body.dataset.state !== "drawn";
  $("viewport").dataset.state = "drawn";
  document.body.dataset.state = "drawn";
  // The scale bar has come.
  if (isFirst) view.refit();
}

function busy() {
  state("busy", "Drawing …");
}

function stopped() {
  state("stopped", "Stopped");
}

function idle() {
  if (picture.shown && last?.ok) reshow();
}

/** What the file of a value is called that no file holds. */
const VALUE = "--set ";

function answer(said, asked) {
  const wasGood = last?.ok ?? true;
  last = said;
  const own = said.sources.map(({ name }) => name);
  const errors = said.diagnostics.filter(({ severity }) => severity === "error");
  params.put(said, asked);
  layers.put(said);
  only.put(said, wish.now);
  problems(said.diagnostics);
  source.put(said);
  seedBox();
  commandOf(said);
  variations.from(said.seed);
  if (said.ok) {
    state("ready", "Ready", said.steps.map(([name, ms]) => `${name} ${ms} ms`).join("\n"));
    banner(null);
    figures(said);
    measures.put(said);
    if (isSourceOpened) showSource(false);
  } else {
    state("faulty", errors.length === 1 ? "1 mistake" : plural(errors.length, "mistake"));
    const first = errors[0] ?? said.diagnostics[0];
    const place = own.includes(first?.file) ? `${first.file}, line ${first.line}: ` : "";
    const value = first?.file?.startsWith(VALUE) ? `${first.file.slice(VALUE.length)}: ` : "";
    banner(`${place}${value}${first?.message ?? "the scene cannot be drawn"}`, picture.shown ? "Last good picture." : "");
    $("empty").textContent = "There is no picture yet: the scene has a mistake.";
    if (wasGood && errors.some(({ file }) => own.includes(file)) && $("drawer").hidden) showSource(true, true);
    if (!$("drawer").hidden) source.next();
  }
  forgetUnknown(said, asked);
  buttons();
}

/** Shows the command line of the picture that is shown: while a value is wrong that of the last good one. */
function commandOf({ ok, command }) {
  if (ok) $("command-text").textContent = command;
  const what = ok ? "this very picture" : "the last good picture, which is shown";
  $("command").title = `Copy the command line that makes ${what} (C)`;
  $("command").toggleAttribute("data-old", !ok);
}

/** Values for parameters that the scene does not have, from an old link or an edited scene, are let go. */
function forgetUnknown({ params: known, diagnostics, ok }, { sets }) {
  const unknown = Object.keys(sets).filter((name) => {
    const isBlamed = diagnostics.some(({ file, message }) => file === `--set ${name}` || message.includes(`\`${name}\``));
    return name in wish.now.sets && !known.some((param) => param.name === name) && (ok || isBlamed);
  });
  if (unknown.length === 0) return;
  const kept = Object.fromEntries(Object.entries(wish.now.sets).filter(([name]) => !unknown.includes(name)));
  toast(`The scene has no parameter ${unknown.join(", ")}`, "warning");
  wish.begin({ sets: kept });
}

function failed(error) {
  if (error.gone) {
    gone();
    return;
  }
  // Another server has the port now: its page knows its token.
  if (error.status === 403) {
    reload();
    return;
  }
  state("faulty", "No picture");
  banner(error.message);
  if (!error.status) redraw();
}

let lastRedraw = 0;

/** Draws again what the server has forgotten, not more often than it can help. */
function redraw() {
  const now = performance.now();
  if (now - lastRedraw < 3000) return;
  lastRedraw = now;
  drawer.ask(wish.now);
}

function reload() {
  const key = "kake-reloaded";
  const before = Number(sessionStorage.getItem(key) ?? 0);
  if (Date.now() - before < 10_000) {
    banner("This page is of another preview: open it anew from the terminal.");
    return;
  }
  sessionStorage.setItem(key, Date.now());
  location.reload();
}

let showing = null;

/** Shows the same drawing with other layers. */
async function reshow() {
  const { answer: drawn, hide } = picture.shown;
  const next = hiddenNumbers(drawn.layers, wish.now.hidden);
  if (next.join() === hide.join()) return;
  showing?.abort();
  showing = new AbortController();
  const { signal } = showing;
  try {
    await picture.show(drawn, next, signal);
  } catch (error) {
    if (error.name !== "AbortError") redraw();
  }
}

wish.addEventListener("change", ({ detail: { isOfDrawing, isOfPicture } }) => {
  const { now } = wish;
  params.refresh();
  overlays.refresh(now);
  layers.refresh(now);
  seedFault(false);
  seedBox();
  buttons();
  keepLink();
  if (isOfDrawing) {
    showing?.abort();
    measures.cancel();
    drawer.ask(now);
  } else if (isOfPicture && picture.shown && drawer.isIdle) {
    reshow();
  }
});

// -------------------------------------------------------------------------------------------------------- the server

function gone() {
  isGone = true;
  state("gone", "No server");
  banner("The server does not answer. Is `kake preview` still running? The page goes on by itself when it is back.");
}

api.listen({
  changed: () => {
    drawer.ask(wish.now);
    variations.refresh();
  },
  step: ({ job, step, paint, ms }) => {
    if (job !== drawer.job || drawer.isIdle) return;
    const what = step === "" ? "Waiting" : `Drawing: ${step}${paint ? ` of ${paint}` : ""}`;
    state("busy", `${what}, ${(ms / 1000).toFixed(1)} s`);
  },
  there: () => {
    if (!isGone) return;
    isGone = false;
    drawer.ask(wish.now);
  },
  gone,
});

// ---------------------------------------------------------------------------------------------------------- the view

function moved({ scale, size }) {
  picture.place();
  $("zoom-text").textContent = `${Math.round((scale / REAL) * 100)} %`;
  const { length, words } = ruleOf(scale, Math.min(140, size.width / 4));
  $("rule-bar").style.width = `${length * scale}px`;
  $("rule-text").textContent = words;
}

/** How much of the picture's window lies under the banner above, and under the scale bar and the buttons below. */
function covered() {
  const [banner, rule] = [$("banner"), $("rule")];
  const gap = 10;
  const bottom = rule.offsetHeight > 0 ? $("stage").clientHeight - rule.offsetTop + gap : 0;
  return { top: banner.hidden ? 0 : banner.offsetTop + banner.offsetHeight + gap, bottom };
}

// A banner that comes, goes or says more takes another part of the window.
new ResizeObserver(() => view.refit()).observe($("banner"));

function pointed(point) {
  $("place").textContent = point ? `${point.x.toFixed(2)}, ${point.y.toFixed(2)} mm` : "";
}

/** Shows a chart large. */
function enlarge(address, title) {
  const dialog = $("large");
  const close = make("button", { className: "tool", onclick: () => dialog.close() }, "Close");
  dialog.replaceChildren(make("img", { src: address, alt: title }), close);
  dialog.showModal();
}

// ---------------------------------------------------------------------------------------------------------- the desk

const selectTab = desk.tabs($("panel").querySelector('[role="tablist"]'), () => measures.refresh());

desk.splitter($("split-panel"), { property: "--panel-width", least: 260, most: () => innerWidth * 0.6, start: 340, sign: -1 });
desk.splitter($("split-drawer"), { property: "--drawer-height", least: 90, most: () => innerHeight * 0.7, start: 250, sign: -1 });

function showSource(isShown, isForFault = false) {
  isSourceOpened = isShown && isForFault;
  $("drawer").hidden = !isShown;
  $("split-drawer").hidden = !isShown;
  $("source-button").setAttribute("aria-expanded", String(isShown));
  if (isShown) source.refresh();
}

function toggleSource() {
  const isShown = $("drawer").hidden;
  showSource(isShown);
  if (isShown) $("drawer").querySelector(".code").focus();
}

function seedBox() {
  const box = $("seed");
  const isTyped = document.activeElement === box && "edited" in box.dataset;
  if (!isTyped && $("seed-fault").hidden) box.value = wish.now.seed ?? last?.seed ?? "";
  $("seed-reset").hidden = wish.now.seed === null;
}

function buttons() {
  $("undo").disabled = !wish.canUndo;
  $("redo").disabled = !wish.canRedo;
  $("reset-all").disabled = Object.keys(wish.now.sets).length === 0;
  for (const button of document.querySelectorAll("#vary, [data-save]")) button.disabled = !picture.shown;
  $("write").disabled = !wish.isChanged || !last?.ok || !last.writable;
}

// ----------------------------------------------------------------------------------------------------------- actions

const seedNow = () => wish.now.seed ?? last?.seed ?? 0;

function takeSeed() {
  const box = $("seed");
  delete box.dataset.edited;
  const seed = toSeed(box.value);
  const isFaulty = box.value.trim() !== "" && seed === null;
  seedFault(isFaulty);
  if (isFaulty) return;
  if (box.value.trim() === "") wish.seed(null);
  else if (seed !== seedNow()) wish.seed(seed);
  seedBox();
}

/** Says under the seed's box what is wrong with the text in it, which stays. */
function seedFault(isFaulty) {
  const fault = $("seed-fault");
  fault.hidden = !isFaulty;
  fault.textContent = isFaulty ? "A seed is a whole number from 0 to 18446744073709551615" : "";
  $("seed").setAttribute("aria-invalid", String(isFaulty));
}

const rollSeed = () => wish.change({ seed: Math.floor(Math.random() * 100_000) });

const resetAll = () => wish.change({ sets: {} });

async function save(kind) {
  const button = document.querySelector(`[data-save="${kind}"]`);
  if (button.ariaBusy === "true") return;
  button.ariaBusy = "true";
  try {
    const { path } = await api.save(wish.now, kind);
    const hidden = wish.now.hidden.length > 0 ? " (with the hidden layers)" : "";
    toast(`Saved ${path}${hidden}`);
  } catch (error) {
    toast(`Not saved: ${error.message}`, "error");
  } finally {
    button.ariaBusy = "false";
  }
}

async function write() {
  if ($("write").disabled) return;
  const { sets, seed } = wish.now;
  const here = Object.fromEntries(Object.entries(sets).filter(([name]) => params.list.find((param) => param.name === name)?.here));
  const away = Object.keys(sets).filter((name) => !(name in here));
  try {
    const { written } = await api.write({ sets: here, seed }, last.revision);
    params.settle(here);
    wish.begin({ sets: Object.fromEntries(away.map((name) => [name, sets[name]])), seed: null });
    toast(`Written into ${api.scene}: ${written.join(", ") || "nothing"}`);
    if (away.length > 0) toast(`Declared in another file and left: ${away.join(", ")}`, "warning");
  } catch (error) {
    toast(`Not written: ${error.message}`, "error");
  }
}

const said = (isDone, words) => toast(isDone ? words : "The browser does not let the page copy", isDone ? "done" : "error");

async function copyCommand() {
  if (!picture.shown) return;
  const of = last?.ok === false ? " of the last good picture" : "";
  said(await copy($("command-text").textContent), `The command line${of} is copied`);
}

const share = async () => said(await copy(location.origin + location.pathname + toFragment(wish.now)), "The link is copied");

let linkTimer = 0;

/** Keeps the wish in the page's own address, so that it outlives a reload. Browsers do not like this done often. */
function keepLink() {
  clearTimeout(linkTimer);
  linkTimer = setTimeout(() => history.replaceState(null, "", location.pathname + toFragment(wish.now)), 300);
}

const known = OVERLAYS.map(([name]) => name);

window.addEventListener("hashchange", () => {
  if (location.hash !== toFragment(wish.now)) wish.begin(fromFragment(location.hash, known));
});

const on = (id, run) => $(id).addEventListener("click", run);
on("undo", () => wish.undo());
on("redo", () => wish.redo());
on("vary", () => variations.toggle());
on("write", write);
on("share", share);
on("theme", desk.switchTheme);
on("help-button", help);
on("reset-all", resetAll);
on("seed-reset", () => wish.seed(null));
on("seed-less", () => wish.seed(seedAfter(seedNow(), -1)));
on("seed-more", () => wish.seed(seedAfter(seedNow(), 1)));
on("seed-dice", rollSeed);
on("zoom-in", () => view.zoomIn());
on("zoom-out", () => view.zoomOut());
on("zoom-real", () => view.real());
on("zoom-fit", () => view.fit());
on("source-button", toggleSource);
on("command", copyCommand);
for (const button of document.querySelectorAll("[data-save]")) button.addEventListener("click", () => save(button.dataset.save));
$("seed").addEventListener("input", (event) => (event.target.dataset.edited = ""));
$("seed").addEventListener("change", takeSeed);
$("seed").addEventListener("keydown", (event) => {
  const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
  if (event.key === "Enter") takeSeed();
  if (event.key === "Escape") {
    delete event.target.dataset.edited;
    seedFault(false);
    seedBox();
  }
  if (!way) return;
  event.preventDefault();
  delete event.target.dataset.edited;
  seedFault(false);
  wish.seed(seedAfter(seedNow(), way));
});

const commands = [
  ["Values", [
    [["Ctrl+Z"], "undo", () => wish.undo()],
    [["Ctrl+Shift+Z", "Ctrl+Y"], "redo", () => wish.redo()],
    [["Shift+R"], "reset all parameters", resetAll],
    [["D"], "another seed by chance", rollSeed],
    [["[", "]"], "one seed less, one more", null],
    [["V"], "variations", () => variations.toggle()],
  ]],
  ["View", [
    [["F"], "fit the page", () => view.fit()],
    [["1"], "as large as on paper", () => view.real()],
    [["+", "="], "zoom in", () => view.zoomIn()],
    [["-"], "zoom out", () => view.zoomOut()],
    [["O"], "overlays: the angles", () => $("overlays").querySelector('[data-overlay="angles"]').click()],
    [["T"], "dark or light", desk.switchTheme],
  ]],
  ["Panels", [
    [["P"], "parameters", () => selectTab("tab-adjust")],
    [["M"], "measures", () => selectTab("tab-measure")],
    [["S"], "source", toggleSource],
    [["N"], "next problem", () => source.next()],
    [["?"], "this list", help],
  ]],
  ["Keep", [
    [["Ctrl+S"], "save as SVG", () => save("svg")],
    [["C"], "copy the command line", copyCommand],
    [["L"], "copy a link", share],
    [["W"], "write the values into the scene", write],
  ]],
];
keys.list($("help"), commands);
keys.listen([
  ...commands.map(([title, rows]) => [title, rows.filter(([, , run]) => run)]),
  ["", [[["["], "", () => $("seed-less").click()], [["]"], "", () => $("seed-more").click()]]],
]);

function help() {
  $("help").showModal();
}

wish.begin(fromFragment(location.hash, known));
if (drawer.isIdle) drawer.ask(wish.now);
