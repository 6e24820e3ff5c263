"use strict";
// Sorts and filters the tables of this page. It reads what is shown, keeps nothing, and talks to nobody.
const order = new Intl.Collator("en", { numeric: true });
const amount = (words) => parseFloat(words.replace(/\u2212/g, "-"));
// "muller" finds "Müller".
const plain = (words) => words.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const rows = Array.from(body.rows);
  const heads = Array.from(table.tHead.rows[0].cells);
  heads.forEach((head, column) => {
    if (head.classList.contains("as-is")) return;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const before = head.getAttribute("aria-sort");
      const now = before === "ascending" ? "descending" : before === "descending" ? null : "ascending";
      for (const other of heads) other.removeAttribute("aria-sort");
      if (!now) return body.append(...rows);
      head.setAttribute("aria-sort", now);
      const sign = now === "ascending" ? 1 : -1;
      const numeric = head.classList.contains("num");
      const keys = rows.map((row) => {
        const words = row.cells[column].textContent.trim();
        return { row, key: numeric ? amount(words) : words };
      });
      keys.sort(({ key: a }, { key: b }) => {
        if (!numeric) return sign * order.compare(a, b);
        // What is no number comes last, whichever way.
        if (a !== a || b !== b) return (a !== a) - (b !== b);
        return sign * (a - b);
      });
      body.append(...keys.map(({ row }) => row));
    });
  });
  if (rows.length < 20) continue;
  const line = document.createElement("p");
  const label = document.createElement("label");
  const input = document.createElement("input");
  const count = document.createElement("output");
  input.type = "search";
  const title = table.closest("section").querySelector("h2").textContent;
  input.setAttribute("aria-label", title + ": only rows with");
  line.className = "filter";
  label.append("Only rows with ", input);
  line.append(label, " ", count);
  let words;
  input.addEventListener("input", () => {
    words ??= rows.map((row) => plain(row.textContent));
    const wanted = plain(input.value).split(/\s+/).filter(Boolean);
    let shown = 0;
    rows.forEach((row, i) => {
      row.hidden = !wanted.every((word) => words[i].includes(word));
      shown += row.hidden ? 0 : 1;
    });
    count.textContent = wanted.length ? shown + " of " + rows.length + " rows" : "";
  });
  (table.closest(".scroll") || table).before(line);
}
