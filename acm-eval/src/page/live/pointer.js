/* What a mouse, a pen or a finger asks of a figure. */

Figure.prototype.at = function (event) {
  const seen = this.svg.getBoundingClientRect(), box = this.svg.viewBox.baseVal;
  return [((event.clientX - seen.left) * box.width) / seen.width, ((event.clientY - seen.top) * box.height) / seen.height];
};

Figure.prototype.listen = function () {
  const { svg: target } = this;
  target.addEventListener("pointermove", event => { this.load(); this.move(event); });
  target.addEventListener("pointerdown", event => { this.load(); this.press(event); });
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
