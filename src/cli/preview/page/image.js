// Images of the server that come whole or not at all.

import { make } from "./dom.js";

/**
 * An image of this address, once it is here. It is decoded when it is painted, in the same frame: `decode()` would take
 * a frame of its own before.
 */
export function loadImage(address, signal) {
  const image = make("img", { alt: "", draggable: false, decoding: "sync", elementtiming: "picture" });
  return new Promise((resolve, reject) => {
    const forget = () => {
      image.removeAttribute("src");
      reject(signal.reason);
    };
    if (signal?.aborted) {
      forget();
      return;
    }
    signal?.addEventListener("abort", forget, { once: true });
    image.addEventListener("load", () => {
      signal?.removeEventListener("abort", forget);
      resolve(image);
    });
    image.addEventListener("error", () => {
      signal?.removeEventListener("abort", forget);
      reject(new Error("the picture does not come"));
    });
    image.src = address;
  });
}
