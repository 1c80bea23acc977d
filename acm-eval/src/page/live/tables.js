/* Tables: sorted by any column, and saved from the page itself. */

const BLANK = /^[\s\u2013-]*$/;

/* "13.15 ± 0.38" → 13.15; words stay words. */
function sortable(text) {
  const plain = text.replace(/\u2212/g, "-").replace(/[\u202f\u00a0](?=\d)/g, "");
  const number = /^\s*[<>≤≥]?\s*(-?[\d.]+(?:e-?\d+)?)/i.exec(plain);
  return number && !isNaN(+number[1]) ? +number[1] : plain.trim().toLowerCase();
}

function compare(a, b) {
  if (typeof a === typeof b) return typeof a === "number" ? a - b : a.localeCompare(b, undefined, { numeric: true });
  return typeof a === "number" ? -1 : 1;
}

function sort(table, column, order) {
  const body = table.tBodies[0];
  const value = row => (row.cells[column] ? row.cells[column].textContent : "");
  // A sum at the end, set off by a line, and the note on rows that are left out stay where they are.
  const [end] = table.original.slice(-1), stays = row => row.cells.length < 2 || (row === end && row.classList.contains("opens"));
  const rows = table.original.filter(row => !stays(row));
  const last = table.original.filter(stays);
  if (order !== "none") {
    const sign = order === "ascending" ? 1 : -1;
    rows.sort((a, b) => {
      const [x, y] = [value(a), value(b)];
      return BLANK.test(x) - BLANK.test(y) || sign * compare(sortable(x), sortable(y));
    });
  }
  body.append(...rows, ...last);
  table.classList.toggle("sorted", order !== "none");
}

const NEXT = { none: "ascending", ascending: "descending", descending: "none" };

function makeSortable(table) {
  if (!table.tHead || !table.tBodies[0] || table.tBodies[0].rows.length < 2) return;
  table.original = [...table.tBodies[0].rows];
  const heads = [...table.tHead.rows[0].cells];
  heads.forEach((head, column) => {
    head.setAttribute("aria-sort", "none");
    const press = html("button", { type: "button", class: "sort" });
    if (!head.textContent.trim()) press.setAttribute("aria-label", "Sort by column " + (column + 1));
    press.append(...head.childNodes);
    head.append(press);
    press.addEventListener("click", () => {
      const order = NEXT[head.getAttribute("aria-sort")];
      heads.forEach(other => other.setAttribute("aria-sort", other === head ? order : "none"));
      sort(table, column, order);
    });
  });
}

function tableDownloads() {
  for (const data of all("script.csv")) {
    const file = data.dataset.file, name = file.split("/").pop();
    const get = () => save(name, JSON.parse(data.textContent));
    for (const link of all("a").filter(link => link.getAttribute("href") === file)) {
      button(link.parentElement, "Download CSV", "Download " + name, get).className = "tool";
    }
  }
}
