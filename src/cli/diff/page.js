// Moves the edge between the old picture, on the left of it, and the new one.
const slide = document.getElementById("slide");
const pair = document.querySelector(".pair");

function show() {
  pair.style.setProperty("--at", `${slide.value}%`);
}

function follow(event) {
  const box = pair.getBoundingClientRect();
  slide.value = String(((event.clientX - box.left) / box.width) * 100);
  show();
}

slide.addEventListener("input", show);
pair.addEventListener("pointerdown", (event) => {
  pair.setPointerCapture(event.pointerId);
  follow(event);
});
pair.addEventListener("pointermove", (event) => {
  if (pair.hasPointerCapture(event.pointerId)) follow(event);
});
show();
