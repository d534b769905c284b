"use strict";
// Tables sort by the column whose heading is pressed; pressed again, the other way round.
for (const table of document.querySelectorAll("table")) {
  const headings = [...table.tHead.rows].at(-1).cells;
  const body = table.tBodies[0];
  const rows = [...body.rows];
  if (rows.length < 2) continue;
  [...headings].forEach((heading, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...heading.childNodes);
    heading.append(button);
    button.addEventListener("click", () => {
      const direction = heading.getAttribute("aria-sort") === "ascending" ? -1 : 1;
      for (const other of headings) other.removeAttribute("aria-sort");
      heading.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      const sorted = rows.map((row) => [keyOf(row.cells[column]), row]);
      sorted.sort(([a], [b]) => compare(a, b, direction));
      body.append(...sorted.map(([, row]) => row));
    });
  });
}

// A number where the cell has one, typeset as numbers are here; else its text.
function keyOf(cell) {
  const text = cell.dataset.key ?? cell.textContent.trim();
  const number = Number(text.replaceAll("\u2212", "-").replaceAll("\u202f", ""));
  return text === "" || Number.isNaN(number) ? text : number;
}

// Numbers before text; what is missing last, whichever way.
function compare(a, b, direction) {
  const missing = (key) => key === "" || key === "–";
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  if (typeof a === "number" && typeof b === "number") return direction * (a < b ? -1 : a > b ? 1 : 0);
  if (typeof a !== typeof b) return typeof a === "number" ? -1 : 1;
  return direction * a.localeCompare(b, "en", { numeric: true });
}
