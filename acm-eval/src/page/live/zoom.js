/* Which stretch of its axes a figure shows. */

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
