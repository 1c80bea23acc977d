/* One cursor over all panels of a trial. */

let cursor = null;

/* Panels that share the time of a trial: over figures where the trial is named, else within the figure. */
function companions(panel) {
  if (!panel.time) return [panel];
  const own = other => other.time && (panel.trial ? other.trial === panel.trial && sameData(panel, other) : other.figure === panel.figure && !other.trial);
  return figures.flatMap(figure => figure.panels.filter(own));
}

const sameData = (a, b) => a.figure.data.dataset.set === b.figure.data.dataset.set;

function clear() {
  if (!cursor) return;
  for (const figure of figures) {
    figure.balloon.hidden = true;
    figure.panels.forEach(panel => panel.mark(null));
  }
  cursor = null;
}

function point(panel, at) {
  const alike = companions(panel);
  if (cursor) for (const figure of figures) {
    if (figure !== panel.figure) figure.balloon.hidden = true;
    figure.panels.forEach(other => { if (!alike.includes(other)) other.mark(null); });
  }
  cursor = { panel, at };
  const read = alike.map(other => [other, other.mark(at)]);
  tell(panel, at, read.filter(([other]) => other.figure === panel.figure));
  if (panel.trial) spaces.filter(space => space.data.dataset.set === panel.figure.data.dataset.set).forEach(space => space.follow(panel.trial, at[0]));
}

/* The time that the arm shows, if it was moved. */
let slid = null;

/* The cursor where something else than a panel moves it: the time of a trial of a data set. */
function follow(set, trial, time) {
  clear();
  slid = { set, trial, time };
  figures.flatMap(figure => figure.panels).forEach(markSlid);
}

function markSlid(panel) {
  if (!panel.time || !panel.trial || panel.trial !== slid.trial || panel.figure.data.dataset.set !== slid.set) return;
  const at = [slid.time, panel.middle()[1]];
  panel.mark(at);
  cursor = cursor || { panel, at };
}

/* A panel whose numbers were read late shows what its companions show. */
function catchUp(panel) {
  const others = companions(panel).filter(other => other !== panel);
  const zoomed = panel.time && others.find(other => other.live);
  if (zoomed) panel.zoom(zoomed.view.x, null);
  if (zoomed) panel.figure.zoomed();
  if (cursor && others.includes(cursor.panel)) panel.mark(cursor.at);
  else if (slid && !cursor) markSlid(panel);
}
