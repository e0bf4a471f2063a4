// player.js: draws the film at any time. What is drawn, and in what order, is what src/film/pendulum_layer.cpp, strip_layer.cpp and
// phase_layer.cpp draw; lengths are pixels of the film's picture.
"use strict";
const canvas = document.querySelector("canvas"), screen = canvas.getContext("2d"), stage = canvas.parentElement;
const shows = part => film.show.includes(part), clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const isEnsemble = layout === "ensemble", isSingle = layout === "single";
let g = screen, backdrop = document.createElement("canvas"), picture = film.pictures[0];
let motion = null, original = null;  // what is shown, and the film's own
let time = 0;                        // s

// Colours, "#rrggbb" or "#rrggbbaa"

const channels = color => [1, 3, 5, 7].map(i => i < color.length ? parseInt(color.slice(i, i + 2), 16) : 255);
const hex = list => "#" + list.map(c => Math.round(c).toString(16).padStart(2, "0")).join("");
const mixed = (a, b, share) => hex(channels(a).map((c, i) => c + share * (channels(b)[i] - c)));
const faded = (color, alpha) => hex([...channels(color).slice(0, 3), 255 * clamp(alpha, 0, 1)]);

// What pictures are made of

function fill(color, trace) {
  g.fillStyle = color;
  g.beginPath();
  trace();
  g.fill();
}
function stroke(color, width, trace, cap = "round") {
  Object.assign(g, { strokeStyle: color, lineWidth: width, lineCap: cap, lineJoin: "round" });
  g.beginPath();
  trace();
  g.stroke();
}
const polyline = points => points.forEach((point, i) => g[i ? "lineTo" : "moveTo"](...point));
const rectangle = (left, top, width, height, corner, color) => fill(color, () => g.roundRect(left, top, width, height, corner));
const line = (from, to, radius, color) => stroke(color, 2 * radius, () => polyline([from, to]));
const ring = ([x, y], radius, width, color) => stroke(color, width, () => g.arc(x, y, radius, 0, 7));
function disc([x, y], radius, color, glow = 0) {
  const light = g.createRadialGradient(x, y, radius, x, y, radius + glow);
  for (let s = 0; s <= 1; s += 0.25) light.addColorStop(s, faded(color, (1 - s) ** 2 / 3));
  if (glow > 0) fill(light, () => g.arc(x, y, radius + glow, 0, 7));
  fill(color, () => g.arc(x, y, radius, 0, 7));
}
// Narrower than its font has it where it would be wider than `width`: where the reader lacks the film's font.
function text(words, [x, y], size, align, isBold, color, width = 1e5) {
  Object.assign(g, { font: `${isBold ? 700 : 400} ${size}px "DejaVu Sans", Verdana, system-ui, sans-serif`, fillStyle: color,
    textAlign: ["left", "center", "right"][align] });
  g.fillText(words, x, y, width + 1);
}
const drawing = { b: rectangle, c: line, r: ring, t: text };
const drawAll = items => items.forEach(([kind, ...item]) => drawing[kind](...item));
const drawLabel = ([, , at, size, align, isBold, color], words) => text(words, at, size, align, isBold, color);

// The moment

const sampleNow = () => clamp(Math.floor(time / film.sample_s + 1e-6), 0, film.samples);
const isBetween = () => time - sampleNow() * film.sample_s > 1e-6;
// Between samples by a cubic through four of them (Catmull & Rom 1974).
function value(list) {
  const s = clamp(time / film.sample_s, 0, film.samples), i = Math.floor(s + 1e-6), u = s - i;
  if (Math.abs(u) < 1e-5) return list[i];
  const [p, a, b, q] = [Math.max(i - 1, 0), i, i + 1, Math.min(i + 2, film.samples)].map(k => list[k]);
  return a + 0.5 * u * (b - p + u * (2 * p - 5 * a + 4 * b - q + u * (3 * (a - b) + q - p)));
}
const speedAt = t => film.speed.reduce((last, entry) => entry[0] <= t + 1e-9 ? entry : last);

// Pendulums as they are now: places, m, and masses, kg.
const posesNow = () => motion.pendulums.map(({ bobs, pivot }, k) => ({
  bobs: bobs.map(place => place.map(value)), pivot: pivot ? pivot.map(value) : [0, 0], mass: motion.of?.[k].mass ?? bodies[k].mass }));
const reachOf = of => mostOf(of.map(chain => sumOf(chain.length)));

// A panel's way from metres to pixels. Where the view follows a mass, that stays in the middle.
function viewOf({ center, origin, scale, sides }, poses) {
  if (motion !== original) scale *= reachOf(bodies.map(body => body.chain)) / reachOf(motion.of);
  const still = ([x, y]) => [center[0] + scale * (x - origin[0]), center[1] - scale * (y - origin[1])];
  const seen = film.follow ? still(poses[isEnsemble ? 0 : sides[0]].bobs[film.follow - 1]) : center;
  return place => still(place).map((c, i) => c + center[i] - seen[i]);
}

// A path of points [x, y, age, s] that fades and narrows with its age, in pieces of even light; broken where it jumps.
function fadingPath(points, width, color, glow, jump = Infinity) {
  const pieces = Math.max(8, 20 * film.trail_s), middle = (p, q) => [(p[0] + q[0]) / 2, (p[1] + q[1]) / 2];
  const pieceOf = i => Math.floor(pieces * points[i][2] / film.trail_s), jumps = i => Math.abs(points[i + 1][0] - points[i][0]) > jump;
  for (let i = 0; i + 1 < points.length;) {
    const piece = pieceOf(i), fresh = clamp(1 - points[i][2] / film.trail_s, 0, 1), light = fresh ** 1.6, reach = glow * fresh ** 4;
    const begin = i > 0 && !jumps(i - 1) ? middle(points[i - 1], points[i]) : points[i], curve = new Path2D();
    curve.moveTo(begin[0], begin[1]);
    for (let goesOn = true; goesOn; ++i) {
      const [x, y] = points[i], isLast = jumps(i) || i + 2 === points.length;
      if (!jumps(i)) curve.quadraticCurveTo(x, y, ...middle(points[i], points[i + 1]));
      if (isLast) curve.lineTo(...points[jumps(i) ? i : i + 1].slice(0, 2));
      goesOn = !isLast && pieceOf(i + 1) === piece;
    }
    for (const [share, part] of reach > 1 ? [[0.7, 0.05], [0.4, 0.1], [0.15, 0.15], [0, 1]] : [[0, 1]]) {
      Object.assign(g, { strokeStyle: faded(color, channels(color)[3] / 255 * light * part), lineCap: "butt", lineJoin: "round",
        lineWidth: width * (0.55 + 0.45 * fresh) + 2 * share * reach });
      g.stroke(curve);
    }
  }
}
// The samples that a trail shows, with their age, s.
const trailSamples = () => {
  const first = Math.max(0, Math.ceil((time - film.trail_s) / film.sample_s)), last = motion.isStill ? -1 : sampleNow();
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => [first + k, time - (first + k) * film.sample_s]);
};

function drawTrail(k, at, color, width) {
  const [xs, ys] = motion.pendulums[k].bobs.at(-1), points = trailSamples().map(([i, age]) => [...at([xs[i], ys[i]]), age]);
  if (film.trail_s > 0 && width > 0) fadingPath([...points, [...at([value(xs), value(ys)]), 0]], width, color, picture.glow);
}

// Rods, and springs as zigzags.
function drawLines(k, { bobs, pivot }, at, radius, color) {
  const end = of => at(typeof of === "number" ? bobs[of] : [of[0] + pivot[0], of[1] + pivot[1]]);
  for (const [kind, from, to, width] of shows("rods") && radius > 0 ? bodies[k].lines : []) {
    if (kind === 0) line(end(from), end(to), width * radius, color);
    if (kind !== 1) continue;
    const turns = 16, [a, b] = [end(from), end(to)], along = [b[0] - a[0], b[1] - a[1]], swing = 0.5 * picture.bob / Math.max(Math.hypot(...along), 1);
    const zigzag = Array.from({ length: turns }, (_, i) => {
      const share = (i + 0.5) / turns, aside = i % 2 ? swing : -swing;
      return [a[0] + share * along[0] - aside * along[1], a[1] + share * along[1] + aside * along[0]];
    });
    stroke(color, 0.9 * radius, () => polyline([a, ...zigzag, b]));
  }
}

// Where the fixed ends are.
function drawPivots(k, { pivot }, at) {
  const radius = Math.max(0.4 * picture.bob, 0.5 * picture.lastBob, 0.012 * picture.reach);
  for (const [kind, ...ends] of shows("rods") && picture.rod > 0 ? bodies[k].lines : [])
    for (const end of kind > 2 ? [] : ends.slice(0, kind === 2 ? 1 : 2))
      if (typeof end === "object") disc(at([end[0] + pivot[0], end[1] + pivot[1]]), radius, theme.pivot);
}

function drawPanel(panel, poses) {
  const at = viewOf(panel, poses), [left, top, right, bottom] = panel.area, heaviest = mostOf([1e-300, ...poses.flatMap(pose => pose.mass)]);
  const put = (k, i, color, { least = 0, glow = 0, hasRim = false } = {}) => {
    const thickest = mostOf([1, ...bodies[k].lines.map(item => item[3])]), place = at(poses[k].bobs[i]);
    const smallest = Math.max(least, (thickest > 1 ? 0.5 * thickest : 1.6) * picture.rod);
    const radius = Math.max(picture.bob * Math.sqrt(poses[k].mass[i] / heaviest), smallest), edge = film.view ? radius : 0;
    const isInside = place[0] >= left + edge && place[0] <= right - edge && place[1] >= top + edge && place[1] <= bottom - edge;
    if (!isInside || !shows("bobs") || !(picture.bob > 0)) return;
    if (hasRim && !film.transparent) disc(place, radius + Math.min(Math.max(2 * picture.unit, 0.75), 0.3 * radius), theme.panel);
    disc(place, radius, color, glow);
  };
  const putAll = (k, ofLast, ofOthers, least) => poses[k].mass.forEach((_, i, { length }) => i + 1 < length
    ? put(k, i, ofOthers, { hasRim: true }) : put(k, i, ofLast, { least, glow: picture.glow, hasRim: true }));
  g.save();
  g.beginPath();
  g.rect(left, top, right - left, bottom - top);
  g.clip();
  if (film.follow && picture.reach > 0 && shows("circle")) ring(at([0, 0]), picture.reach, picture.grid, theme.grid);
  if (isEnsemble) drawMembers(at, poses, put, putAll);
  else drawSides(panel.sides, at, poses, put, putAll);
  g.restore();
}

// The members of an ensemble, the last one behind; the more they are, the more they let through.
function drawMembers(at, poses, put, putAll) {
  const isFew = bodies.length <= 8, root = Math.sqrt(bodies.length), order = bodies.map((_, k) => k).reverse();
  const hue = (k, opacity) => isFew ? bodies[k].color : faded(bodies[k].color, clamp(opacity * 14 / root, 0.16, 0.9));
  for (const k of order) drawTrail(k, at, hue(k, 0.5), picture.trail * clamp(Math.sqrt(8) / root, 0.4, 1));
  for (const k of order) {
    drawLines(k, poses[k], at, picture.rod, hue(k, 0.43));
    if (isFew) putAll(k, bodies[k].color, mixed(theme.bob, bodies[k].color, 0.4), 0);
  }
  drawPivots(0, poses[0], at);
  for (const k of isFew ? [] : order) put(k, poses[k].mass.length - 1, bodies[k].color);
}

// The pendulums of a panel; of one alone the other as a shadow behind it, but where nobody can tell the two apart.
function drawSides(sides, at, poses, put, putAll) {
  const isAlone = sides.length === 1, other = 1 - sides[0], behind = [...sides].reverse();
  const areOne = () => poses[0].mass.length === poses[1].mass.length && poses[0].mass.every((m, i) => {
    const [p, q] = poses.map(pose => at(pose.bobs[i]));
    return m === poses[1].mass[i] && Math.hypot(p[0] - q[0], p[1] - q[1]) < 0.1;
  });
  if (isAlone && !isSingle && shows("twin") && !areOne()) {
    const ghost = film.transparent ? faded(theme.sides[other], 0.4) : mixed(theme.panel, theme.sides[other], 0.26);
    drawLines(other, poses[other], at, 0.7 * picture.rod, ghost);
    poses[other].mass.forEach((_, i) => put(other, i, ghost));
  }
  for (const k of behind) drawTrail(k, at, theme.sides[k], picture.trail);
  for (const k of behind) {
    const hued = (color, share) => isAlone ? color : mixed(color, theme.sides[k], share);
    drawLines(k, poses[k], at, picture.rod, hued(theme.rod, 0.55));
    drawPivots(k, poses[k], at);
    putAll(k, theme.sides[k], hued(theme.bob, 0.4), picture.lastBob);
  }
}

// Strips: axes are [low, high, from, to, logarithmic]

function along([low, high, from, to, isLogarithmic], v) {
  const share = !isLogarithmic ? (v - low) / (high - low) : v > 0 ? Math.log(v / low) / Math.log(high / low) : 0;
  return from + (to - from) * clamp(share, 0, 1);
}
const raised = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
const powerOfTen = e => e === 0 ? "1" : e === 1 ? "10" : "10" + [...String(e)].map(c => raised[c]).join("");
const minus = v => String(v).replace("-", "−");
function scientific(v) {
  if (!(v > 0)) return "0";
  if (v >= 0.1 && v < 1000) return String(Number(v.toPrecision(2)));
  const [digits, e] = v.toExponential(1).split("e");
  return `${digits} × ${powerOfTen(Number(e))}`;
}

// Of a release by hand: where a logarithmic axis does not hold the curve, whole decades that do, drawn over the film's.
function decadesOf(strip, list) {
  const [low, high, from, to] = strip.axis, positive = [...list].filter(v => v > 0), most = mostOf([low, ...positive]);
  const least = -mostOf([-most, ...positive.map(v => -v)]), [left, top, right, bottom] = strip.area, em = picture.em;
  if (least >= low && most <= high) return strip.axis;
  const first = Math.floor(Math.log10(least)), last = Math.max(Math.ceil(Math.log10(most)), first + 1);
  const axis = [10 ** first, 10 ** last, from, to, true], every = Math.ceil((last - first) * 2.2 * em / (bottom - top));
  rectangle(left, top, right - left, bottom - top, 0, theme.background);
  rectangle(0, top - 0.6 * em, left, bottom - top + 1.2 * em, 0, theme.background);
  for (let e = first; e <= last; e += every) {
    rectangle(left, along(axis, 10 ** e), right - left, Math.max(1, picture.grid), 0, theme.grid);
    text(powerOfTen(e), [left - 0.55 * em, along(axis, 10 ** e) + 0.36 * em], em, 2, false, theme.quiet_text);
  }
  return axis;
}

// A dashed line, and beside it at its foot, above what stands there, what it marks.
function drawMark(strip, at, words) {
  const [left, top, right, bottom] = strip.area, x = along(strip.time, at), t = picture.text, size = picture.font, wide = Math.max(1, Math.round(picture.mark));
  for (let y = top; picture.mark > 0 && y < bottom; y += 10 * t) rectangle(Math.round(x - wide / 2), y, wide, Math.min(5 * t, bottom - y), 0, theme.quiet_text);
  text("", [0, 0], size, 0, false, theme.text);
  const width = g.measureText(words).width, isRight = right - x - 20 * t >= Math.min(width, x - left - 20 * t);
  const from = clamp(isRight ? x + 10 * t : x - 10 * t - width, left + 2 * t, Math.max(left + 2 * t, right - width - 2 * t));
  const notes = motion === original ? strip.backdrop.filter(item => item[0] === "t" && item[6] === theme.text) : [];
  const foot = Math.min(bottom - 0.45 * size, ...notes.map(item => item[2][1] - 1.2 * size));
  if (!film.transparent) rectangle(from - 4 * t, foot - 0.9 * size, width + 8 * t, 1.18 * size, 0, faded(theme.background, 0.85));
  text(words, [from, foot], size, 0, false, theme.text);
}

const stripOfPair = Math.max(0, film.strips.findIndex(strip => strip.kind === "distance"));
function drawStrip(strip, index) {
  const { kind, colors } = film.strips[index], curves = motion.curves[index], now = motion.isStill ? film.samples : sampleNow();
  const axis = motion === original || !strip.axis[4] ? strip.axis : decadesOf(strip, curves[0]), x = along(strip.time, time);
  const goesOn = !motion.isStill && isBetween(), end = list => goesOn ? value(list) : list[now];
  drawAll(strip.words);
  if (strip.value && !motion.isStill) drawLabel(strip.value, kind === "distance" ? scientific(end(curves[0])) : Number.isNaN(end(curves[0])) ? "" : minus(end(curves[0]).toFixed(2)));
  if ((motion.isStill || time >= motion.since + 1 - 1e-6) && motion.since >= 0 && index === stripOfPair)
    drawMark(strip, motion.since, `diverged at ${motion.since.toFixed(1)} s`);
  const wide = Math.max(1, Math.round(picture.mark)), [, top, , bottom] = strip.area;
  if (picture.mark > 0) rectangle(Math.round(x - wide / 2), top, wide, bottom - top, 0, theme.cursor);
  curves.forEach((list, c) => {
    const points = [];
    for (let i = 0; i <= now; ++i) if (!Number.isNaN(list[i])) points.push([along(strip.time, i * film.sample_s), along(axis, list[i])]);
    if (goesOn && !Number.isNaN(end(list))) points.push([x, along(axis, end(list))]);
    if (picture.trace > 0) stroke(colors[c], strip.widths[c], () => polyline(points));
    if (picture.trace > 0 && curves.length === 1 && points.length && !motion.isStill) disc(points.at(-1), Math.max(2.3 * picture.trace, 2), colors[c]);
  });
}

// Rates over angles: paths, or the points at which θ1 passes a whole number of turns upwards.
function drawPhase({ area, angle, rate }) {
  const at = (a, w) => [along(angle, (a - 2 * Math.PI * Math.round(a / (2 * Math.PI))) * degrees), along(rate, w * degrees)];
  for (const k of [1, 0]) {
    const [angles, rates, first] = motion.phase[k], color = theme.sides[k], head = at(value(angles), value(rates)), turns = i => Math.floor(first[i] / (2 * Math.PI));
    if (film.phase.kind === "section") {
      for (let i = 1; i <= sampleNow(); ++i) {
        const share = (2 * Math.PI * turns(i) - first[i - 1]) / (first[i] - first[i - 1]), passed = list => list[i - 1] + share * (list[i] - list[i - 1]);
        if (turns(i) > turns(i - 1)) disc(at(passed(angles), passed(rates)), 1.2 * picture.trace, faded(color, 0.8));
      }
      continue;
    }
    const points = trailSamples().map(([i, age]) => [...at(angles[i], rates[i]), age]);
    fadingPath([...points, [...head, 0]], picture.trail, color, picture.glow, (area[2] - area[0]) / 2);
    disc(head, Math.max(2.3 * picture.trace, 2), color);
  }
}

// Of a release by hand the angles above the pendulums, in place of the film's words.
function drawWords() {
  if (motion === original) return drawAll(picture.words);
  if (shows("title") && picture.words.length) text("Released anew", ...picture.words[0].slice(2, 7));
  for (const { area, sides } of picture.panels) {
    const k = isEnsemble ? 0 : sides[0], words = motion.of[k].angle.map(a => `${minus(Number((a * degrees).toPrecision(8)))}°`).join("   ");
    text(words, [area[0], area[1] - 12 * picture.text], picture.font, 0, true, isEnsemble ? theme.text : theme.sides[k]);
  }
}

function draw() {
  g = screen;
  g.setTransform(1, 0, 0, 1, 0, 0);
  g.clearRect(0, 0, canvas.width, canvas.height);
  g.drawImage(backdrop, 0, 0);
  if (!motion) return;
  const scale = canvas.width / picture.size[0], poses = posesNow();
  g.setTransform(scale, 0, 0, scale, 0, 0);
  drawWords();
  for (const panel of picture.panels) drawPanel(panel, poses);
  if (picture.phase && motion.phase) drawPhase(picture.phase);
  if (motion.curves) picture.strips.forEach(drawStrip);
  if (picture.clock) drawLabel(picture.clock, `${time.toFixed(film.decimals)} s`);
  if (picture.speed) drawLabel(picture.speed, speedAt(time)[2]);
}

// The picture that fits the page, upright ones into upright pages, at the screen's density.
function resize() {
  const { width, height } = stage.getBoundingClientRect();
  picture = film.pictures[1] && height > 1.2 * width ? film.pictures[1] : film.pictures[0];
  const [w, h] = picture.size, scale = Math.min(width / w, height / h), density = devicePixelRatio || 1;
  Object.assign(canvas.style, { width: `${scale * w}px`, height: `${scale * h}px` });
  for (const of of [canvas, backdrop]) of.width = Math.max(1, Math.round(scale * w * density)), of.height = Math.max(1, Math.round(scale * h * density));
  g = backdrop.getContext("2d");
  g.setTransform(canvas.width / w, 0, 0, canvas.width / w, 0, 0);
  drawAll(picture.backdrop);
  for (const strip of picture.strips) drawAll(strip.backdrop);
  draw();
}
