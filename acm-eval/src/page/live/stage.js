/* The arm as it is drawn: floor, places of the tip, arm, loads, residual, tips, axes. Colours are those of figures/palette.rs. */

const [INK, GRID, FAINT, ARM, RESIDUAL] = ["#222222", "#dddddd", "#5c5c5c", "#4a6a8a", "#d55e00"];
const LOADS = { weight: FAINT, payload: "#c46d9d", downwash: "#3796cf" };
/* Length of the longest arrow of a load, as a part of the ball. */
const LOAD = 0.42;

const px = value => Math.round(value * 100) / 100;
const path = points => points.map(([x, y], k) => (k ? "L" : "M") + px(x) + " " + px(y)).join("");

Space.prototype.draw = function () {
  const { width } = this, height = Math.round(Math.max(260, Math.min(460, 0.68 * width)));
  this.scale = (this.zoom * Math.min(width, height)) / (2 * this.radius);
  this.centre = [width / 2, height / 2];
  this.svg.setAttribute("viewBox", [0, 0, width, height].join(" "));
  this.svg.replaceChildren();
  this.drawFloor();
  this.drawPlaces();
  this.drawArm();
  this.trial.loads.forEach(load => this.drawLoad(load));
  this.drawResidual();
  this.trial.tips.forEach((tip, k) => this.drawTip(tip, k));
  this.drawAxes(height);
  this.say();
};

/* From the drawing's axes, and from the data's, to px. */
Space.prototype.onPaper = function (point) {
  const [u, v] = projected(plus(point, this.middle, -1), this);
  return [this.centre[0] + this.scale * u, this.centre[1] - this.scale * v];
};

Space.prototype.at = function (point) {
  return this.onPaper(this.turned(point));
};

Space.prototype.stroke = function (points, colour, width, more = {}) {
  const look = { fill: "none", stroke: colour, "stroke-width": width, "stroke-linejoin": "round", "stroke-linecap": "round", ...more };
  return svg(this.svg, "path", { d: path(points), ...look });
};

/* A stroke with a head that is no longer than a third of it. */
Space.prototype.arrow = function (from, to, colour, more = {}) {
  const [dx, dy] = [to[0] - from[0], to[1] - from[1]], length = Math.hypot(dx, dy);
  const head = Math.min(9, length / 3), [ux, uy] = length > 0 ? [dx / length, dy / length] : [0, 0];
  const barb = side => [to[0] - head * (ux - 0.5 * side * uy), to[1] - head * (uy + 0.5 * side * ux)];
  this.stroke([from, to], colour, 2.2, more);
  if (length > 1) this.stroke([barb(1), to, barb(-1)], colour, 2.2);
};

Space.prototype.words = function (text, [x, y], colour, anchor = "start") {
  svg(this.svg, "text", { x: px(x), y: px(y), "font-size": 13, fill: colour, "text-anchor": anchor }, text);
};

/* A grid under everything, with a round distance of its lines. */
Space.prototype.drawFloor = function () {
  const [[x0, y0], [x1, y1]] = [this.low, this.high], step = roundStep((x1 - x0 + y1 - y0) / 10 || this.radius / 3);
  const line = (...ends) => this.stroke(ends.map(([x, y]) => this.onPaper([x, y, this.floor])), GRID, 1);
  line([x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]);
  for (let k = Math.ceil(x0 / step); k * step < x1; k++) line([k * step, y0], [k * step, y1]);
  for (let k = Math.ceil(y0 / step); k * step < y1; k++) line([x0, k * step], [x1, k * step]);
  this.mesh = step;
};

/* Where the measured tip is at the other samples, and the shadows on the floor that tell how deep things lie. */
Space.prototype.drawPlaces = function () {
  const measured = this.trial.tips[0].points, under = point => { const [x, y] = this.turned(point); return this.onPaper([x, y, this.floor]); };
  const dots = measured.map(point => this.at(point)).map(([x, y]) => "M" + px(x) + " " + px(y) + "h0").join("");
  svg(this.svg, "path", { d: dots, fill: "none", stroke: FAINT, "stroke-width": 2.6, "stroke-linecap": "round", "stroke-opacity": 0.4 });
  const shadow = this.trial.arm[this.sample];
  if (shadow) this.stroke(shadow.map(under), FAINT, 3, { "stroke-opacity": 0.25 });
  const tip = measured[this.sample];
  this.stroke([this.at(tip), under(tip)], FAINT, 1, { "stroke-dasharray": "2 4" });
};

Space.prototype.drawArm = function () {
  const arm = this.trial.arm[this.sample];
  if (!arm) return;
  const points = arm.map(point => this.at(point)), [x, y] = points[0];
  this.stroke(points, ARM, 5, { class: "backbone", "data-points": arm.length });
  svg(this.svg, "rect", { x: px(x - 6), y: px(y - 6), width: 12, height: 12, fill: ARM });
};

/* Loads along the arm act at its middle, and the tip's at the tip; without an arm, all at the nominal tip. */
Space.prototype.drawLoad = function (load) {
  const arm = this.trial.arm[this.sample], nominal = this.trial.tips[1].points[this.sample];
  const most = Math.max(...this.trials.flatMap(trial => trial.loads.filter(other => other.name === load.name).flatMap(other => other.size.map(Math.abs))), 0);
  const share = load.size.length ? load.size[this.sample] / (most || 1) : 0.6;
  const places = !arm || load.place === "tip" ? [nominal] : [arm[Math.round((arm.length - 1) * (load.name === "weight" ? 0.6 : 0.3))]];
  for (const place of places) {
    const head = plus(place, load.direction, share * LOAD * this.radius), [from, to] = [this.at(place), this.at(head)];
    this.arrow(from, to, LOADS[load.name] || FAINT, load.size.length ? {} : { "stroke-dasharray": "5 4" });
    // Beside the head, where the arm is not.
    const left = this.at(nominal)[0] > to[0];
    this.words(load.name, [to[0] + (left ? -8 : 8), to[1] + 4], INK, left ? "end" : "start");
  }
};

Space.prototype.drawResidual = function () {
  const [measured, nominal] = this.trial.tips.map(tip => tip.points[this.sample]);
  const head = plus(nominal, plus(measured, nominal, -1), this.magnified);
  this.arrow(this.at(nominal), this.at(head), RESIDUAL, { class: "residual" });
};

Space.prototype.drawTip = function (tip, place) {
  const point = tip.points[this.sample], [cx, cy] = this.at(point).map(px);
  const look = place === 1 ? { fill: "#ffffff", stroke: tip.colour, "stroke-width": 2.5 } : { fill: tip.colour };
  svg(this.svg, "circle", { cx, cy, r: 5.5, class: "place", "data-name": tip.name, "data-point": point.join(" "), ...look });
};

/* The data's axes, in a corner. */
Space.prototype.drawAxes = function (height) {
  const origin = [58, height - 52];
  [0, 1, 2].forEach(k => {
    const unit = [0, 0, 0];
    unit[k] = 34;
    const [u, v] = projected(this.turned(unit), this), end = [origin[0] + u, origin[1] - v];
    this.stroke([origin, end], INK, 1.4);
    const far = Math.hypot(u, v) || 1, room = 1 + 11 / far;
    if (far > 6) this.words(this.axes[k], [origin[0] + u * room, origin[1] - v * room + 4.5], INK, "middle");
  });
};
