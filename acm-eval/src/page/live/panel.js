/* A panel: from px to numbers and back. */

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
