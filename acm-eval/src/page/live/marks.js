/* What is drawn over a panel while it is read, and while a stretch is chosen. */

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
