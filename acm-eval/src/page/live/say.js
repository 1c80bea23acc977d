/* What is shown of the arm, in words: the legend with its values, the slider's, and the drawing's own. */

Space.prototype.say = function () {
  const { trial, sample } = this, time = trial.time[sample];
  const off = trial.tips.slice(1).map(tip => tip.name + " misses the tip by " + shown(this.off(tip), this.unit));
  this.slider.value = sample;
  this.slider.setAttribute("aria-valuetext", "time " + shown(time, "s") + ", " + off.join(", "));
  this.clock.textContent = shown(time, "s");
  this.svg.setAttribute("aria-label", [this.full ? "The arm" : "The tip", "in trial " + trial.trial + " at " + shown(time, "s") + ":", off.join(", ")].join(" "));
  Object.assign(this.svg.dataset, {
    trial: trial.trial, sample, time, azimuth: this.azimuth, elevation: this.elevation, scale: this.scale, magnified: this.magnified,
  });
  this.legend.replaceChildren(...this.keys());
};

Space.prototype.keys = function () {
  const at = this.trial.tips[0].points[this.sample].map((value, k) => this.axes[k] + " " + shown(value)).join(", ");
  const lines = this.full ? [key({ stroke: ARM, "stroke-width": 4 }, "nominal arm")] : [];
  this.trial.tips.forEach((tip, k) => {
    const words = k ? tip.name + " tip, off by " : "measured tip at ", value = k ? shown(this.off(tip), this.unit) : at + "\u00a0" + this.unit;
    lines.push(key(k === 1 ? { hollow: tip.colour } : { dot: tip.colour }, words, value));
  });
  lines.push(key({ stroke: RESIDUAL, "stroke-width": 2.5 }, "residual, drawn ", "\u00d7" + this.magnified));
  for (const load of this.trial.loads) {
    const look = { stroke: LOADS[load.name] || FAINT, "stroke-width": 2.5, ...(load.size.length ? {} : { "stroke-dasharray": "5 4" }) };
    const value = load.size.length ? shown(load.size[this.sample], load.unit === "1" ? "" : load.unit) : "";
    lines.push(key(look, load.name + (value ? " " : ", its direction alone"), value));
  }
  lines.push(key({ stroke: FAINT, "stroke-width": 3, "stroke-linecap": "round", "stroke-dasharray": "0.1 6" }, "measured tip at other samples"));
  lines.push(key({ stroke: FAINT, "stroke-width": 1 }, "grid on the floor, mesh ", shown(this.mesh, this.unit)));
  return lines;
};

function key(look, words, value = "") {
  const line = html("li"), swatch = svg(line, "svg", { class: "swatch", viewBox: "0 0 24 12", "aria-hidden": "true" });
  if (look.dot) svg(swatch, "circle", { cx: 12, cy: 6, r: 5, fill: look.dot });
  else if (look.hollow) svg(swatch, "circle", { cx: 12, cy: 6, r: 4.5, fill: "#ffffff", stroke: look.hollow, "stroke-width": 2.2 });
  else svg(swatch, "line", { x1: 1, x2: 23, y1: 6, y2: 6, ...look });
  line.append(words);
  if (value) line.append(html("b", {}, value));
  return line;
}
