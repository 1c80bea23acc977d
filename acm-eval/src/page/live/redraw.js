/* A panel drawn anew where it shows a part of its axes. */

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
  const step = roundStep((high - low) / wanted);
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
