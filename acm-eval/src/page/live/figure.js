/* A figure of lines and dots: its numbers, its buttons, and its file. */

let figures = [];
let hinted = false;

function Figure(data) {
  this.data = data;
  this.box = data.closest("figure");
  this.svg = this.box.querySelector(".sheet svg");
  this.sheet = this.svg.parentElement;
  this.card = this.svg.closest(".card");
  this.name = data.dataset.name;
  this.panels = [];
  this.active = 0;
  this.balloon = html("div", { class: "tip", role: "status", "aria-live": "polite", hidden: "" });
  this.sheet.append(this.balloon);
  this.tools();
  this.listen();
}

/* Numbers are read when they are asked for, or when the figure comes near the window. */
Figure.prototype.load = function () {
  if (this.loaded) return;
  this.loaded = true;
  const read = JSON.parse(this.data.textContent);
  this.panels = read.panels.map(panel => new Panel(this, panel));
  this.panels.forEach(catchUp);
};

Figure.prototype.tools = function () {
  const row = html("p", { class: "tools" });
  const about = this.box.querySelector("h3") ? this.box.querySelector("h3").textContent : this.name;
  const act = work => () => { this.load(); work(); };
  button(row, "+", "Zoom in: " + about, act(() => this.zoom(0.5)));
  button(row, "\u2212", "Zoom out: " + about, act(() => this.zoom(2)));
  this.back = button(row, "Whole figure", "Show the whole figure again: " + about, act(() => this.reset()));
  this.back.disabled = true;
  button(row, "Download data", "Download the data of this figure as CSV: " + about, act(() => this.download()));
  if (!hinted) row.append(html("span", {}, "Point to read, drag to zoom, double-click for the whole. Keys: \u2190 \u2192 read, \u2191 \u2193 other panel, + \u2212 0 zoom."));
  hinted = true;
  this.card.after(row);
  this.card.setAttribute("role", "group");
  this.card.setAttribute("aria-label", about + " Arrow keys read values, plus and minus zoom, 0 shows the whole.");
};

Figure.prototype.download = function () {
  const lines = ["panel,series,x axis,x,y axis,y"];
  for (const { title, x, y, series } of this.panels) {
    for (const line of series) {
      line.x.forEach((value, k) => {
        if (value !== null) lines.push([title, line.name, x.label, value, y.label, line.y[k]].map(v => quoted(String(v))).join(","));
      });
    }
  }
  save(this.name + ".csv", lines.join("\n") + "\n");
};
