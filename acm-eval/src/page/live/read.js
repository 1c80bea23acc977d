/* What a panel has at a place. */

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
