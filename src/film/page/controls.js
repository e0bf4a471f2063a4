// controls.js: time, and releases by hand.
"use strict";
const form = $("#release"), say = words => { $("#status").textContent = words; };
const isOfFigure = pageData.panels !== undefined;

// Time

let isPlaying = false, lastFrame = 0;
function seek(to) {
  time = motion?.isStill ? 0 : clamp(to, 0, film.duration_s);
  const distance = motion?.curves?.distance?.[0][sampleNow()];
  const told = distance >= 0 ? `, distance ${scientific(distance)}` : "";
  $("#time").value = time;
  $("#time").setAttribute("aria-valuetext", `${time.toFixed(2)} seconds${told}`);
  $("#now").value = `${time.toFixed(2)} s`;
  draw();
}
const keepTime = () => keepAddress({ t: shortened(time, 8) });
function advance(now) {
  if (!isPlaying) return;
  const next = time + Math.min((now - lastFrame) / 1000, 0.1) * Number($("#speed").value) * speedAt(time)[1];
  lastFrame = now;
  seek(next >= film.duration_s && $("#loop").checked ? 0 : next);
  if (time >= film.duration_s) play(false);
  requestAnimationFrame(advance);
}
function play(on) {
  if (!motion || motion.isStill || on === isPlaying) return;
  if (on && time >= film.duration_s) seek(0);
  isPlaying = on;
  $("#play").textContent = on ? "❚❚" : "▶";
  if (!on) return keepTime();
  lastFrame = performance.now();
  requestAnimationFrame(advance);
}
function go(to) {
  play(false);
  seek(to);
  keepTime();
}
const goBy = frames => ({ shiftKey }) => {
  const frame = speedAt(time)[1] / film.fps, isEven = film.speed.length === 1 && !shiftKey;
  go(isEven ? frame * (Math.round(time / frame) + frames) : time + frames * (shiftKey ? 1 : frame));
};

// Releases by hand. The form has the numbers of the first pendulum; the last one differs in one of them.

const quantities = [["angle", "angle_deg", "°", degrees], ["rate", "omega_deg_per_s", "°/s", degrees],
  ["mass", "mass_kg", "kg", 1], ["length", "length_m", "m", 1], ["gravity", "gravity_m_per_s2", "m/s²", 1]];
const steps = Math.ceil(4000 * film.sample_s);  // in a sample
let isFilmInForm = true;                        // whether its pendulums differ as the form says
const numbersOf = chain => quantities.map(([name, , , per]) => [chain[name]].flat().map(v => v * per));
const inputsOf = name => [...form.querySelectorAll(`[name^=${name}]`)];
// The difference of two numbers that were rounded: the shortest decimal that gives the second one, of at most 6 digits.
const decimalBetween = (a, b) => [1, 2, 3, 4, 5, 6].map(digits => shortened(b - a, digits))
  .find((by, i) => i === 5 || Math.abs(a + by - b) <= 4e-16 * Math.abs(b));
// With the film's numbers, also after form.reset().
function makeForm() {
  const all = bodies.map(body => numbersOf(body.chain)), first = all[0], last = all.at(-1);
  quantities.forEach(([name, , unit], q) => {
    const row = element("p", {}, `${name}, ${unit}`);
    first[q].forEach((number, i) => {
      const label = `${name}${first[q].length > 1 ? ` ${i + 1}` : ""}, ${unit}`, value = shortened(number);
      const attributes = { name: name + i, type: "number", step: "any", required: "", "aria-label": label, value };
      row.append(element("input", attributes));
      form.key.append(new Option(label, name + i, number !== last[q][i]));
      if (number !== last[q][i]) form.by.defaultValue = decimalBetween(number, last[q][i]);
    });
    $("#numbers").append(row);
  });
  form.by.parentElement.hidden = layout === "single";
  form.reset();
  isFilmInForm = all.every((lists, k) => {
    const found = numbersOfForm(k).flat(), near = v => 1e-12 * Math.max(1, v) + 1e-6 * Math.abs(form.by.value);
    return lists.flat().every((v, i) => Math.abs(v - found[i]) <= near(Math.abs(v)));
  });
}
const differenceIn = (name, k) =>
  name === form.key.value && k > 0 ? form.by.valueAsNumber * k / (bodies.length - 1) : 0;
const numbersOfForm = k => quantities.map(([name]) =>
  inputsOf(name).map(input => input.valueAsNumber + differenceIn(input.name, k)));
function chainOfForm(k) {
  const [angle, rate, mass, length, [gravity]] = numbersOfForm(k).map((list, q) => list.map(v => v / quantities[q][3]));
  return { angle, rate, mass, length, gravity, method: "rk4", step: film.sample_s / steps, steps };
}
// Why there is no such motion; empty if there is one.
function faultOfForm() {
  const all = bodies.map((_, k) => numbersOfForm(k)), empty = form.querySelector("input:invalid");
  if (empty) return `${empty.ariaLabel} needs a number`;
  if (all.some(([, , ...positive]) => positive.flat().some(v => v <= 0)))
    return "masses, lengths and gravity must be greater than 0";
  if (layout !== "single" && String(all[0]) === String(all.at(-1))) return "the pendulums must differ";
  return all.some(([angles]) => angles.some(v => Math.abs(v) > 1e6)) ? "angles must be within 10⁶ degrees" : "";
}
// Shows how the pendulums start, and with it, once they are known, the curves of the new motion; then plays it.
async function releaseAnew(playsThen) {
  const of = bodies.map((_, k) => chainOfForm(k)), fault = faultOfForm();
  const { curves, since } = motion === original ? {} : motion;  // until those of this one are known
  if (fault) return say(fault);
  play(false);
  motion = { ...motionOf(of, of.map(({ angle, rate }) => [...angle, ...rate])), curves, since, isStill: true };
  seek(0);
  const made = await compute(of);
  if (!made || !motion.isStill) return;
  await withCurves(made);
  const isNewest = wanted === of;  // otherwise its curves are shown until those of the newest one are known
  motion = held?.bob || !isNewest ? { ...motion, curves: made.curves, since: made.since } : made;
  if (!isNewest) return draw();
  const drift = made.drift >= 0 ? `energy drift ${scientific(made.drift)} of the potential range`
    : "the motion is too fast for it and is not finite";
  const single = !isFilmInForm ? "; the pendulums differ in one number now" : "";
  say(`Runge–Kutta 4, steps of 1/${Math.round(1 / of[0].step)} s; ${drift}${single}`);
  if (playsThen && !held) play(true);
  draw();
}
// The film's preset with the numbers of the form.
function presetOfForm() {
  const [samples, seconds] = film.sample_hz, sections = film.preset.split(/^(?=\[)/m);
  const side = (name, k) => [`[${name}]`, `links = ${bodies[k].mass.length}`, ...numbersOfForm(k).map((list, q) => {
    const isClose = v => Math.abs(shortened(v, 15) - v) <= 1e-3 * Math.abs(form.by.valueAsNumber);
    const numbers = list.map(v => isClose(v) ? shortened(v, 15) : v).join(", ");
    return `${quantities[q][1]} = ${q === 4 ? numbers : `[${numbers}]`}`;
  }), 'integrator = "rk4"', `step_s = "${seconds}/${samples * steps}"`, "\n"].join("\n");
  return ['title = "Released anew"\n\n', ...sections.filter(section => section.startsWith("[scene]")), side("a", 0),
    ...(layout === "single" ? [] : [side("b", bodies.length - 1)]),
    ...sections.filter(section => section.startsWith("[video"))
  ].join("").replace(/^members = .*/m, `members = ${bodies.length}`);
}

// Pointers: a bob is dragged, a strip sets the time, any other place plays or pauses.

let held = null;
const scaleOfPage = () => picture.size[0] / canvas.clientWidth;
const placeOf = event => [event.offsetX, event.offsetY].map(c => c * scaleOfPage());
// The joints of the pendulum in front of a panel, px: the pivot and the bobs.
const jointsOf = (panel, poses = posesNow()) => [[0, 0], ...poses[panel.shown[0]].bobs].map(viewOf(panel, poses));
// The bob nearest to a place, and its panel.
function bobAt(place, reach) {
  const panel = isLive && motion ? picture.panels.find(({ area }) => isIn(place, area)) : null;
  if (!panel) return null;
  const far = jointsOf(panel).map(([x, y]) => Math.hypot(x - place[0], y - place[1]));
  const bob = far.indexOf(Math.min(...far.slice(1)), 1);
  return far[bob] < picture.bob + reach * scaleOfPage() ? { panel, bob } : null;
}
// Turns a link towards a place; its angle is counted from straight down.
function turnTo(link, from, to, k, digits = 3) {
  const angle = Number((Math.atan2(to[0] - from[0], to[1] - from[1]) * degrees).toFixed(digits));
  form[`angle${link}`].value = shortened(angle - differenceIn(`angle${link}`, k));
}
canvas.onpointerdown = event => {
  const place = placeOf(event), bob = bobAt(place, event.pointerType === "touch" ? 24 : 10);
  canvas.setPointerCapture(event.pointerId);
  held = { ...(bob ?? { strip: picture.strips.find(({ area }) => isIn(place, area)) }), place, plays: isPlaying };
  if (bob || held.strip) play(false);
  canvas.onpointermove(event);
};
canvas.onpointermove = event => {
  const place = placeOf(event), { strip, bob, panel } = held ?? {};
  if (!held) canvas.style.cursor = bobAt(place, 10) ? "grab" : "";
  if (strip) seek(shareAt(strip.time, place[0]) * film.duration_s);
  if (!bob || (!held.isDragged && Math.hypot(place[0] - held.place[0], place[1] - held.place[1]) < 2)) return;
  const joints = jointsOf(panel);  // at rest as they are seen
  for (let i = 1; i < joints.length && !held.isDragged; ++i) turnTo(i - 1, joints[i - 1], joints[i], panel.shown[0]);
  for (const input of held.isDragged ? [] : inputsOf("rate")) input.value = 0;
  held.isDragged = true;
  turnTo(bob - 1, joints[bob - 1], place, panel.shown[0], event.shiftKey ? 0 : 3);
  releaseAnew(false);
};
canvas.onpointerup = ({ type }) => {
  if (!held) return;
  const { isDragged, strip, plays } = held;
  held = null;
  if (isDragged) releaseAnew(true);
  else if (strip) keepTime();
  else play(type === "pointerup" ? !plays : plays);
};
canvas.onpointercancel = canvas.onpointerup;
canvas.ontouchstart = () => !held?.bob && !held?.strip;  // other touches scroll

// Controls

onKeys({ " ": () => play(!isPlaying), ArrowLeft: goBy(-1), ArrowRight: goBy(1), Home: () => go(0),
  End: () => go(film.duration_s) });
const clicks = {
  play: () => play(!isPlaying),
  close: () => { play(false); $(".player").hidden = true; },
  open: ({ target }) => {
    form.hidden = !form.hidden;
    target.ariaExpanded = !form.hidden;
    resize();
  },
  back: () => {
    play(false);
    wanted = null;
    motion = original;
    $("#preset").hidden = true;
    say("");
    draw();
  },
  copy: () => {
    if (motion !== original && faultOfForm()) return say(faultOfForm());
    const value = motion === original ? film.preset : presetOfForm();
    const area = Object.assign($("#preset"), { value, hidden: false });
    area.select();
    const tell = () => say("copied; save it as NAME.toml, and run: doppel render NAME.toml");
    navigator.clipboard?.writeText(area.value).then(tell, () => {});
  }
};
for (const [name, action] of Object.entries(clicks)) $(`#${name}`).onclick = action;
$("#time").oninput = ({ target }) => { play(false); seek(target.valueAsNumber); };
$("#time").onchange = keepTime;
form.oninput = () => releaseAnew(false);
form.onsubmit = () => false;
addEventListener("resize", resize);
addEventListener("beforeprint", () => { play(false); seek(film.poster_s ?? time); });
for (const after of ["afterprint", "hashchange"]) addEventListener(after, () => seek(addressNumbers().t ?? time));

// The player of a figure is hidden until a place of the figure is chosen: angles in degrees by their keys.
function releaseAt(angles) {
  form.reset();
  for (const [key, angle] of Object.entries(angles))
    for (const input of inputsOf(`angle${/\[(\d)\]$/.exec(key)?.[1] ?? ""}`)) input.value = angle;
  $(".player").hidden = false;
  resize();
  releaseAnew(true);
}

// The start: at the time of the address, or by itself where the reader has not asked for less motion.
async function startFilm() {
  $(".player").hidden = false;
  resize();
  const made = film.motion ? await embeddedMotion(film.motion) : await compute(bodies.map(body => body.chain));
  original = await withCurves(made, true);
  if (motion) return;  // released by the form before
  motion = original;
  say(isLive ? "Drag a bob to release the pendulums anew."
    : "This film only plays: the page cannot compute its motion.");
  const { t } = addressNumbers(), plays = t === undefined && !matchMedia("(prefers-reduced-motion: reduce)").matches;
  seek(t ?? (plays ? 0 : film.poster_s ?? 0));
  play(plays);
}
for (const [name, color] of Object.entries(theme)) $(".player").style.setProperty(`--${name}`, color);
if (film.transparent) $(".player").style.background = "none";
$(".player h1").textContent = film.title;
$(".player p").textContent = film.caption;
canvas.ariaLabel = `${film.title}. ${film.caption}`;
$("#time").max = film.duration_s;
$("#open").hidden = !isLive;
$("#back").hidden = isOfFigure;
$("#close").hidden = !isOfFigure;
if (isLive) makeForm();
if (!isOfFigure) startFilm();
