const token = document.querySelector('meta[name="kake-token"]').content;

async function draw() {
  const answer = await fetch("/api/draw", {
    method: "POST",
    headers: { "X-Kake-Token": token, "Content-Type": "application/json" },
    body: JSON.stringify({ sets: {}, seed: null, overlays: [], only: null }),
  });
  const drawn = await answer.json();
  if (drawn.id) document.querySelector("#picture").src = `/api/picture/${drawn.id}.svg`;
  const said = drawn.error ?? drawn.diagnostics.map((found) => `${found.line}: ${found.message}`).join("\n");
  document.querySelector("#said").textContent = said;
}

new EventSource("/api/events").addEventListener("changed", draw);
draw();
