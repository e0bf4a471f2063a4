// player.js: draws the film at any time. What is drawn, and in what order, is what src/film/layer.cpp and strips.cpp
// draw; lengths are pixels of the film's picture.
"use strict";
const canvas = $("canvas"), g = canvas.getContext("2d");
const isEnsemble = layout === "ensemble", isMany = bodies.length > 8, shows = part => film.show.includes(part);
let picture = film.pictures[0];
let motion = null, original = null;  // what is shown, and the film's own
let time = 0;                        // s

// What pictures are made of; colours are "#rrggbb" or "#rrggbbaa".

const faded = (color, alpha) => color.slice(0, 7) + Math.round(255 * alpha).toString(16).padStart(2, "0");
function paint(style, trace) {
  Object.assign(g, style);
  g.beginPath();
  trace();
  g[style.fillStyle ? "fill" : "stroke"]();
}
const fill = (fillStyle, trace) => paint({ fillStyle }, trace);
const stroke = (strokeStyle, lineWidth, trace) =>
  paint({ strokeStyle, lineWidth, lineCap: "round", lineJoin: "round" }, trace);
const polyline = points =>  // with gaps where there is no number
  points.forEach(([x, y], i) => i && isFinite(points[i - 1][1]) ? g.lineTo(x, y) : g.moveTo(x, y));
const box = (left, top, width, height, corner, color) =>
  fill(color, () => g.roundRect(left, top, width, height, corner));
const line = (from, [x, y], radius, color) =>  // a canvas draws none of length 0
  stroke(color, 2 * radius, () => polyline([from, [x + 1e-3, y]]));
const ring = ([x, y], radius, width, color) => stroke(color, width, () => g.arc(x, y, radius, 0, 7));
function disc([x, y], radius, color, glow = 0) {
  const light = g.createRadialGradient(x, y, radius, x, y, radius + glow);
  for (let s = 0; s <= 1; s += 0.25) light.addColorStop(s, faded(color, (1 - s) ** 2 / 3));
  if (glow > 0) fill(light, () => g.arc(x, y, radius + glow, 0, 7));
  fill(color, () => g.arc(x, y, radius, 0, 7));
}
const fonts = '"DejaVu Sans", Verdana, system-ui, sans-serif';
// Narrower than its font has it where it would be wider than `width`: where the reader lacks the film's font.
function text(words, [x, y], size, align, weight, color, width = 1e5) {
  Object.assign(g, { fillStyle: color, textAlign: align, font: `${weight} ${size}px ${fonts}` });
  g.fillText(words, x, y, width + 1);
}
function clipped([left, top, right, bottom], margin, draws) {
  g.save();
  g.beginPath();
  g.rect(left - margin, top - margin, right - left + 2 * margin, bottom - top + 2 * margin);
  g.clip();
  draws();
  g.restore();
}
const isIn = ([x, y], [left, top, right, bottom]) => x >= left && x <= right && y >= top && y <= bottom;
const drawAll = items => items.forEach(([kind, ...item]) => ({ box, line, ring, text }[kind](...item)));
const drawLabel = (label, words) => text(words, ...label.slice(2, 7));

// The moment

const sampleNow = () => clamp(Math.floor(time / film.sample_s + 1e-6), 0, film.samples);
// Between samples by a cubic through four of them (Catmull & Rom 1974).
function value(list) {
  const s = clamp(time / film.sample_s, 0, film.samples), i = sampleNow(), u = s - i;
  if (Math.abs(u) < 1e-5) return list[i];
  const [p, a, b, q] = [i - 1, i, i + 1, i + 2].map(k => list[clamp(k, 0, film.samples)]);
  return a + 0.5 * u * (b - p + u * (2 * p - 5 * a + 4 * b - q + u * (3 * (a - b) + q - p)));
}
const speedAt = t => film.speed.reduce((last, entry) => entry[0] <= t + 1e-9 ? entry : last);

// Pendulums as they are now: places, m, and masses, kg.
const posesNow = () => motion.pendulums.map(({ bobs, pivot }, k) => ({
  bobs: bobs.map(place => place.map(value)), pivot: pivot.map(value), mass: (motion.of ?? bodies)[k].mass }));
const reachOf = chains => mostOf(chains.map(chain => sumOf(chain.length)));

// A panel's way from metres to pixels. Where the view follows a mass, that stays in the middle.
function viewOf({ center, origin, scale, shown }, poses) {
  if (motion !== original) scale *= reachOf(bodies.map(body => body.chain)) / reachOf(motion.of);
  const still = ([x, y]) => [center[0] + scale * (x - origin[0]), center[1] - scale * (y - origin[1])];
  const seen = film.follow ? still(poses[shown[0]].bobs[film.follow - 1]) : center;
  return place => still(place).map((c, i) => c + center[i] - seen[i]);
}

// The path up to now of what `at` finds of the samples of `lists`: it fades and narrows with its age, in pieces of
// even light, and is broken where it jumps.
function drawTrail(at, lists, width, color, jump = Infinity) {
  const pieces = new Map(), shares = Math.max(8, 20 * film.trail_s) / film.trail_s, points = [];
  const first = motion.isStill ? Infinity : Math.max(0, Math.ceil((time - film.trail_s) / film.sample_s));
  for (let i = first; i <= sampleNow(); ++i)
    points.push([...at(lists.map(list => list[i])), time - i * film.sample_s]);
  points.push([...at(lists.map(value)), 0]);
  points.forEach(([x, y, age], i) => {
    const [from, to] = [points[i - 1], points[i + 1]].map(next =>
      next && Math.abs(next[0] - x) <= jump ? [(x + next[0]) / 2, (y + next[1]) / 2] : [x, y]);
    const piece = Math.floor(shares * age);
    if (!pieces.has(piece)) pieces.set(piece, { age, curve: new Path2D() });
    const { curve } = pieces.get(piece);
    curve.moveTo(...from);
    curve.quadraticCurveTo(x, y, ...to);
  });
  for (const { age, curve } of pieces.values()) {
    const fresh = clamp(1 - age / film.trail_s, 0, 1), reach = picture.glow * fresh ** 4;
    for (const [share, light] of reach > 1 ? [[0.7, 0.05], [0.4, 0.1], [0.15, 0.15], [0, 1]] : [[0, 1]]) {
      Object.assign(g, { strokeStyle: color, globalAlpha: light * fresh ** 1.6, lineCap: "butt", lineJoin: "round",
        lineWidth: width * (0.55 + 0.45 * fresh) + 2 * share * reach });
      g.stroke(curve);
    }
  }
  g.globalAlpha = 1;
}

// Rods, springs as zigzags, and pivots where ends are fixed.
function drawLines(k, { bobs, pivot }, at, radius, color, hasPivots = true) {
  if (!shows("rods") || !(radius > 0)) return;
  const { lines, pivots } = bodies[k], { bob, last_bob, reach } = picture;
  const place = end => at(end.length ? [end[0] + pivot[0], end[1] + pivot[1]] : bobs[end]);
  for (const [kind, from, to, width] of lines) {
    const [a, b] = [place(from), place(to)], [x, y] = [b[0] - a[0], b[1] - a[1]];
    const swing = 0.5 * bob / Math.max(Math.hypot(x, y), 1), turns = Array.from({ length: 16 }, (_, i) => {
      const share = (i + 0.5) / 16, aside = i % 2 ? swing : -swing;
      return [a[0] + share * x - aside * y, a[1] + share * y + aside * x];
    });
    if (kind === "rod") line(a, b, width * radius, color);
    else stroke(color, 0.9 * radius, () => polyline([a, ...turns, b]));
  }
  for (const end of hasPivots ? pivots : [])
    disc(place(end), Math.max(0.4 * bob, 0.5 * last_bob, 0.012 * reach), theme.pivot);
}

// Bobs, the last one in a colour of its own, where they are in the panel; of many pendulums only the last one.
function drawBobs(k, poses, at, [left, top, right, bottom], ghost) {
  const { bobs, mass } = poses[k], { color, bob, least_bob } = bodies[k], end = bobs.length - 1;
  const heaviest = mostOf([1e-300, ...poses.flatMap(pose => pose.mass)]), first = isMany ? end : 0;
  for (let i = shows("bobs") && picture.bob > 0 ? first : end + 1; i <= end; ++i) {
    const isLast = i === end && !ghost, least = isLast && !isEnsemble ? picture.last_bob : 0, [x, y] = at(bobs[i]);
    const radius = Math.max(picture.bob * Math.sqrt(mass[i] / heaviest), least_bob * picture.rod, least);
    const edge = film.view ? radius : 0, rim = Math.min(Math.max(2 * picture.unit, 0.75), 0.3 * radius);
    if (!isIn([x, y], [left + edge, top + edge, right - edge, bottom - edge])) continue;
    if (!ghost && !isMany && !film.transparent) disc([x, y], radius + rim, theme.panel);
    disc([x, y], radius, ghost ?? (isLast ? color : bob), isLast ? picture.glow : 0);
  }
}

// The pendulums of a panel; of one alone the other as a ghost behind it.
function drawPanel(panel, poses) {
  const at = viewOf(panel, poses), { area, shown } = panel, fromBehind = [...shown].reverse(), { rod } = picture;
  const isAlone = !isEnsemble && shown.length === 1, other = 1 - shown[0];
  if (film.follow && picture.reach > 0 && shows("circle")) ring(at([0, 0]), picture.reach, picture.grid, theme.grid);
  if (isAlone && poses.length > 1 && shows("twin")) {
    const { ghost } = bodies[other];
    drawLines(other, poses[other], at, 0.7 * rod, ghost, false);
    drawBobs(other, poses, at, area, ghost);
  }
  for (const k of film.trail_s > 0 && picture.trail > 0 ? fromBehind : [])
    drawTrail(at, motion.pendulums[k].bobs.at(-1), picture.trail, bodies[k].trail);
  for (const k of fromBehind) {
    drawLines(k, poses[k], at, rod, bodies[k].rod);
    if (!isMany) drawBobs(k, poses, at, area);
  }
  for (const k of isMany ? fromBehind : []) drawBobs(k, poses, at, area);
}

// Strips and phase panels

const along = (axis, v) => pixelAt(axis, clamp(axisShare(axis, v), -1, 2));
const powerOfTen = e => ["1", "10"][e] ?? "10" + [...String(e)].map(c => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");
function scientific(v) {
  if (!(v > 0)) return "0";
  if (v >= 0.1 && v < 1000) return v < 9.95 ? v.toPrecision(2) : String(shortened(v, 2));
  const [digits, e] = v.toExponential(1).split("e");
  return `${digits} × ${powerOfTen(Number(e))}`;
}

// Of a release by hand: where an axis does not hold the curves, one that does, with ticks at decades or round numbers.
function axisOf({ axis, area: [, top, , bottom] }, curves) {
  const { logarithmic } = axis, scaled = v => logarithmic ? Math.log10(v) : v;
  const drawn = [0, ...curves.flatMap(curve => [...curve])].map(scaled).filter(Number.isFinite);
  if (drawn.every(v => v >= scaled(axis.from) && v <= scaled(axis.to))) return axis;
  const high = mostOf(drawn), low = -mostOf(drawn.map(v => -v));
  const rough = Math.max((high - low) * 2.2 * picture.em / (bottom - top), 1e-12);
  const step = logarithmic ? Math.ceil(rough) : roundStep(rough), first = Math.floor(low / step);
  const ticks = Array.from({ length: Math.max(Math.ceil(high / step) - first, 1) + 1 }, (_, i) => (first + i) * step)
    .map(n => logarithmic ? [10 ** n, powerOfTen(n)] : [n, written(shortened(n, 6))]);
  return { ...axis, from: ticks[0][0], to: ticks.at(-1)[0], ticks };
}
// The ticks of such an axis, over the film's.
function drawAxis({ area: [left, top, right, bottom], left: outside }, axis) {
  const em = picture.em, from = outside - 0.6 * em;
  box(left, top, right - left, bottom - top, 0, theme.background);
  box(from, top - 0.6 * em, left - from, bottom - top + 1.2 * em, 0, theme.background);
  for (const [v, words] of axis.ticks) {
    const y = along(axis, v);
    box(left, y, right - left, Math.max(1, picture.grid), 0, theme.grid);
    text(words, [left - 0.55 * em, y + 0.36 * em], em, "right", 400, theme.quiet_text);
  }
}

function verticalLine(x, top, bottom, color) {
  const width = Math.max(1, Math.round(picture.mark));
  if (picture.mark > 0) box(Math.round(x - width / 2), top, width, bottom - top, 0, color);
}
function dashedLine({ area: [, top, , bottom], time }, at) {
  for (let y = top; y < bottom; y += 10 * picture.text)
    verticalLine(along(time, at), y, Math.min(y + 5 * picture.text, bottom), theme.quiet_text);
}
// Of a release by hand, the text of the divergence beside its line.
function divergenceMark({ area: [left, , right, bottom], time }, since) {
  const words = `diverged at ${since.toFixed(1)} s`, size = picture.font, x = along(time, since), gap = 10 * picture.text;
  text("", [0, 0], size, "left", 400, theme.text);  // sets the font that is measured
  const { width } = g.measureText(words), from = x + gap + width < right ? x + gap : x - gap - width;
  return ["text", words, [Math.max(from, left), bottom - 0.45 * size], size, "left", 400, theme.text, width];
}
const drawHead = (at, color) => disc(at, Math.max(2.3 * picture.trace, 2), color);

const kindOfPair = (strips.find(strip => strip.kind === "distance") ?? strips[0])?.kind;
function drawStrip(strip) {
  const { isStill, since } = motion, { kind, pens, area } = strip, curves = motion.curves[kind];
  if (strip.drawn?.motion !== motion)
    strip.drawn = { motion, axis: motion === original ? strip.axis : axisOf(strip, curves) };
  const { axis } = strip.drawn, at = t => along(strip.time, t);
  if (axis.ticks) drawAxis(strip, axis);
  const now = value(curves[0]), last = isStill ? film.samples : sampleNow(), x = at(time);
  if (strip.value && !isStill && !Number.isNaN(now))
    drawLabel(strip.value, kind === "distance" ? scientific(now) : written(now.toFixed(2)));
  const hasDiverged = kind === kindOfPair && (isStill ? since >= 0 : time >= since + 1 - 1e-6);
  if (hasDiverged) dashedLine(strip, since);
  verticalLine(x, area[1], area[3], theme.cursor);
  const released = hasDiverged ? [divergenceMark(strip, since)] : [];
  const marks = motion === original ? strip.marks[Number(hasDiverged)] : released, room = 4 * picture.text;
  for (const [, , [from, foot], size, , , , width] of film.transparent ? [] : marks)
    box(from - room, foot - 0.9 * size, width + 2 * room, 1.18 * size, 0, faded(theme.background, 0.85));
  for (const [c, list] of picture.trace > 0 ? curves.entries() : []) {
    const [color, width] = pens[c];
    const points = Array.from(list.subarray(0, last + 1), (v, i) => [at(i * film.sample_s), along(axis, v)]);
    if (!isStill) points.push([x, along(axis, value(list))]);
    clipped(area, width, () => stroke(color, width, () => polyline(points)));
    if (curves.length === 1 && !isStill && isIn(points.at(-1), area)) drawHead(points.at(-1), color);
  }
  drawAll(marks);
}

// Rates over angles: paths, or the points at which θ1 passes a whole number of turns upwards.
function drawPhase({ area, angle, rate }) {
  const turn = 2 * Math.PI, wrapped = a => a - turn * Math.round(a / turn);
  const at = ([a, w]) => [along(angle, wrapped(a) * degrees), along(rate, w * degrees)];
  for (const k of [1, 0]) {
    const [angles, rates, first] = motion.curves.phase.slice(3 * k), { color } = bodies[k];
    for (let i = 1; i <= sampleNow() && film.phase.kind === "section"; ++i) {
      const whole = turn * Math.floor(first[i] / turn), share = (whole - first[i - 1]) / (first[i] - first[i - 1]);
      const passed = [angles, rates].map(list => list[i - 1] + share * (list[i] - list[i - 1]));
      if (share > 0 && share <= 1) disc(at(passed), 1.2 * picture.trace, faded(color, 0.8));
    }
    if (film.phase.kind === "section") continue;
    drawTrail(at, [angles, rates], picture.trail, color, (area[2] - area[0]) / 2);
    drawHead(at([angles, rates].map(value)), color);
  }
}

// Of a release by hand the angles above the pendulums, and another number in which they differ, in place of the film's
// words; of an ensemble those of the first and the last one, and the colours between them.
function drawWords() {
  if (motion === original) return drawAll(picture.words);
  if (shows("title") && picture.words.length) drawLabel(picture.words[0], "Released anew");
  const [what, unit] = form.key.selectedOptions[0].text.split(", "), isAngle = unit === "°";
  const values = motion.of.map(numbersOf), differing = values.map(lists => lists.flat()[form.key.selectedIndex]);
  const apart = Math.abs(differing[0] / (differing.at(-1) - differing[0] || 1));
  const digits = clamp(Math.ceil(Math.log10(apart)) + 1, 8, 16), rounded = v => written(shortened(v, digits));
  for (const { area: [left, top, right], shown } of picture.panels) {
    const at = share => left + share * (right - left), base = top - 12 * picture.text, size = picture.font;
    (isEnsemble ? [0, bodies.length - 1] : shown).forEach((k, i, all) => {
      const words = isAngle || !isEnsemble ? values[k][0].map(angle => `${rounded(angle)}°`) : [];
      if (!isAngle) words.push(`${what} = ${rounded(differing[k])} ${unit}`);
      text(words.join("   "), [at(i), base], size, i ? "right" : "left", 700, bodies[k].color,
        (isEnsemble ? at(0.4) : at(1 / all.length)) - left - size);
    });
    if (!isEnsemble) continue;
    const colors = g.createLinearGradient(at(0.4), 0, at(0.6), 0);
    bodies.forEach(({ color }, k, { length }) => colors.addColorStop(k / (length - 1), color));
    fill(colors, () => g.rect(at(0.4), base - 0.6 * size, at(0.2) - left, 0.6 * size));
  }
}

function draw() {
  const [width, height] = picture.size, scale = canvas.width / width;
  g.setTransform(scale, 0, 0, scale, 0, 0);
  g.clearRect(0, 0, width, height + 1);
  if (!film.transparent) box(0, 0, width, height, 0, theme.background);
  if (motion === original) drawAll(picture.marks);
  drawAll(picture.backdrop);
  if (!motion) return;
  const poses = posesNow();
  drawWords();
  for (const panel of picture.panels) clipped(panel.area, 0, () => drawPanel(panel, poses));
  if (picture.phase && !motion.isStill) clipped(picture.phase.area, 0, () => drawPhase(picture.phase));
  if (motion.curves) picture.strips.forEach(drawStrip);
  if (picture.clock) drawLabel(picture.clock, `${time.toFixed(film.decimals)} s`);
  if (picture.speed) drawLabel(picture.speed, speedAt(time)[2]);
}

// The picture that fits the page: the upright one into upright pages, the small one where letters of the film's own
// would have less than 9 px. Where those of the small or the upright one would, it scrolls.
function resize() {
  const { width, height } = canvas.parentElement.getBoundingClientRect(), [own, upright, small] = film.pictures;
  const isUpright = Math.max(height / width, innerHeight / innerWidth) > 1.2;
  const fits = of => {
    const sizes = of.words.concat(of.backdrop).map(([kind, , , size]) => kind === "text" ? size : of.em);
    return Math.min(width / of.size[0], height / of.size[1]) * Math.min(...sizes) / 9;
  };
  picture = (isUpright ? upright : fits(own) < 1 ? small : own) ?? own;
  const [w, h] = picture.size, scale = Math.min(width / w, height / h) / Math.min(fits(picture), 1);
  Object.assign(canvas.style, { width: `${scale * w}px`, height: `${scale * h}px` });
  setSize(canvas, scale * w, scale * h);
  draw();
}
