"use strict";
const map = pageData, canvas = $("canvas"), g = canvas.getContext("2d"), margin = { left: 58, bottom: 44 };
$("#scale").style.setProperty("--colors", map.scale.colors.join());
for (const [share, text] of map.scale.numbers) {
  const number = element("span", {}, text);
  number.style.setProperty("--at", 100 * share + "%");
  $("#scale").append(number);
}
$("#none").style.borderColor = map.scale.none;

let width = 0, height = 0, density = 1;
// the cell in the middle, from the top left, and pixels per cell
const view = { x: map.columns / 2, y: map.rows / 2, scale: 1 };

const plotWidth = () => width - margin.left, plotHeight = () => height - margin.bottom;
const screenX = x => margin.left + plotWidth() / 2 + (x - view.x) * view.scale;
const screenY = y => plotHeight() / 2 + (y - view.y) * view.scale;
const cellX = px => view.x + (px - margin.left - plotWidth() / 2) / view.scale;
const cellY = py => view.y + (py - plotHeight() / 2) / view.scale;

// Tiles: loaded when first needed; if there are many, the oldest are removed.
const tiles = new Map();
function tile(name) {
  if (!tiles.has(name)) {
    const image = new Image();
    image.onload = draw;
    image.src = `${map.folder}/${name}`;
    tiles.set(name, image);
    if (tiles.size > 600) tiles.delete(tiles.keys().next().value);
  }
  return tiles.get(name);
}

function drawLevel(z) {
  const size = map.tile * 2 ** (map.levels - z), first = cell => Math.max(0, Math.floor(cell / size));
  for (let row = first(cellY(0)); row * size < Math.min(map.rows, cellY(plotHeight())); ++row)
    for (let column = first(cellX(margin.left)); column * size < Math.min(map.columns, cellX(width)); ++column) {
      const image = tile(`${z}-${row}-${column}.png`);
      if (!image.complete || !image.naturalWidth) continue;
      const [left, right] = [column, column + 1].map(n => Math.round(screenX(n * size) * density));
      const [top, bottom] = [row, row + 1].map(n => Math.round(screenY(n * size) * density));
      g.drawImage(image, left, top, right - left, bottom - top);
    }
}

// At most `most` round numbers between two shares of an axis; powers of ten for several decades.
function ticks(axis, shares, most) {
  const [low, high] = shares.map(share => axisValue(axis, clamp(share, 0, 1)));
  const raw = (high - low) / Math.max(most, 1), found = [];
  const step = axis.label.endsWith("°") && raw > 10 && [15, 30, 45, 90].find(n => n >= raw) || roundStep(raw);
  if (axis.logarithmic && high / low > 20)
    for (let power = Math.ceil(Math.log10(low)); 10 ** power <= high; ++power) found.push(10 ** power);
  else for (let i = Math.ceil(low / step); i * step <= high; ++i) found.push(shortened(i * step));
  return found;
}

function drawAxes(style) {
  g.fillStyle = style.getPropertyValue("--page");
  g.fillRect(0, 0, margin.left, height);
  g.fillRect(0, plotHeight(), width, margin.bottom);
  g.fillStyle = style.getPropertyValue("--text");
  g.font = "13px system-ui, 'DejaVu Sans', sans-serif";
  g.textAlign = "center";
  for (const value of ticks(map.x, [margin.left, width].map(px => cellX(px) / map.columns), plotWidth() / 110)) {
    const px = screenX(axisShare(map.x, value) * map.columns);
    g.fillRect(px - .5, plotHeight(), 1, 5);
    g.fillText(written(value), Math.min(px, width - 16), plotHeight() + 18);
  }
  g.fillText(map.x.label, margin.left + plotWidth() / 2, height - 5);
  g.save();
  g.rotate(-Math.PI / 2);
  g.fillText(map.y.label, -plotHeight() / 2, 13);
  g.restore();
  g.textAlign = "right";
  for (const value of ticks(map.y, [plotHeight(), 0].map(py => 1 - cellY(py) / map.rows), plotHeight() / 70)) {
    const py = screenY((1 - axisShare(map.y, value)) * map.rows);
    g.fillRect(margin.left - 5, py - .5, 5, 1);
    g.fillText(written(value), margin.left - 8, py + 4);
  }
}

let waiting = false;
function draw() {
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    g.setTransform(1, 0, 0, 1, 0, 0);
    g.clearRect(0, 0, canvas.width, canvas.height);
    g.imageSmoothingEnabled = view.scale * density < 2;
    const z = Math.min(map.levels, Math.max(0, Math.ceil(map.levels + Math.log2(view.scale * density) - .2)));
    for (const level of new Set([0, Math.max(0, z - 1), z])) drawLevel(level);  // coarse tiles are loaded first
    g.scale(density, density);
    drawAxes(getComputedStyle(document.documentElement));
  });
}

let later = 0;
function moved() {
  view.scale = clamp(view.scale, .5 * plotWidth() / map.columns, 64);
  view.x = clamp(view.x, 0, map.columns);
  view.y = clamp(view.y, 0, map.rows);
  draw();
  clearTimeout(later);
  const numbers = { x: view.x.toFixed(2), y: view.y.toFixed(2), scale: view.scale.toPrecision(5) };
  later = setTimeout(() => keepAddress(numbers), 200);
}
function move(right, down) {
  view.x += right / view.scale;
  view.y += down / view.scale;
  moved();
}
function zoom(by, px = margin.left + plotWidth() / 2, py = plotHeight() / 2) {
  const x = cellX(px), y = cellY(py);
  view.scale *= by;
  moved();
  move((x - cellX(px)) * view.scale, (y - cellY(py)) * view.scale);
}
function showAll() {
  Object.assign(view, { x: map.columns / 2, y: map.rows / 2, scale: .98 * Math.min(plotWidth() / map.columns, plotHeight() / map.rows) });
  moved();
}

const pointers = new Map();
canvas.onpointerdown = event => {
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
};
canvas.onpointerup = canvas.onpointercancel = event => pointers.delete(event.pointerId);
canvas.onpointermove = event => {
  const here = [event.offsetX, event.offsetY], before = pointers.get(event.pointerId);
  $("#at").textContent = [map.x, map.y].map((axis, i) => {
    const share = i ? 1 - cellY(here[1]) / map.rows : cellX(here[0]) / map.columns;
    return `${axis.label}: ${written(shortened(axisValue(axis, share), 6))}`;
  }).join("   ");
  if (!before) return;
  const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
  pointers.set(event.pointerId, here);
  if (!other) return move(before[0] - here[0], before[1] - here[1]);
  const far = p => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
  zoom(far(here) / far(before), (here[0] + other[0]) / 2, (here[1] + other[1]) / 2);
};
canvas.addEventListener("wheel", event => {
  event.preventDefault();
  zoom(2 ** (-event.deltaY / (event.deltaMode ? 8 : 240)), event.offsetX, event.offsetY);
}, { passive: false });
canvas.ondblclick = event => zoom(2, event.offsetX, event.offsetY);
onKeys({ ArrowLeft: () => move(-80, 0), ArrowRight: () => move(80, 0), ArrowUp: () => move(0, -80), ArrowDown: () => move(0, 80),
  "+": () => zoom(1.5), "=": () => zoom(1.5), "-": () => zoom(1 / 1.5), 0: showAll });
for (const button of document.querySelectorAll("button"))
  button.onclick = () => Number(button.dataset.by) ? zoom(Number(button.dataset.by)) : showAll();

function resize() {
  const first = width === 0;
  ({ width, height } = canvas.parentElement.getBoundingClientRect());
  density = devicePixelRatio || 1;
  setSize(canvas, width, height);
  if (!first) return draw();
  showAll();
  Object.assign(view, addressNumbers());
  moved();
}
addEventListener("resize", resize);
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
resize();
