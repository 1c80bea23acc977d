/* Elements, and numbers in words. */

const all = (selector, root = document) => [...root.querySelectorAll(selector)];

function html(tag, attributes = {}, text = "") {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  return made;
}

const space = (document.querySelector("svg") || document.body).namespaceURI;

function svg(parent, tag, attributes = {}, text = "") {
  const made = document.createElementNS(space, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text) made.textContent = text;
  return parent.appendChild(made);
}

function button(parent, text, label, action) {
  const made = html("button", { type: "button", "aria-label": label }, text);
  made.addEventListener("click", action);
  return parent.appendChild(made);
}

/* Four significant digits, a true minus. */
function shown(value, unit = "") {
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(3) : String(+value.toPrecision(4));
  return text.replace(/-/g, "\u2212") + (unit ? "\u00a0" + unit : "");
}

/* "time [s]" → ["time", "s"]. */
function named(label) {
  const parts = /^(.*?)\s*\[(.*)\]$/.exec(label);
  return parts ? [parts[1], parts[2]] : [label, ""];
}
