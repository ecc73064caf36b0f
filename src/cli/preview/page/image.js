// Images of the server that come whole or not at all.

import { make } from "./dom.js";

/** An image of this address, once it can be painted. */
export async function loadImage(address, signal) {
  const image = make("img", { alt: "", draggable: false, decoding: "async", elementtiming: "picture" });
  const forget = () => image.removeAttribute("src");
  signal?.addEventListener("abort", forget, { once: true });
  image.src = address;
  try {
    await image.decode();
  } catch {
    signal?.throwIfAborted();
    throw new Error("the picture does not come");
  } finally {
    signal?.removeEventListener("abort", forget);
  }
  return image;
}
