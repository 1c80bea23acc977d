/* The page answers: values under the cursor, zoom, one cursor over all panels of a trial, sorted tables, downloads.
   Figures stand without it. It fetches nothing; the numbers lie beside each figure as JSON (plotted.rs). */
(() => {
  "use strict";
  const all = (selector, root = document) => [...root.querySelectorAll(selector)];

  function html(tag, attributes = {}, text = "") {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.textContent = text;
    return made;
  }

  const space = (document.querySelector("svg") || document.body).namespaceURI;

  function svg(parent, tag, attributes = {}, text = "") {
    const made = document.createElementNS(space, tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    if (text) made.textContent = text;
    return parent.appendChild(made);
  }

  function button(parent, text, label, action) {
    const made = html("button", { type: "button", "aria-label": label }, text);
    made.addEventListener("click", action);
    return parent.appendChild(made);
  }

  /* Four significant digits, a true minus. */
  function shown(value, unit = "") {
    const size = Math.abs(value);
    const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(3) : String(+value.toPrecision(4));
    return text.replace(/-/g, "\u2212") + (unit ? "\u00a0" + unit : "");
  }

  /* "time [s]" → ["time", "s"]. */
  function named(label) {
    const parts = /^(.*?)\s*\[(.*)\]$/.exec(label);
    return parts ? [parts[1], parts[2]] : [label, ""];
  }

  function save(name, text) {
    const address = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
    const link = html("a", { href: address, download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  }

  const quoted = text => (/[",\n]/.test(text) ? '"' + text.replace(/"/g, '""') + '"' : text);

  /* ---- Tables ---- */

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

  /* ---- Figures ---- */

  let figures = [];
  let loaded = false;
  let hinted = false;

  function load() {
    if (loaded) return;
    loaded = true;
    figures.forEach(figure => figure.load());
  }

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

  Figure.prototype.load = function () {
    const read = JSON.parse(this.data.textContent);
    this.panels = read.panels.map(panel => new Panel(this, panel));
  };

  Figure.prototype.tools = function () {
    const row = html("p", { class: "tools" });
    const about = this.box.querySelector("h3") ? this.box.querySelector("h3").textContent : this.name;
    const act = work => () => { load(); work(); };
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

  Figure.prototype.at = function (event) {
    const seen = this.svg.getBoundingClientRect(), box = this.svg.viewBox.baseVal;
    return [((event.clientX - seen.left) * box.width) / seen.width, ((event.clientY - seen.top) * box.height) / seen.height];
  };

  Figure.prototype.listen = function () {
    const { svg: target } = this;
    target.addEventListener("pointermove", event => { load(); this.move(event); });
    target.addEventListener("pointerdown", event => { load(); this.press(event); });
    target.addEventListener("pointerup", event => this.release(event));
    target.addEventListener("pointerleave", event => { if (event.pointerType === "mouse" && !this.drag) clear(); });
    target.addEventListener("pointercancel", () => { this.endDrag(); clear(); });
    target.addEventListener("dblclick", event => { event.preventDefault(); this.reset(); });
    this.card.addEventListener("keydown", event => { if (event.target === this.card) this.key(event); });
    this.card.addEventListener("blur", clear);
  };

  Figure.prototype.under = function ([x, y]) {
    return this.panels.find(panel => panel.holds(x, y));
  };

  Figure.prototype.move = function (event) {
    const place = this.at(event);
    if (this.drag) return this.drag.panel.select(this.drag.from, place);
    const panel = this.under(place);
    if (!panel) return clear();
    this.active = this.panels.indexOf(panel);
    point(panel, panel.back(place));
  };

  Figure.prototype.press = function (event) {
    const place = this.at(event), panel = this.under(place);
    if (!panel) return;
    if (event.pointerType === "touch") return point(panel, panel.back(place));
    if (event.button !== 0) return;
    event.preventDefault();
    this.card.focus({ preventScroll: true });
    this.drag = { panel, from: place };
    try { this.svg.setPointerCapture(event.pointerId); } catch { /* a pointer that scripts made up */ }
  };

  Figure.prototype.release = function (event) {
    if (!this.drag) return;
    const { panel, from } = this.drag, to = this.at(event);
    this.endDrag();
    const [dx, dy] = [Math.abs(to[0] - from[0]), Math.abs(to[1] - from[1])];
    if (dx < 6 && dy < 6) return;
    const [a, b] = [panel.back(panel.inside(from)), panel.back(panel.inside(to))];
    const order = (p, q) => (p < q ? [p, q] : [q, p]);
    const across = dx < 6 ? panel.view.x : order(a[0], b[0]);
    if (panel.time) this.show(panel, across, null);
    else this.show(panel, across, dy < 6 ? panel.view.y : order(a[1], b[1]));
  };

  Figure.prototype.endDrag = function () {
    if (this.drag) this.drag.panel.select(null);
    this.drag = null;
  };

  /* All panels of the same trial show the same stretch of time. */
  Figure.prototype.show = function (panel, x, y) {
    const alike = panel.time ? companions(panel) : [panel];
    alike.forEach(one => one.zoom(x, one.time ? null : y));
    [...new Set(alike.map(one => one.figure))].forEach(figure => figure.zoomed());
  };

  Figure.prototype.zoomed = function () {
    this.back.disabled = this.panels.every(panel => !panel.live);
  };

  Figure.prototype.zoom = function (factor) {
    const panel = this.panels[this.active];
    if (!panel) return;
    const { x, y } = panel.view, at = panel.pointed || [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
    const around = ([low, high], middle, home) => {
      const a = Math.max(home[0], middle - factor * (middle - low)), b = Math.min(home[1], middle + factor * (high - middle));
      return [a, b];
    };
    const across = around(x, at[0], panel.home.x), up = around(y, at[1], panel.home.y);
    const whole = (now, home) => now[0] <= home[0] && now[1] >= home[1];
    if (whole(across, panel.home.x) && (panel.time || whole(up, panel.home.y))) return this.reset();
    this.show(panel, across, up);
  };

  Figure.prototype.reset = function () {
    const linked = new Set(this.panels.flatMap(panel => (panel.time ? companions(panel) : [panel])));
    linked.forEach(panel => panel.whole());
    [...new Set([...linked].map(panel => panel.figure))].forEach(figure => figure.zoomed());
  };

  Figure.prototype.key = function (event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    load();
    const step = { ArrowLeft: -1, ArrowRight: 1, PageUp: -20, PageDown: 20 }[event.key];
    const turn = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (step !== undefined) this.step(event.shiftKey ? 10 * step : step);
    else if (turn !== undefined) this.turn(turn);
    else if (event.key === "+" || event.key === "=") this.zoom(0.5);
    else if (event.key === "-") this.zoom(2);
    else if (event.key === "0") this.reset();
    else if (event.key === "Escape") { clear(); this.reset(); }
    else return;
    event.preventDefault();
  };

  Figure.prototype.turn = function (by) {
    this.active = Math.min(this.panels.length - 1, Math.max(0, this.active + by));
    const panel = this.panels[this.active];
    point(panel, (cursor && panel.time && cursor.panel.time && cursor.at) || panel.middle());
    this.keepSeen();
  };

  /* To the next sample of the first series, or to the next dot from left to right. */
  Figure.prototype.step = function (by) {
    const panel = this.panels[this.active];
    const own = cursor && cursor.panel === panel;
    const steps = panel.steps(), now = own ? panel.nearestStep(steps, cursor.at) : -1;
    const next = own ? now + by : panel.nearestStep(steps, panel.middle());
    const chosen = steps[Math.min(steps.length - 1, Math.max(0, next))];
    if (chosen) point(panel, chosen);
    this.keepSeen();
  };

  Figure.prototype.keepSeen = function () {
    if (!cursor) return;
    const seen = this.svg.getBoundingClientRect(), panel = cursor.panel;
    const x = (panel.forth(cursor.at)[0] * seen.width) / this.svg.viewBox.baseVal.width;
    const { scrollLeft, clientWidth } = this.card;
    if (x < scrollLeft + 40 || x > scrollLeft + clientWidth - 40) this.card.scrollLeft = x - clientWidth / 2;
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

  /* ---- Panels ---- */

  let count = 0;

  function Panel(figure, data) {
    Object.assign(this, data);
    this.figure = figure;
    this.home = { x: [data.x.from, data.x.to], y: [data.y.from, data.y.to] };
    this.view = this.home;
    this.live = null;
    this.layer = svg(figure.svg, "g", { class: "cursor", "pointer-events": "none" });
    this.id = "live-" + count++;
  }

  Panel.prototype.holds = function (x, y) {
    const [left, top, width, height] = this.area;
    return x >= left - 4 && x <= left + width + 4 && y >= top - 4 && y <= top + height + 4;
  };

  Panel.prototype.inside = function ([x, y]) {
    const [left, top, width, height] = this.area;
    return [Math.min(left + width, Math.max(left, x)), Math.min(top + height, Math.max(top, y))];
  };

  /* From px to numbers, and from numbers to px. */
  Panel.prototype.back = function ([px, py]) {
    const [left, top, width, height] = this.area, { x, y } = this.view;
    return [x[0] + ((px - left) / width) * (x[1] - x[0]), y[1] - ((py - top) / height) * (y[1] - y[0])];
  };

  Panel.prototype.forth = function ([vx, vy]) {
    const [left, top, width, height] = this.area, { x, y } = this.view;
    return [left + ((vx - x[0]) / (x[1] - x[0])) * width, top + ((y[1] - vy) / (y[1] - y[0])) * height];
  };

  Panel.prototype.middle = function () {
    const { x, y } = this.view;
    return [(x[0] + x[1]) / 2, (y[0] + y[1]) / 2];
  };

  /* Lines are read at the nearest abscissa, dots at the nearest place. */
  Panel.prototype.nearest = function (series, at) {
    const [width, height] = [this.view.x[1] - this.view.x[0], this.view.y[1] - this.view.y[0]];
    let best = null, least = Infinity;
    for (let k = 0; k < series.x.length; k++) {
      if (series.x[k] === null) continue;
      const dx = Math.abs(series.x[k] - at[0]) / width;
      if (dx > least) continue;
      const far = series.mark === "dot" && this.dotted ? Math.hypot(dx, (series.y[k] - at[1]) / height) : dx;
      if (far < least) [best, least] = [k, far];
    }
    return best === null || (!this.dotted && least > Math.max(0.015, spacing(series) / width)) ? null : { series, x: series.x[best], y: series.y[best], far: least };
  };

  /* Three quarters of the median distance of two samples, within which a line is read. */
  function spacing(series) {
    if (series.spacing === undefined) {
      const steps = [];
      series.x.forEach((value, k) => { if (k && value !== null && series.x[k - 1] !== null) steps.push(Math.abs(value - series.x[k - 1])); });
      series.spacing = 0.75 * (steps.sort((a, b) => a - b)[steps.length >> 1] || 0);
    }
    return series.spacing;
  }

  Panel.prototype.steps = function () {
    if (!this.ordered) {
      const main = this.series.find(series => !this.dotted || series.mark === "dot") || this.series[0];
      const points = main.x.map((x, k) => [x, main.y[k]]).filter(([x]) => x !== null);
      this.ordered = points.sort((a, b) => a[0] - b[0]);
    }
    const [low, high] = this.view.x;
    return this.ordered.filter(([x]) => x >= low && x <= high);
  };

  Panel.prototype.nearestStep = function (steps, at) {
    let best = 0, least = Infinity;
    steps.forEach(([x, y], k) => {
      const far = Math.abs(x - at[0]) / (this.view.x[1] - this.view.x[0]) + (this.dotted ? Math.abs(y - at[1]) / (this.view.y[1] - this.view.y[0]) : 0);
      if (far < least) [best, least] = [k, far];
    });
    return best;
  };

  /* What is read at a place: each series where all lie along one axis; the one nearest dot among dots. */
  Panel.prototype.read = function (at) {
    const found = this.series.map(series => this.nearest(series, at)).filter(Boolean);
    if (!this.dotted) return found;
    const dots = found.filter(one => one.series.mark === "dot").sort((a, b) => a.far - b.far);
    return dots.slice(0, 1);
  };

  Panel.prototype.mark = function (at) {
    this.layer.replaceChildren();
    this.pointed = at;
    if (!at) return [];
    const found = this.read(at), [left, top, width, height] = this.area;
    const inside = ([x, y]) => x >= left - 0.5 && x <= left + width + 0.5 && y >= top - 0.5 && y <= top + height + 0.5;
    const [x] = this.forth(found.length ? [found[0].x, at[1]] : at);
    if (!this.dotted && inside([x, top])) svg(this.layer, "line", { x1: x, x2: x, y1: top, y2: top + height, class: "hair" });
    for (const one of found) {
      const [cx, cy] = this.forth([one.x, one.y]);
      if (inside([cx, cy])) svg(this.layer, "circle", { cx, cy, r: 4.5, fill: one.series.colour, class: "spot" });
    }
    return found;
  };

  Panel.prototype.select = function (from, to) {
    if (this.band) this.band.remove();
    this.band = null;
    if (!from) return;
    const [a, b] = [this.inside(from), this.inside(to)], [, top, , height] = this.area;
    const tall = this.time || Math.abs(a[1] - b[1]) < 6;
    const x = Math.min(a[0], b[0]), y = tall ? top : Math.min(a[1], b[1]);
    const size = { width: Math.abs(a[0] - b[0]), height: tall ? height : Math.abs(a[1] - b[1]) };
    this.band = svg(this.figure.svg, "rect", { x, y, ...size, class: "band", "pointer-events": "none" });
  };

  /* Heights that are seen in a stretch. */
  Panel.prototype.heights = function ([low, high]) {
    let [least, most] = [Infinity, -Infinity];
    for (const { x, y } of this.series) {
      x.forEach((value, k) => { if (value !== null && value >= low && value <= high) [least, most] = [Math.min(least, y[k]), Math.max(most, y[k])]; });
    }
    if (least > most) return this.home.y;
    const room = 0.06 * (most - least || Math.abs(most) || 1);
    const floor = this.home.y[0] === 0 && least >= 0 ? 0 : least - room;
    return [floor, most + room];
  };

  Panel.prototype.zoom = function (x, y) {
    const least = 1e-4 * (this.home.x[1] - this.home.x[0]);
    if (x[1] - x[0] < least) return;
    this.view = { x, y: y || this.heights(x) };
    this.draw();
    if (this.pointed) this.mark(this.pointed);
  };

  Panel.prototype.whole = function () {
    this.view = this.home;
    if (this.live) this.live.remove();
    this.live = null;
    (this.hidden || []).forEach(part => part.removeAttribute("visibility"));
    if (this.pointed) this.mark(this.pointed);
  };

  /* Numbers and ticks of the figure as it was drawn, which no longer hold. */
  Panel.prototype.stale = function () {
    const [left, top, width, height] = this.area, box = this.figure.svg.viewBox.baseVal;
    const seen = this.figure.svg.getBoundingClientRect(), k = box.width / seen.width;
    const place = part => {
      const r = part.getBoundingClientRect();
      return { x: (r.left - seen.left) * k, y: (r.top - seen.top) * k, w: r.width * k, h: r.height * k };
    };
    const number = /^[\u2212-]?[\d.,]+(?:e[\u2212-]?\d+)?$/i;
    const texts = all("text", this.figure.svg).filter(text => {
      if (!number.test(text.textContent.trim()) || text.closest(".cursor, .live")) return false;
      const p = place(text), [cx, cy] = [p.x + p.w / 2, p.y + p.h / 2];
      const leftOf = cx < left && cx > left - 60 && cy > top - 9 && cy < top + height + 9;
      const below = cy > top + height && cy < top + height + 26 && cx > left - 9 && cx < left + width + 9;
      return leftOf || below;
    });
    const ticks = all("line", this.figure.svg).filter(line => {
      if (line.closest(".cursor, .live")) return false;
      const p = place(line);
      const below = p.h <= 7 && p.w < 2 && Math.abs(p.y - top - height) < 2 && p.x > left - 2 && p.x < left + width + 2;
      const leftOf = p.w <= 7 && p.h < 2 && Math.abs(p.x + p.w - left) < 2 && p.y > top - 2 && p.y < top + height + 2;
      return below || leftOf;
    });
    return [...texts, ...ticks];
  };

  function ticks([low, high], wanted) {
    const raw = (high - low) / wanted, power = 10 ** Math.floor(Math.log10(raw));
    const step = power * [1, 2, 5, 10].find(factor => raw <= factor * power * (1 + 1e-9));
    const decimals = Math.min(9, Math.max(0, -Math.floor(Math.log10(step))));
    const found = [];
    for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) {
      found.push([k * step, (k * step).toFixed(decimals).replace("-", "\u2212")]);
    }
    return found;
  }

  Panel.prototype.draw = function () {
    if (!this.hidden) this.hidden = this.stale();
    this.hidden.forEach(part => part.setAttribute("visibility", "hidden"));
    if (this.live) this.live.remove();
    const [left, top, width, height] = this.area, { x, y } = this.view;
    this.live = svg(this.figure.svg, "g", { class: "live", "pointer-events": "none" });
    this.figure.svg.insertBefore(this.live, this.layer);
    svg(this.live, "rect", { x: left - 2, y: top - 3, width: width + 6, height: height + 5, class: "paper" });
    const [grid, ink] = [{ stroke: "#dddddd" }, { stroke: "#222222" }];
    for (const [value, label] of ticks(x, Math.max(3, width / 90))) {
      const [at] = this.forth([value, 0]);
      svg(this.live, "line", { x1: at, x2: at, y1: top, y2: top + height, ...grid });
      svg(this.live, "text", { x: at, y: top + height + 18, "font-size": 13, "text-anchor": "middle", fill: "#222222" }, label);
    }
    for (const [value, label] of ticks(y, Math.max(3, height / 50))) {
      const at = this.forth([0, value])[1];
      svg(this.live, "line", { x1: left, x2: left + width, y1: at, y2: at, ...grid });
      svg(this.live, "text", { x: left - 8, y: at + 4.5, "font-size": 13, "text-anchor": "end", fill: "#222222" }, label);
    }
    const inside = svg(this.live, "svg", { x: left, y: top, width, height, viewBox: [left, top, width, height].join(" ") });
    for (const [low, high, colour] of this.bands) {
      const [from, to] = [this.forth([0, high])[1], this.forth([0, low])[1]];
      svg(inside, "rect", { x: left, y: from, width, height: to - from, fill: colour });
    }
    if (y[0] < 0 && y[1] > 0) {
      const zero = this.forth([0, 0])[1];
      svg(inside, "line", { x1: left, x2: left + width, y1: zero, y2: zero, ...ink });
    }
    for (const series of this.series) this.stroke(inside, series);
    svg(this.live, "line", { x1: left, x2: left + width, y1: top + height, y2: top + height, ...ink });
    svg(this.live, "line", { x1: left, x2: left, y1: top, y2: top + height, ...ink });
  };

  Panel.prototype.stroke = function (parent, { x, y, mark, colour, width }) {
    const round = value => Math.round(value * 100) / 100;
    if (mark === "dot") {
      const dots = svg(parent, "g", { fill: colour, "fill-opacity": 0.6 });
      x.forEach((value, k) => {
        const inside = value !== null && value >= this.view.x[0] && value <= this.view.x[1] && y[k] >= this.view.y[0] && y[k] <= this.view.y[1];
        if (inside) { const [cx, cy] = this.forth([value, y[k]]); svg(dots, "circle", { cx: round(cx), cy: round(cy), r: 2.8 }); }
      });
      return;
    }
    let path = "", pen = "M";
    x.forEach((value, k) => {
      if (value === null) { pen = "M"; return; }
      const [px, py] = this.forth([value, y[k]]);
      path += pen + round(px) + " " + round(py);
      pen = "L";
    });
    const dashes = mark === "dashes" ? { "stroke-dasharray": "7 4" } : {};
    svg(parent, "path", { d: path, fill: "none", stroke: colour, "stroke-width": width || 1.6, "stroke-linejoin": "round", ...dashes });
  };

  /* ---- One cursor ---- */

  let cursor = null;

  /* Panels that share the time of a trial: over figures where the trial is named, else within the figure. */
  function companions(panel) {
    if (!panel.time) return [panel];
    const own = other => other.time && (panel.trial ? other.trial === panel.trial && sameData(panel, other) : other.figure === panel.figure && !other.trial);
    return figures.flatMap(figure => figure.panels.filter(own));
  }

  const sameData = (a, b) => a.figure.data.dataset.set === b.figure.data.dataset.set;

  function clear() {
    if (!cursor) return;
    for (const figure of figures) {
      figure.balloon.hidden = true;
      figure.panels.forEach(panel => panel.mark(null));
    }
    cursor = null;
  }

  function point(panel, at) {
    const alike = companions(panel);
    if (cursor) for (const figure of figures) {
      if (figure !== panel.figure) figure.balloon.hidden = true;
      figure.panels.forEach(other => { if (!alike.includes(other)) other.mark(null); });
    }
    cursor = { panel, at };
    const read = alike.map(other => [other, other.mark(at)]);
    tell(panel, at, read.filter(([other]) => other.figure === panel.figure));
  }

  function row(one, unit) {
    const line = html("div");
    const dot = one.series.mark === "dot", swatch = svg(line, "svg", { class: "swatch", viewBox: "0 0 12 12", "aria-hidden": "true" });
    svg(swatch, dot ? "circle" : "rect", { fill: one.series.colour, ...(dot ? { cx: 6, cy: 6, r: 5 } : { y: 4.5, width: 12, height: 3 }) });
    line.append(one.series.name + " ", html("b", {}, shown(one.y, unit)));
    return line;
  }

  const MOST = 12;

  /* What is under the cursor, in words. */
  function tell(panel, at, read) {
    const balloon = panel.figure.balloon, own = read.filter(([other]) => other === panel), rest = read.filter(([other]) => other !== panel);
    const [xName, xUnit] = named(panel.x.label);
    const first = own[0][1][0];
    if (!first) { balloon.hidden = true; return; }
    const lines = [html("div", { class: "where" }, xName + " " + shown(first.x, xUnit))];
    for (const [other, found] of [...own, ...rest].slice(0, 4)) {
      const [yName, yUnit] = named(other.y.label);
      if (other.title && (rest.length || !panel.time)) lines.push(html("div", { class: "what" }, other.title === yName ? yName : [other.title, yName].filter(Boolean).join(": ")));
      else lines.push(html("div", { class: "what" }, yName));
      found.slice(0, MOST).forEach(one => lines.push(row(one, yUnit)));
      if (found.length > MOST) lines.push(html("div", {}, "and " + (found.length - MOST) + " more"));
    }
    balloon.replaceChildren(...lines);
    balloon.hidden = false;
    place(panel, at, balloon);
  }

  function place(panel, at, balloon) {
    const seen = panel.figure.svg.getBoundingClientRect(), k = seen.width / panel.figure.svg.viewBox.baseVal.width;
    const [x, y] = panel.forth(at).map(value => value * k);
    const card = panel.figure.card, offset = panel.figure.sheet.offsetLeft - card.offsetLeft;
    const [from, to] = [card.scrollLeft - offset, card.scrollLeft - offset + card.clientWidth];
    const [wide, high] = [balloon.offsetWidth, balloon.offsetHeight], edge = Math.min(seen.width, to);
    const floor = (panel.area[1] + panel.area[3]) * k - 4;
    const right = x + 14 + wide < edge, left = x - 14 - wide > from;
    const across = right ? x + 14 : left ? x - 14 - wide : Math.max(from, Math.min(x - wide / 2, edge - wide));
    const down = right || left ? Math.min(y + 14, floor - high) : panel.area[1] * k - high + 24;
    balloon.style.left = Math.max(0, across) + "px";
    balloon.style.top = Math.max(0, down) + "px";
  }

  figures = all("script.plotted").map(data => new Figure(data));
  all(".scroll table").forEach(makeSortable);
  tableDownloads();
  document.documentElement.classList.add("answers");
  performance.mark("answers");
})();
