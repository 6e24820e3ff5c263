"use strict";
// Sorts and filters the tables of this page. It reads what is shown, keeps nothing, and talks to nobody.
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const rows = Array.from(body.rows);
  const text = (row, column) => row.cells[column].textContent.trim();
  const amount = (words) => parseFloat(words.replace(/\u2212/g, "-"));
  const heads = Array.from(table.tHead.rows[0].cells);
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const before = head.getAttribute("aria-sort");
      const now = before === "ascending" ? "descending" : before === "descending" ? null : "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      const sorted = rows.slice();
      if (now) {
        head.setAttribute("aria-sort", now);
        const numeric = head.classList.contains("num");
        const sign = now === "ascending" ? 1 : -1;
        sorted.sort((one, two) => {
          const [a, b] = [text(one, column), text(two, column)];
          if (!numeric) return sign * a.localeCompare(b, "en", { numeric: true });
          const [x, y] = [amount(a), amount(b)];
          // What is no number comes last, whichever way.
          if (x !== x || y !== y) return (x !== x) - (y !== y);
          return sign * (x - y);
        });
      }
      body.append(...sorted);
    });
  });
  if (rows.length < 8) continue;
  const label = document.createElement("label");
  const input = document.createElement("input");
  const count = document.createElement("output");
  input.type = "search";
  label.className = "filter";
  label.append("Only rows with ", input, " ", count);
  const words = rows.map((row) => row.textContent.toLowerCase());
  input.addEventListener("input", () => {
    const wanted = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    rows.forEach((row, i) => {
      row.hidden = !wanted.every((word) => words[i].includes(word));
      shown += row.hidden ? 0 : 1;
    });
    count.textContent = wanted.length ? shown + " of " + rows.length : "";
  });
  (table.closest(".scroll") || table).before(label);
}
