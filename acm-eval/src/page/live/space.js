/* The arm in space: which sample of which trial is shown, seen from where. The drawing without a script makes place. */

let spaces = [];

const VIEWS = { "First view": [-60, 18], Front: [-90, 0], Side: [0, 0], Above: [-90, 90] };

function Space(data) {
  Object.assign(this, JSON.parse(data.textContent));
  this.data = data;
  this.box = data.closest("figure");
  this.card = this.box.querySelector(".card");
  this.trial = this.trials[0];
  this.sample = this.worst();
  this.full = this.trials.some(trial => trial.arm.length > 0);
  this.bound();
  [this.azimuth, this.elevation, this.zoom] = [...VIEWS["First view"], 1];
  this.build();
}

/* A ball around all that is drawn, and the height of its floor. */
Space.prototype.bound = function () {
  const points = this.trials.flatMap(trial => [...trial.arm.flat(), ...trial.tips.flatMap(tip => tip.points)]).map(point => this.turned(point));
  const low = [0, 1, 2].map(k => points.reduce((least, point) => Math.min(least, point[k]), Infinity));
  const high = [0, 1, 2].map(k => points.reduce((most, point) => Math.max(most, point[k]), -Infinity));
  this.middle = low.map((value, k) => (value + high[k]) / 2);
  this.radius = 1.12 * points.reduce((most, point) => Math.max(most, distance(point, this.middle)), 0) || 1;
  this.floor = low[2];
  this.low = low;
  this.high = high;
};

/* The data's axes as right, ahead and up. */
Space.prototype.turned = function (point) {
  return this.frame.map(axis => dot(axis, point));
};

Space.prototype.home = function () {
  this.zoom = 1;
  this.look(...VIEWS["First view"]);
};

Space.prototype.look = function (azimuth, elevation) {
  this.azimuth = ((((azimuth + 180) % 360) + 360) % 360) - 180;
  this.elevation = Math.max(-90, Math.min(90, elevation));
  this.draw();
};

/* px. */
Space.prototype.fit = function (width) {
  if (width <= 0 || width === this.width) return;
  this.width = Math.max(260, width);
  this.draw();
};

Space.prototype.closer = function (factor) {
  this.zoom = Math.max(1, Math.min(12, this.zoom * factor));
  this.draw();
};

Space.prototype.choose = function (name) {
  this.trial = this.trials.find(trial => trial.trial === name) || this.trial;
  this.picker.value = this.trial.trial;
  this.slider.max = this.trial.time.length - 1;
};

/* Shows a sample; the cursors of the other figures follow. */
Space.prototype.show = function (sample) {
  this.sample = Math.max(0, Math.min(this.trial.time.length - 1, sample));
  this.draw();
  follow(this.data.dataset.set, this.trial.trial, this.trial.time[this.sample]);
};

/* Follows the cursor of another figure. */
Space.prototype.follow = function (name, time) {
  if (!this.trials.some(trial => trial.trial === name)) return;
  this.choose(name);
  let best = 0;
  this.trial.time.forEach((at, k) => { if (Math.abs(at - time) < Math.abs(this.trial.time[best] - time)) best = k; });
  this.sample = best;
  this.draw();
};

/* The sample that the nominal model misses most, which is shown first. */
Space.prototype.worst = function () {
  const [measured, nominal] = this.trial.tips.map(tip => tip.points);
  const off = measured.map((point, k) => distance(point, nominal[k]));
  return off.indexOf(Math.max(...off));
};

/* How far an estimate is off the measured tip, at the sample. */
Space.prototype.off = function (tip) {
  return distance(tip.points[this.sample], this.trial.tips[0].points[this.sample]);
};

Space.prototype.play = function () {
  if (this.playing) return this.pause();
  if (this.sample >= this.trial.time.length - 1) this.show(0);
  this.player.textContent = "Pause";
  this.playing = setInterval(() => {
    if (this.sample >= this.trial.time.length - 1) return this.pause();
    this.show(this.sample + 1);
  }, 80);
};

Space.prototype.pause = function () {
  clearInterval(this.playing);
  this.playing = null;
  this.player.textContent = "Play";
};

Space.prototype.download = function () {
  const label = name => quoted(name + " [" + this.unit + "]");
  const lines = ["trial,time [s],what,point," + this.axes.map(label).join(",")];
  for (const trial of this.trials) {
    trial.time.forEach((time, t) => {
      const head = quoted(trial.trial) + "," + time;
      (trial.arm[t] || []).forEach((point, k) => lines.push([head, "nominal arm", k, ...point].join(",")));
      trial.tips.forEach(tip => lines.push([head, quoted(tip.name), "", ...tip.points[t]].join(",")));
    });
  }
  save(this.data.dataset.name + ".csv", lines.join("\n") + "\n");
};
