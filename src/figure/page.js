"use strict";
// Shows the numbers of the cell or the curve's point under the pointer or selected by keys.
const figure = document.getElementById("figure"), mark = figure.querySelector("rect"), readout = figure.querySelector("output");
let size, panels = [], release = [];  // pixels of the picture; keys of a preset
let chosen = null, again = false;     // a place; whether the pointer was at the same place before

const numbers = text => text ? text.split(" ").map(Number) : [];
const pixel = (axis, share) => axis.start + (axis.end - axis.start) * share;
const shareAt = (axis, px) => (px - axis.start) / (axis.end - axis.start);
const within = share => share > -1e-6 && share < 1 + 1e-6;
const limited = (number, count) => Math.max(0, Math.min(count - 1, number));

// A place: its texts as [label, value], and its position in pixels of the picture.
function cell(panel, column, row) {
  const { x, y, map } = panel;
  [column, row] = [limited(column, map.columns), limited(row, map.rows)];
  const across = (column + .5) / map.columns, up = (row + .5) / map.rows, value = map.values[row * map.columns + column];
  const values = [axisValue(x, across), axisValue(y, up)];
  const [width, height] = [[x, map.columns], [y, map.rows]].map(([axis, count]) => Math.max(Math.abs(axis.end - axis.start) / count, 16));
  return { panel, column, row, values, x: pixel(x, across), y: pixel(y, up), width, height, rx: 0,
    lines: [[x.label, values[0]], [y.label, values[1]], isNaN(value) ? [map.none] : [map.label, value]] };
}
function point(panel, curve, index) {
  const [x, y] = curve.points[index], values = [curve.x[index], curve.y[index]];
  return { panel, curve, index, values, x, y, width: 18, height: 18, rx: 9,
    lines: [...curve.label ? [[curve.label]] : [], [panel.x.label, values[0]], [curve.axis.label, values[1]]] };
}
function nearest(panel, x, y, curves = panel.curves) {
  const { map } = panel;
  if (map) return cell(panel, Math.floor(shareAt(panel.x, x) * map.columns), Math.floor(shareAt(panel.y, y) * map.rows));
  let best = Infinity, found = null;
  for (const curve of curves)
    curve.points.forEach(([px, py], index) => {
      const far = Math.hypot(px - x, y === undefined ? 0 : py - y);
      if (far < best) best = far, found = [curve, index];
    });
  return found && point(panel, ...found);
}
function step(panel, right, up) {
  if (chosen?.panel !== panel) return nearest(panel, pixel(panel.x, .5), pixel(panel.y, .5));
  if (panel.map) return cell(panel, chosen.column + right, chosen.row + up);
  const { curve, index } = chosen;
  if (up) return nearest(panel, chosen.x, undefined, [panel.curves[limited(panel.curves.indexOf(curve) - up, panel.curves.length)]]) ?? chosen;
  const shown = [...curve.points.keys()].filter(i => !isNaN(curve.points[i][0]));
  return point(panel, curve, shown[limited(shown.indexOf(index) + right, shown.length)]);
}

function choose(place) {
  chosen = place;
  mark.toggleAttribute("hidden", !place);
  readout.replaceChildren();
  if (!place) return;
  const { x, y, width, height, rx, panel } = place;
  for (const [name, value] of Object.entries({ x: x - width / 2, y: y - height / 2, width, height, rx })) mark.setAttribute(name, value);
  for (const [label, value] of panels.length > 1 && panel.title ? [[panel.title], ...place.lines] : place.lines) {
    const words = readout.appendChild(document.createElement("span"));
    words.textContent = label;
    if (value === undefined) words.className = "whole";
    else readout.appendChild(document.createElement("b")).textContent = written(Number(value.toPrecision(6)));
  }
  const beside = (px, side) => px < side / 2 ? "16px" : "calc(-100% - 16px)";  // on the side with more space
  const transform = `translate(${beside(x, size[0])}, ${beside(y, size[1])})`;
  Object.assign(readout.style, { left: 100 * x / size[0] + "%", top: 100 * y / size[1] + "%", transform });
}
function open() {
  const detail = () => Object.fromEntries(release.map((key, i) => [key, Number(chosen.values[i].toPrecision(12))]));
  if (chosen && release.length) document.dispatchEvent(new CustomEvent("release", { detail: detail() }));
}

figure.onpointermove = figure.onpointerdown = event => {
  const area = figure.getBoundingClientRect(), before = chosen;
  const [x, y] = [(event.clientX - area.left) / area.width * size[0], (event.clientY - area.top) / area.height * size[1]];
  const panel = panels.find(one => within(shareAt(one.x, x)) && within(shareAt(one.y, y)));
  choose(panel ? nearest(panel, x, y) : null);
  if (event.type === "pointerdown") again = before?.x === chosen?.x && before?.y === chosen?.y;
};
figure.onpointerleave = event => event.pointerType === "mouse" && choose(null);
figure.onclick = event => (event.pointerType !== "touch" || again) && open();  // a first touch shows the numbers
const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1], PageUp: [0, 0, -1], PageDown: [0, 0, 1] };
figure.onkeydown = event => {
  if (!panels.length) return;
  const [right, up, next = 0] = moves[event.key] ?? [], far = event.shiftKey ? 10 : 1;
  if (moves[event.key]) choose(step(panels[limited(panels.indexOf(chosen?.panel ?? panels[0]) + next, panels.length)], right * far, up * far));
  else if (event.key === "Escape") choose(null);
  else if (event.key === "Enter") open();
  else return;
  event.preventDefault();
};

function start() {
  const shown = JSON.parse(document.getElementById("data").textContent);
  for (const panel of shown.panels) {
    if (panel.map) panel.map.values = numbers(panel.map.values);
    for (const curve of panel.curves) {
      curve.axis = curve.right && panel.right || panel.y;
      [curve.x, curve.y] = [numbers(curve.x), numbers(curve.y)];
      curve.points = curve.x.map((value, i) => [axisShare(panel.x, value), axisShare(curve.axis, curve.y[i])])
        .map(([x, y]) => within(x) && within(y) ? [pixel(panel.x, x), pixel(curve.axis, y)] : [NaN, NaN]);
    }
  }
  ({ size, panels, release } = shown);
  figure.parentElement.style.maxWidth = `max(680px, ${85 * size[0] / size[1]}vh)`;
  figure.classList.toggle("releases", release.length > 0);
}
choose(null);
start();
