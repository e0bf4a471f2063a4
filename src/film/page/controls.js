// controls.js: time, and releases by hand.
"use strict";
const $ = selector => document.querySelector(selector), form = $("#release");
const say = words => { $("#status").textContent = words; }, shortened = v => Number(v.toPrecision(8));

// Time

let isPlaying = false, lastFrame = 0;
function seek(to) {
  time = clamp(to, 0, film.duration_s);
  $("#time").value = time;
  $("#now").value = `${time.toFixed(2)} s`;
  const distance = motion?.distance?.[sampleNow()];
  $("#time").setAttribute("aria-valuetext", `${time.toFixed(2)} seconds` + (distance >= 0 ? `, distance ${scientific(distance)}` : ""));
  draw();
}
function advance(now) {
  if (!isPlaying) return;
  const by = Math.min((now - lastFrame) / 1000, 0.1) * Number($("#speed").value) * speedAt(time)[1];
  lastFrame = now;
  if (time + by < film.duration_s) seek(time + by);
  else if ($("#loop").checked) seek(0);
  else seek(film.duration_s), play(false);
  requestAnimationFrame(advance);
}
function play(on) {
  if (!motion || motion.isStill || on === isPlaying) return;
  if (on && time >= film.duration_s) seek(0);
  isPlaying = on;
  $("#play").textContent = on ? "❚❚" : "▶";
  if (!on) return keepAddress();
  lastFrame = performance.now();
  requestAnimationFrame(advance);
}
function go(by) {
  play(false);
  seek(time + by);
  keepAddress();
}
function keepAddress() {
  try { history.replaceState(null, "", `#t=${shortened(time)}`); } catch { /* a frame that has no address */ }
}
function timeOfAddress() {
  const t = new URLSearchParams(location.hash.slice(1)).get("t");
  return t !== null && Number.isFinite(Number(t)) ? Number(t) : null;
}

// Releases by hand: the numbers of the first pendulum, angles in degrees, and by how much the last one's differs in one of them

const names = ["angle", "mass", "length"], unitOf = { angle: "°", mass: "kg", length: "m", gravity: "m/s²" };
let byHand = null;
function releaseOfFilm() {
  const [first, last] = [bodies[0].chain, bodies.at(-1).chain], made = { ...structuredClone(first), key: "angle0", by: 0 };
  for (const name of names) {
    const unit = name === "angle" ? degrees : 1;
    made[name] = first[name].map(v => Number((v * unit).toPrecision(12)));
    first[name].forEach((v, i) => { if (v !== last[name][i]) made.key = name + i, made.by = Number(((last[name][i] - v) * unit).toPrecision(6)); });
  }
  if (first.gravity !== last.gravity) made.key = "gravity", made.by = shortened(last.gravity - first.gravity);
  return made;
}
function chainsOfRelease() {
  const steps = Math.ceil(4000 * film.sample_s);
  return bodies.map((_, k) => {
    const more = key => key === byHand.key && k > 0 ? byHand.by * k / (bodies.length - 1) : 0;
    const [angle, mass, length] = names.map(name => byHand[name].map((v, i) => v + more(name + i)));
    return { angle: angle.map(a => a / degrees), mass, length, rate: byHand.rate, gravity: byHand.gravity + more("gravity"), method: "rk4", step: film.sample_s / steps, steps };
  });
}
// Shows how the pendulums start, and with it, once they are known, the curves of the new motion; then plays it.
function releaseAnew(playsThen) {
  const of = chainsOfRelease();
  if (of.some(chain => [...chain.mass, ...chain.length].some(v => !(v > 0)))) return say("masses and lengths must be greater than 0");
  play(false);
  const { curves, since } = motion ?? {};
  motion = { ...motionOf(of, of.map(chain => Float64Array.from([...chain.angle, ...chain.rate]))), curves, since, isStill: true };
  seek(0);
  compute(of, made => {
    if (!motion.isStill) return;
    say(`Runge–Kutta 4, steps of 1/${Math.round(1 / of[0].step)} s; energy drift ${scientific(made.drift)} of the potential range`);
    motion = held?.bob ? { ...motion, curves: made.curves, since: made.since } : made;
    if (playsThen) play(true);
    draw();
  }, say);
}
function backToFilm() {
  play(false);
  motion = original;
  byHand = releaseOfFilm();
  fillForm();
  say("");
  draw();
}
function presetOfRelease() {
  const list = (values, unit = 1) => `[${values.map(v => Number((v * unit).toPrecision(14))).join(", ")}]`;
  const keysOf = chain => ({ mass_kg: list(chain.mass), length_m: list(chain.length), angle_deg: list(chain.angle, degrees),
    omega_deg_per_s: list(chain.rate, degrees), gravity_m_per_s2: chain.gravity });
  const of = chainsOfRelease(), [a, b] = [of[0], of.at(-1)].map(keysOf), lines = (keys, some) => some.map(key => `${key} = ${keys[key]}`);
  const differing = Object.keys(a).filter(key => a[key] !== b[key]);
  return ['title = "Released anew"', "", "[scene]", 'kind = "pair"', `duration_s = ${film.duration_s}`, `sample_hz = ${shortened(1 / film.sample_s)}`, "",
    "[system]", `links = ${of[0].mass.length}`, ...lines(a, Object.keys(a)), 'integrator = "rk4"', `step_s = "1/${Math.round(1 / of[0].step)}"`,
    ...(differing.length ? ["", "[b]", ...lines(b, differing)] : []), "", "[video]", `layout = "${layout}"`, ...(isEnsemble ? [`members = ${of.length}`] : []), ""].join("\n");
}

function makeForm() {
  const element = (tag, more, ...inner) => { const made = Object.assign(document.createElement(tag), more); made.append(...inner); return made; };
  const labelOf = (name, i) => `${name} ${i + 1}, ${unitOf[name]}`;
  form.querySelector("tr").append(...names.map(name => element("th", {}, `${name}, ${unitOf[name]}`)));
  byHand.mass.forEach((_, i) => form.querySelector("table").append(element("tr", {}, element("th", {}, String(i + 1)),
    ...names.map(name => element("td", {}, element("input", { type: "number", step: "any", name: name + i, ariaLabel: labelOf(name, i) }))))));
  form.key.append(...names.flatMap(name => byHand[name].map((_, i) => new Option(labelOf(name, i), name + i))), new Option("gravity, m/s²", "gravity"));
  form.by.parentElement.hidden = isSingle;
  form.addEventListener("input", ({ target }) => {
    const [, name, link] = /^([a-z]+)(\d*)$/.exec(target.name), number = target === form.key ? target.value : target.valueAsNumber;
    if (Number.isNaN(number)) return;
    if (link) byHand[name][link] = number;
    else byHand[name] = number;
    releaseAnew(false);
  });
  form.addEventListener("submit", event => event.preventDefault());
  $("#back").addEventListener("click", backToFilm);
  $("#copy").addEventListener("click", () => {
    const area = form.querySelector("textarea");
    area.value = presetOfRelease();
    area.hidden = false;
    area.select();
    navigator.clipboard?.writeText(area.value).then(() => say("copied; save it as NAME.toml, and run: doppel render NAME.toml"), () => {});
  });
  fillForm();
}
function fillForm() {
  for (const input of form.querySelectorAll("[name]")) {
    const [, name, link] = /^([a-z]+)(\d*)$/.exec(input.name);
    if (input !== document.activeElement) input.value = link ? shortened(byHand[name][link]) : byHand[name];
  }
}

// Pointers: a bob is dragged, a strip sets the time, any other place plays or pauses

const placeOf = event => [event.offsetX, event.offsetY].map(c => c * picture.size[0] / canvas.clientWidth);
const isIn = ([x, y], [left, top, right, bottom]) => x >= left && x <= right && y >= top && y <= bottom;
const angleOf = (from, to) => Math.atan2(to[0] - from[0], to[1] - from[1]) * degrees;  // from straight down
let held = null;
function bobAt(place, reach) {
  const panel = isLive && motion ? picture.panels.find(panel => isIn(place, panel.area)) : null;
  if (!panel) return null;
  const poses = posesNow(), at = viewOf(panel, poses), k = isEnsemble ? 0 : panel.sides[0];
  const bobs = [at([0, 0]), ...poses[k].bobs.map(at)], far = bobs.map(bob => Math.hypot(bob[0] - place[0], bob[1] - place[1]));
  const link = far.indexOf(Math.min(...far.slice(1)), 1) - 1;
  return far[link + 1] < picture.bob + reach * picture.size[0] / canvas.clientWidth ? { panel, k, link, bobs } : null;
}
function move(event) {
  const place = placeOf(event);
  if (!held) canvas.style.cursor = bobAt(place, 10) ? "grab" : "";
  if (held?.strip) seek((place[0] - held.strip.time[2]) / (held.strip.time[3] - held.strip.time[2]) * film.duration_s);
  if (!held?.bob) return;
  const { panel, k, link } = held.bob, poses = posesNow(), at = viewOf(panel, poses);
  const angle = angleOf(at(link > 0 ? poses[k].bobs[link - 1] : [0, 0]), place);
  const more = k > 0 && byHand.key === `angle${link}` ? byHand.by : 0;
  byHand.angle[link] = Number(((event.shiftKey ? Math.round(angle) : Number(angle.toFixed(3))) - more).toPrecision(12));
  fillForm();
  releaseAnew(false);
}
canvas.addEventListener("pointerdown", event => {
  const place = placeOf(event), bob = bobAt(place, event.pointerType === "touch" ? 24 : 10);
  canvas.setPointerCapture(event.pointerId);
  held = bob ? { bob } : { strip: picture.strips.find(strip => isIn(place, strip.area)) };
  if (bob || held.strip) play(false);
  if (!bob) return move(event);
  // at rest as they are seen
  byHand.angle = bob.bobs.slice(1).map((at, i) => Number(angleOf(bob.bobs[i], at).toFixed(3)));
  if (bob.k > 0 && byHand.key.startsWith("angle")) byHand.angle[byHand.key.slice(5)] -= byHand.by;
  byHand.rate = byHand.rate.map(() => 0);
  releaseAnew(false);
});
canvas.addEventListener("pointermove", move);
canvas.addEventListener("pointerup", () => {
  const { bob, strip } = held ?? {};
  held = null;
  if (bob) releaseAnew(true);
  else if (strip) keepAddress();
  else play(!isPlaying);
});
canvas.addEventListener("pointercancel", () => { held = null; });

const keys = {
  " ": () => play(!isPlaying), "ArrowLeft": event => go(event.shiftKey ? -1 : -speedAt(time)[1] / film.fps),
  "ArrowRight": event => go(event.shiftKey ? 1 : speedAt(time)[1] / film.fps), "Home": () => go(-time), "End": () => go(film.duration_s)
};
addEventListener("keydown", event => {
  if (event.target.matches("input, select, textarea, button") || event.ctrlKey || event.metaKey || !keys[event.key]) return;
  event.preventDefault();
  keys[event.key](event);
});
$("#play").addEventListener("click", () => play(!isPlaying));
$("#time").addEventListener("input", event => { play(false); seek(event.target.valueAsNumber); });
$("#time").addEventListener("change", keepAddress);
$("#open").addEventListener("click", ({ target }) => {
  form.hidden = !form.hidden;
  target.ariaExpanded = !form.hidden;
  resize();
});
addEventListener("resize", resize);
addEventListener("beforeprint", () => { play(false); seek(film.start_s); });
addEventListener("hashchange", () => { if (timeOfAddress() !== null) seek(timeOfAddress()); });

// The player of a figure is hidden until a place of the figure is chosen: angles in degrees by their keys.
function waitForRelease() {
  $("#back").hidden = true;
  $("#close").hidden = false;
  $("#close").addEventListener("click", () => { play(false); $(".player").hidden = true; });
  document.addEventListener("release", ({ detail }) => {
    byHand = releaseOfFilm();
    for (const [key, angle] of Object.entries(detail)) {
      const link = /\[(\d)\]$/.exec(key)?.[1];
      byHand.angle = byHand.angle.map((v, i) => link === undefined || Number(link) === i ? angle : v);
    }
    $(".player").hidden = false;
    fillForm();
    resize();
    releaseAnew(true);
  });
}

// The start: at the time of the address, or by itself where the reader has not asked for less motion.
async function startFilm() {
  for (const [name, color] of Object.entries({ page: film.transparent ? "transparent" : theme.background, card: theme.panel, text: theme.text,
    quiet: theme.quiet_text, line: theme.frame })) $(".player").style.setProperty(`--${name}`, color);
  canvas.ariaLabel = `${film.title}. ${$("header p").textContent}`;
  $("#time").max = film.duration_s;
  $("#open").hidden = !isLive;
  if (isLive) byHand = releaseOfFilm(), makeForm();
  if (pageData.film) return waitForRelease();
  $(".player").hidden = false;
  resize();
  const begin = made => {
    motion = original = made;
    say(isLive ? "Drag a bob to release the pendulums anew." : "This film only plays: the page cannot compute its motion.");
    seek(timeOfAddress() ?? film.start_s);
    if (timeOfAddress() === null && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
  };
  const embedded = await embeddedCurves();
  if (film.motion) begin(withCurves({ pendulums: await embeddedPlaces(film.motion) }, {}, embedded));
  else compute(bodies.map(body => body.chain), begin, say, embedded);
}
startFilm();
