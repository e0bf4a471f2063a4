// Shows the numbers of the cell or the curve's point under the pointer or selected by keys.
"use strict";
const figure = $("#figure"), mark = $("#figure rect"), readout = $("#figure output");
// pixels of the picture that are shown, and those above them; keys of a preset
const { size, above, panels, release } = pageData;
let chosen = null, again = false;  // a place; whether the pointer was at the same place before

const numbersIn = text => text ? text.split(" ").map(Number) : [];
const isInPanel = ([px, py], { x, y }) =>
  [shareAt(x, px), shareAt(y, py)].every(share => share > -1e-6 && share < 1 + 1e-6);

// A place: its texts as [label, value], and its position in pixels of the picture.
function cell(panel, column, row) {
  const { x, y, map } = panel, counts = [map.columns, map.rows];
  [column, row] = [column, row].map((number, i) => clamp(number, 0, counts[i] - 1));
  const [across, up] = [(column + .5) / map.columns, (row + .5) / map.rows];
  const value = map.values[row * map.columns + column];
  const [width, height] = [x, y].map(({ start, end }, i) => Math.max(Math.abs(end - start) / counts[i], 16));
  const values = [axisValue(x, across), axisValue(y, up)], last = isNaN(value) ? [map.none] : [map.label, value];
  return { panel, column, row, values, x: pixelAt(x, across), y: pixelAt(y, up), width, height, rx: 0,
    lines: [[x.label, values[0]], [y.label, values[1]], last] };
}
function point(panel, curve, index) {
  const { at: [x, y], values } = curve.points[index], label = curve.label ? [[curve.label]] : [];
  return { panel, curve, index, values, x, y, width: 18, height: 18, rx: 9,
    lines: [...label, [panel.x.label, values[0]], [curve.axis.label, values[1]]] };
}
function nearest(panel, x, y, curves = panel.curves) {
  const { map } = panel, [across, up] = [shareAt(panel.x, x), shareAt(panel.y, y)];
  if (map) return cell(panel, Math.floor(across * map.columns), Math.floor(up * map.rows));
  let best = Infinity, found = null;
  for (const curve of curves)
    curve.points.forEach(({ at }, index) => {
      const far = Math.hypot(at[0] - x, y === undefined ? 0 : at[1] - y);
      if (far < best) best = far, found = [curve, index];
    });
  return found && point(panel, ...found);
}
function choose(place) {
  chosen = place;
  mark.toggleAttribute("hidden", !place);
  readout.replaceChildren();
  if (!place) return;
  const { x, y, width, height, rx, panel, lines } = place;
  const corner = { x: x - width / 2, y: y - height / 2, width, height, rx };
  for (const [name, value] of Object.entries(corner)) mark.setAttribute(name, value);
  for (const [label, value] of panels.length > 1 && panel.title ? [[panel.title], ...lines] : lines) {
    readout.append(element("span", { class: value === undefined ? "whole" : "" }, label));
    if (value !== undefined) readout.append(element("b", {}, written(shortened(value, 6))));
  }
  const beside = (px, side) => px < side / 2 ? "16px" : "calc(-100% - 16px)";  // on the side with more space
  Object.assign(readout.style, { left: `${100 * x / size[0]}%`, top: `${100 * (y - above) / size[1]}%`,
    transform: `translate(${beside(x, size[0])}, ${beside(y - above, size[1])})` });
}
function open() {
  if (chosen && release.length)
    releaseAt(Object.fromEntries(release.map((key, i) => [key, shortened(chosen.values[i])])));
}

figure.onpointermove = figure.onpointerdown = event => {
  const area = figure.getBoundingClientRect(), before = chosen;
  const x = (event.clientX - area.left) / area.width * size[0];
  const y = above + (event.clientY - area.top) / area.height * size[1];
  const panel = panels.find(one => isInPanel([x, y], one));
  choose(panel ? nearest(panel, x, y) : null);
  if (event.type === "pointerdown") again = before?.x === chosen?.x && before?.y === chosen?.y;
};
figure.onpointerleave = event => event.pointerType === "mouse" && choose(null);
figure.onclick = event => (event.pointerType !== "touch" || again) && open();  // a first touch shows the numbers

// The place so many columns or points, and rows or curves, from the chosen one, or in the middle of another panel.
function stepBy(right, up, next = 0) {
  const panel = panels[clamp(panels.indexOf(chosen?.panel ?? panels[0]) + next, 0, panels.length - 1)];
  if (chosen?.panel !== panel) return nearest(panel, pixelAt(panel.x, .5), pixelAt(panel.y, .5));
  const { curve, index, column, row, x } = chosen, { curves } = panel;
  if (panel.map) return cell(panel, column + right, row + up);
  const other = curves[clamp(curves.indexOf(curve) - up, 0, curves.length - 1)];
  if (up) return nearest(panel, x, undefined, [other]) ?? chosen;
  return point(panel, curve, clamp(index + right, 0, curve.points.length - 1));
}
const move = (...step) => ({ shiftKey }) => choose(stepBy(...step.map(n => n * (shiftKey ? 10 : 1))));
if (panels.length)
  onKeys({ ArrowLeft: move(-1, 0), ArrowRight: move(1, 0), ArrowUp: move(0, 1), ArrowDown: move(0, -1),
    PageUp: move(0, 0, -1), PageDown: move(0, 0, 1), Escape: () => choose(null), Enter: open }, figure);

for (const panel of panels) {
  if (panel.map) panel.map.values = numbersIn(panel.map.values);
  for (const curve of panel.curves) {
    const ys = numbersIn(curve.y), axis = curve.axis = curve.right && panel.right || panel.y;
    const at = (x, y) => [pixelAt(panel.x, axisShare(panel.x, x)), pixelAt(axis, axisShare(axis, y))];
    curve.points = numbersIn(curve.x).map((x, i) => ({ values: [x, ys[i]], at: at(x, ys[i]) }))
      .filter(point => isInPanel(point.at, panel));
  }
}
figure.parentElement.style.maxWidth = `max(780px, ${85 * size[0] / size[1]}vh)`;
figure.style.aspectRatio = `${size[0]} / ${size[1]}`;
$("#figure img").style.marginTop = `${-100 * above / size[0]}%`;
figure.classList.toggle("releases", release.length > 0);
choose(null);
