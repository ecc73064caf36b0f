// Colours for source text: each line as pieces with a class. What it does not know stays plain; nothing depends on it.

const KEYWORDS = new Set(
  ("edition import canvas seed let param field region tone fn paint with as outline layer ink for in if else then match and or " +
    "not true false experiment pen").split(" "),
);

const KAKE = [
  ["doc", /\/\/\/.*/y],
  ["comment", /\/\/.*/y],
  ["string", /"(?:[^"\\]|\\.)*"?/y],
  ["colour", /#[0-9a-fA-F]{3,8}\b/y],
  ["number", /\d+(?:\.\d+)?(?:e[-+]?\d+)?(?:mm|cm|in|pt|px|deg|rad|turn|%)?(?![\p{L}\p{N}_])/uy],
  ["word", /[\p{L}_][\p{L}\p{N}_]*/uy],
];

const TOML = [
  ["comment", /#.*/y],
  ["head", /^\s*\[\[?[^\]]*\]\]?/y],
  ["string", /"(?:[^"\\]|\\.)*"?|'[^']*'?/y],
  ["number", /\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\p{L}\p{N}_])/uy],
  ["word", /[\p{L}_][\p{L}\p{N}_-]*/uy],
];

/** The lines of a source, each a list of `[class, text]`; the class of plain text is empty. */
export function colourLines(name, text) {
  const rules = name.endsWith(".toml") ? TOML : KAKE;
  let isInComment = false;
  return text.split(/\r\n|\n/).map((line) => {
    const pieces = [];
    let at = 0;
    const push = (kind, end) => {
      if (end <= at) return;
      const last = pieces.at(-1);
      if (last && last[0] === kind && kind === "") last[1] += line.slice(at, end);
      else pieces.push([kind, line.slice(at, end)]);
      at = end;
    };
    while (at < line.length) {
      if (rules === KAKE && (isInComment || line.startsWith("/*", at))) {
        const end = line.indexOf("*/", isInComment ? at : at + 2);
        isInComment = end < 0;
        push("comment", isInComment ? line.length : end + 2);
        continue;
      }
      const found = first(rules, line, at);
      if (found) push(kindOf(found, line, rules), at + found.text.length);
      else push("", at + 1);
    }
    return pieces;
  });
}

function first(rules, line, at) {
  for (const [kind, rule] of rules) {
    rule.lastIndex = at;
    const match = rule.exec(line);
    if (match && match[0].length > 0) return { kind, text: match[0], end: at + match[0].length };
  }
  return null;
}

/** A word's class, from itself and from what stands behind it. */
function kindOf({ kind, text, end }, line, rules) {
  if (kind !== "word") return kind;
  const behind = line.slice(end).trimStart();
  if (rules === TOML) return behind.startsWith("=") ? "label" : ["true", "false"].includes(text) ? "keyword" : "";
  if (behind.startsWith(":")) return "label";
  if (KEYWORDS.has(text)) return "keyword";
  return behind.startsWith("(") ? "call" : "";
}
