// A wish as the fragment of an address and back: `#set.tile=4mm&seed=7&overlays=angles&only=sky&hidden=frame`.

const SET = "set.";

/** The fragment for a wish, empty for none. */
export function toFragment({ sets, seed, overlays, only, hidden }) {
  const fields = new URLSearchParams();
  for (const [name, text] of Object.entries(sets)) fields.append(SET + name, text);
  if (seed !== null) fields.append("seed", seed);
  if (overlays.length > 0) fields.append("overlays", overlays.join(","));
  if (only !== null) fields.append("only", only);
  for (const key of hidden) fields.append("hidden", key);
  const text = fields.toString();
  return text === "" ? "" : `#${text}`;
}

/** The wish that a fragment holds; what is not understood is left out. */
export function fromFragment(fragment, known) {
  const wish = { sets: {}, seed: null, overlays: [], only: null, hidden: [] };
  for (const [name, text] of new URLSearchParams(fragment.replace(/^#/, ""))) {
    if (name.startsWith(SET) && name.length > SET.length) wish.sets[name.slice(SET.length)] = text;
    else if (name === "seed") wish.seed = toSeed(text);
    else if (name === "overlays") wish.overlays = text.split(",").filter((overlay) => known.includes(overlay));
    else if (name === "only") wish.only = text;
    else if (name === "hidden") wish.hidden.push(text);
  }
  return wish;
}

/** The greatest seed. */
const MOST = 2n ** 64n - 1n;

/** A seed from a text, or null where it is none: a number, or text where numbers of this language are not exact. */
export function toSeed(text) {
  const plain = String(text).trim();
  if (!/^\d{1,20}$/.test(plain)) return null;
  const seed = BigInt(plain);
  if (seed > MOST) return null;
  return seed <= BigInt(Number.MAX_SAFE_INTEGER) ? Number(seed) : String(seed);
}

/** The seed so many further on, round at the ends. */
export function seedAfter(seed, many) {
  return toSeed(BigInt.asUintN(64, BigInt(seed) + BigInt(many)));
}
