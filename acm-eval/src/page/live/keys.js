/* The keyboard: reading, zoom, other panels. */

Figure.prototype.key = function (event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  this.load();
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
