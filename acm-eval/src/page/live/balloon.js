/* What is under the cursor, in words. */

function row(one, unit) {
  const line = html("div");
  const dot = one.series.mark === "dot", swatch = svg(line, "svg", { class: "swatch", viewBox: "0 0 12 12", "aria-hidden": "true" });
  svg(swatch, dot ? "circle" : "rect", { fill: one.series.colour, ...(dot ? { cx: 6, cy: 6, r: 5 } : { y: 4.5, width: 12, height: 3 }) });
  line.append(one.series.name + " ", html("b", {}, shown(one.y, unit)));
  return line;
}

const MOST = 12;

/* What is under the cursor, in words. */
function tell(panel, at, read) {
  const balloon = panel.figure.balloon, own = read.filter(([other]) => other === panel), rest = read.filter(([other]) => other !== panel);
  const [xName, xUnit] = named(panel.x.label);
  const first = own[0][1][0];
  if (!first) { balloon.hidden = true; return; }
  const lines = [html("div", { class: "where" }, xName + " " + shown(first.x, xUnit))];
  for (const [other, found] of [...own, ...rest].slice(0, 4)) {
    const [yName, yUnit] = named(other.y.label);
    if (other.title && (rest.length || !panel.time)) lines.push(html("div", { class: "what" }, other.title === yName ? yName : [other.title, yName].filter(Boolean).join(": ")));
    else lines.push(html("div", { class: "what" }, yName));
    found.slice(0, MOST).forEach(one => lines.push(row(one, yUnit)));
    if (found.length > MOST) lines.push(html("div", {}, "and " + (found.length - MOST) + " more"));
  }
  balloon.replaceChildren(...lines);
  balloon.hidden = false;
  place(panel, at, balloon);
}

function place(panel, at, balloon) {
  const seen = panel.figure.svg.getBoundingClientRect(), k = seen.width / panel.figure.svg.viewBox.baseVal.width;
  const [x, y] = panel.forth(at).map(value => value * k);
  const card = panel.figure.card, offset = panel.figure.sheet.offsetLeft - card.offsetLeft;
  const [from, to] = [card.scrollLeft - offset, card.scrollLeft - offset + card.clientWidth];
  const [wide, high] = [balloon.offsetWidth, balloon.offsetHeight], edge = Math.min(seen.width, to);
  const floor = (panel.area[1] + panel.area[3]) * k - 4;
  const right = x + 14 + wide < edge, left = x - 14 - wide > from;
  const across = right ? x + 14 : left ? x - 14 - wide : Math.max(from, Math.min(x - wide / 2, edge - wide));
  const down = right || left ? Math.min(y + 14, floor - high) : panel.area[1] * k - high + 24;
  balloon.style.left = Math.max(0, across) + "px";
  balloon.style.top = Math.max(0, down) + "px";
}
