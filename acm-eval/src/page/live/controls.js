/* What turns the arm and moves its time: slider, buttons, keys, and a pointer that drags. */

function labelled(parent, text, control) {
  const label = html("label", {}, text + " ");
  label.append(control);
  parent.append(label);
  return control;
}

function choice(parent, text, options, chosen, action) {
  const made = html("select");
  for (const [value, words] of options) made.append(html("option", { value, ...(value === chosen ? { selected: "" } : {}) }, words));
  made.addEventListener("change", () => action(made.value));
  return labelled(parent, text, made);
}

Space.prototype.build = function () {
  const about = this.box.querySelector("h3").textContent;
  const drawn = this.card.querySelector(".sheet");
  drawn.hidden = true;
  this.stage = html("div", { class: "sheet stage" });
  this.svg = svg(this.stage, "svg", { role: "img", "aria-label": about });
  this.legend = html("ul", { class: "reads" });
  drawn.after(this.stage);
  this.card.after(this.legend);
  this.legend.after(this.timeRow(), this.viewRow(about));
  this.card.setAttribute("role", "group");
  this.card.setAttribute("aria-label", about + " Arrow keys turn the view, plus and minus bring it closer, 0 is the first view.");
  this.card.addEventListener("keydown", event => { if (event.target === this.card) this.key(event); });
  this.listen();
  // Drawn at once at a likely width, without asking for a layout, and again once its width is known.
  new ResizeObserver(([seen]) => requestAnimationFrame(() => this.fit(seen.contentRect.width))).observe(this.stage);
  this.fit(720);
};

Space.prototype.timeRow = function () {
  const row = html("p", { class: "tools time" });
  const names = this.trials.map(trial => [trial.trial, trial.trial]);
  const pick = name => { this.pause(); this.choose(name); this.show(this.worst()); };
  this.picker = names.length > 1 ? choice(row, "Trial", names, this.trial.trial, pick) : row.appendChild(html("span", {}, "Trial " + this.trial.trial));
  this.player = button(row, "Play", "Play or pause the trial", () => this.play());
  this.slider = html("input", { type: "range", min: 0, max: this.trial.time.length - 1, step: 1, value: this.sample });
  this.slider.addEventListener("input", () => { if (this.playing) this.pause(); this.show(+this.slider.value); });
  labelled(row, "Time", this.slider);
  this.clock = html("output");
  row.append(this.clock);
  return row;
};

Space.prototype.viewRow = function (about) {
  const row = html("p", { class: "tools" });
  button(row, "+", "Closer: " + about, () => this.closer(1.5));
  button(row, "\u2212", "Further: " + about, () => this.closer(1 / 1.5));
  for (const [name, view] of Object.entries(VIEWS)) {
    button(row, name, "View: " + name, name === "First view" ? () => this.home() : () => this.look(...view));
  }
  const times = [...new Set([1, 2, 5, 10, 20, 50, this.magnified])].sort((a, b) => a - b).map(factor => [String(factor), "\u00d7" + factor]);
  choice(row, "Residual", times, String(this.magnified), factor => { this.magnified = +factor; this.draw(); });
  button(row, "Download data", "Download the data of this figure as CSV: " + about, () => this.download());
  row.append(html("span", {}, "Drag to turn. Keys: \u2190 \u2192 \u2191 \u2193 turn, + \u2212 closer, 0 first view."));
  return row;
};

Space.prototype.key = function (event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const by = event.shiftKey ? 30 : 5;
  const turn = { ArrowLeft: [-by, 0], ArrowRight: [by, 0], ArrowUp: [0, by], ArrowDown: [0, -by] }[event.key];
  if (turn) this.look(this.azimuth + turn[0], this.elevation + turn[1]);
  else if (event.key === "+" || event.key === "=") this.closer(1.5);
  else if (event.key === "-") this.closer(1 / 1.5);
  else if (event.key === "0" || event.key === "Escape") this.home();
  else return;
  event.preventDefault();
};

/* Half a degree for each px: across it goes round, up and down over. */
Space.prototype.listen = function () {
  let from = null;
  this.svg.addEventListener("pointerdown", event => {
    if (event.button !== 0) return;
    event.preventDefault();
    this.card.focus({ preventScroll: true });
    from = [event.clientX, event.clientY, this.azimuth, this.elevation];
    try { this.svg.setPointerCapture(event.pointerId); } catch { /* a pointer that scripts made up */ }
  });
  this.svg.addEventListener("pointermove", event => {
    if (from) this.look(from[2] - 0.5 * (event.clientX - from[0]), from[3] + 0.5 * (event.clientY - from[1]));
  });
  for (const end of ["pointerup", "pointercancel"]) this.svg.addEventListener(end, () => { from = null; });
};
