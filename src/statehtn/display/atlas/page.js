"use strict";
// Sliders choose a plan: by alpha, by a deadline, by wealth. The card of the plan is shown; on the map a line follows.
const data = JSON.parse(document.getElementById("data").textContent);
const cards = [...document.querySelectorAll(".card")];
const map = document.querySelector(".map svg");
const marker = document.createElementNS("http://www.w3.org/2000/svg", "line");
marker.setAttribute("class", "marker");
map.append(marker);

function show(kind, step) {
  const [plan, said, place] = data[kind][step];
  for (const card of cards) card.hidden = plan === null || Number(card.dataset.plan) !== plan;
  document.getElementById(kind + "-said").textContent = said;
  const slider = document.getElementById(kind);
  slider.setAttribute("aria-valuetext", said);
  marker.toggleAttribute("hidden", kind !== "alpha");
  marker.style.display = kind === "alpha" ? "" : "none";
  if (kind === "alpha") {
    const [left, right, top, bottom] = data.frame;
    const x = left + (right - left) * place;
    for (const [name, value] of Object.entries({ x1: x, x2: x, y1: top, y2: bottom })) marker.setAttribute(name, value);
  }
}

for (const slider of document.querySelectorAll(".sliders input")) {
  slider.addEventListener("input", () => show(slider.id, Number(slider.value)));
  slider.addEventListener("focus", () => show(slider.id, Number(slider.value)));
}
for (const link of document.querySelectorAll("[data-show]")) {
  link.addEventListener("click", () => {
    for (const card of cards) card.hidden = card.dataset.plan !== link.dataset.show;
  });
}
for (const kind of ["wealth", "deadline", "alpha"]) {
  const slider = document.getElementById(kind);
  if (slider) show(kind, Number(slider.value));
}
