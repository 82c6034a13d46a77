"use strict";
// Sort a table by a click (or Enter) on a column's head; data-key holds the exact number.
for (const table of document.querySelectorAll("table.sortable")) {
  const heads = [...table.tHead.rows[0].cells];
  const sort = (head, column) => {
    const down = head.getAttribute("aria-sort") === "ascending";
    const rows = [...table.tBodies[0].rows];
    const key = (row) => row.cells[column].dataset.key ?? "";
    const compare = (a, b) => {
      if (a === b) return 0;
      if (a === "" || a === "nan" || a === "–") return 1;
      if (b === "" || b === "nan" || b === "–") return -1;
      const order = isNaN(a) || isNaN(b) ? a.localeCompare(b, "en") : a - b;
      return down ? -order : order;
    };
    heads.forEach((other) => other.removeAttribute("aria-sort"));
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    rows.sort((a, b) => compare(key(a), key(b)));
    table.tBodies[0].append(...rows);
  };
  heads.forEach((head, column) => {
    head.tabIndex = 0;
    head.addEventListener("click", () => sort(head, column));
    head.addEventListener("keydown", (event) => { if (event.key === "Enter") sort(head, column); });
  });
}
// On paper nothing is folded away but long tables of numbers, which would be a hundred pages; a
// reader who wants them there opens them first.
addEventListener("beforeprint", () => {
  for (const details of document.querySelectorAll("details:not(.numbers)")) details.open = true;
});
