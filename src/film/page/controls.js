// controls.js: time, and releases by hand.
"use strict";
const form = $("#release"), say = words => { $("#status").textContent = words; };
const isOfFigure = pageData.panels !== undefined, shortened = (v, digits = 12) => Number(v.toPrecision(digits));

// Time

let isPlaying = false, lastFrame = 0;
function seek(to) {
  time = clamp(to, 0, film.duration_s);
  const distance = motion?.distance?.[sampleNow()], seconds = time.toFixed(2);
  Object.assign($("#time"), { value: time,
    ariaValueText: `${seconds} seconds` + (distance >= 0 ? `, distance ${scientific(distance)}` : "") });
  $("#now").value = `${seconds} s`;
  draw();
}
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
const keepTime = () => keepAddress({ t: shortened(time, 8) });
const stepFor = (event, by) => go(time + by * (event.shiftKey ? 1 : speedAt(time)[1] / film.fps));

// Releases by hand. The form has the numbers of the first pendulum, and by how much the last one differs in one of them.

const quantities = [
  { name: "angle", key: "angle_deg", unit: "°", per: degrees }, { name: "rate", key: "omega_deg_per_s", unit: "°/s", per: degrees },
  { name: "mass", key: "mass_kg", unit: "kg", per: 1 }, { name: "length", key: "length_m", unit: "m", per: 1 },
  { name: "gravity", key: "gravity_m_per_s2", unit: "m/s²", per: 1 }
];
const numbersOf = (chain, { name, per }) => [chain[name]].flat().map(v => v * per);
const numberIn = field => form[field].valueAsNumber;
function makeForm() {
  for (const quantity of isLive ? quantities : []) {
    const { name, unit } = quantity, inputs = numbersOf(bodies[0].chain, quantity).map((_, i, { length }) => element("input",
      { type: "number", step: "any", name: name + i, ariaLabel: `${name}${length > 1 ? ` ${i + 1}` : ""}, ${unit}` }));
    $("#numbers").append(element("p", {}, `${name}, ${unit}`, ...inputs));
    form.key.append(...inputs.map(input => new Option(input.ariaLabel, input.name)));
  }
  form.by.parentElement.hidden = layout === "single";
}
function fillForm() {
  form.by.value = 0;
  for (const quantity of quantities) {
    const [first, last] = [bodies[0], bodies.at(-1)].map(({ chain }) => numbersOf(chain, quantity));
    first.forEach((number, i) => {
      form[quantity.name + i].value = shortened(number);
      if (number !== last[i]) form.key.value = quantity.name + i, form.by.value = shortened(last[i] - number, 6);
    });
  }
}
function chainOfForm(k) {
  const steps = Math.ceil(4000 * film.sample_s), chain = { method: "rk4", step: film.sample_s / steps, steps };
  const more = field => field === form.key.value && k > 0 ? numberIn("by") * k / (bodies.length - 1) : 0;
  for (const { name, per } of quantities)
    chain[name] = [...form.querySelectorAll(`[name^=${name}]`)].map(input => (input.valueAsNumber + more(input.name)) / per);
  return { ...chain, gravity: chain.gravity[0] };
}
// Shows how the pendulums start, and with it, once they are known, the curves of the new motion; then plays it.
function releaseAnew(playsThen) {
  const of = bodies.map((_, k) => chainOfForm(k)), { curves, since } = motion ?? {};
  if (of.some(chain => quantities.some(quantity => numbersOf(chain, quantity).some(Number.isNaN)))) return;
  if (of.some(({ mass, length }) => Math.min(...mass, ...length) <= 0)) return say("masses and lengths must be greater than 0");
  play(false);
  motion = { ...motionOf(of, of.map(({ angle, rate }) => [...angle, ...rate])), curves, since, isStill: true };
  seek(0);
  compute(of, async made => {
    if (!motion.isStill) return;
    await withCurves(made);
    const steps = `Runge–Kutta 4, steps of 1/${Math.round(1 / of[0].step)} s`;
    say(`${steps}; energy drift ${scientific(made.drift)} of the potential range`);
    motion = held?.bob ? { ...motion, curves: made.curves, since: made.since } : made;
    if (playsThen) play(true);
    draw();
  });
}
function backToFilm() {
  play(false);
  motion = original;
  fillForm();
  say("");
  draw();
}
function presetOfForm() {
  const [a, b] = [0, bodies.length - 1].map(k => quantities.map(quantity => {
    const list = numbersOf(chainOfForm(k), quantity).map(v => shortened(v, 14)).join(", ");
    return `${quantity.key} = ${quantity.name === "gravity" ? list : `[${list}]`}`;
  }));
  const { angle, step } = chainOfForm(0), differing = b.filter(line => !a.includes(line));
  return ['title = "Released anew"', "", "[scene]", 'kind = "pair"', `duration_s = ${film.duration_s}`,
    `sample_hz = ${shortened(1 / film.sample_s, 8)}`, "", "[system]", `links = ${angle.length}`, ...a, 'integrator = "rk4"',
    `step_s = "1/${Math.round(1 / step)}"`, "", ...(differing.length ? ["[b]", ...differing, ""] : []),
    "[video]", `layout = "${layout}"`, ...(isEnsemble ? [`members = ${bodies.length}`] : []), ""].join("\n");
}

// Pointers: a bob is dragged, a strip sets the time, any other place plays or pauses.

const pixelOfPage = () => picture.size[0] / canvas.clientWidth;
const placeOf = event => [event.offsetX, event.offsetY].map(c => c * pixelOfPage());
const isIn = ([x, y], [left, top, right, bottom]) => x >= left && x <= right && y >= top && y <= bottom;
const angleOf = (from, to) => Math.atan2(to[0] - from[0], to[1] - from[1]) * degrees;  // from straight down
let held = null;
// The bob nearest to a place, and the bobs of its pendulum from the pivot on, px.
function bobAt(place, reach) {
  const panel = isLive && motion ? picture.panels.find(panel => isIn(place, panel.area)) : null;
  if (!panel) return null;
  const poses = posesNow(), at = viewOf(panel, poses), k = panel.shown[0], bobs = [at([0, 0]), ...poses[k].bobs.map(at)];
  const far = bobs.map(([x, y]) => Math.hypot(x - place[0], y - place[1])), bob = far.indexOf(Math.min(...far.slice(1)), 1);
  return far[bob] < picture.bob + reach * pixelOfPage() ? { panel, k, bob, bobs } : null;
}
function setAngle(k, link, angle) {
  form[`angle${link}`].value = shortened(angle - (k > 0 && form.key.value === `angle${link}` ? numberIn("by") : 0));
}
canvas.onpointerdown = event => {
  const place = placeOf(event), bob = bobAt(place, event.pointerType === "touch" ? 24 : 10);
  canvas.setPointerCapture(event.pointerId);
  held = bob ?? { strip: picture.strips.find(strip => isIn(place, strip.area)) };
  if (bob || held.strip) play(false);
  if (!bob) return canvas.onpointermove(event);
  // at rest as they are seen
  bob.bobs.slice(1).forEach((at, i) => setAngle(bob.k, i, Number(angleOf(bob.bobs[i], at).toFixed(3))));
  for (const input of form.querySelectorAll("[name^=rate]")) input.value = 0;
  releaseAnew(false);
};
canvas.onpointermove = event => {
  const place = placeOf(event), { strip, bob, panel, k } = held ?? {};
  if (!held) canvas.style.cursor = bobAt(place, 10) ? "grab" : "";
  if (strip) seek(shareAt(strip.time, place[0]) * film.duration_s);
  if (!bob) return;
  const poses = posesNow(), at = viewOf(panel, poses), angle = angleOf(at(bob > 1 ? poses[k].bobs[bob - 2] : [0, 0]), place);
  setAngle(k, bob - 1, Number(angle.toFixed(event.shiftKey ? 0 : 3)));
  releaseAnew(false);
};
canvas.onpointerup = () => {
  const { bob, strip } = held ?? {};
  held = null;
  if (bob) releaseAnew(true);
  else if (strip) keepTime();
  else play(!isPlaying);
};
canvas.onpointercancel = () => { held = null; };

// Controls

onKeys({ " ": () => play(!isPlaying), ArrowLeft: event => stepFor(event, -1), ArrowRight: event => stepFor(event, 1),
  Home: () => go(0), End: () => go(film.duration_s) });
const clicks = {
  play: () => play(!isPlaying),
  close: () => { play(false); $(".player").hidden = true; },
  open: ({ target }) => {
    form.hidden = !form.hidden;
    target.ariaExpanded = !form.hidden;
    resize();
  },
  back: backToFilm,
  copy: () => {
    const area = $("#preset");
    Object.assign(area, { value: presetOfForm(), hidden: false }).select();
    navigator.clipboard?.writeText(area.value).then(() => say("copied; save it as NAME.toml, and run: doppel render NAME.toml"), () => {});
  }
};
for (const [name, action] of Object.entries(clicks)) $(`#${name}`).onclick = action;
$("#time").oninput = ({ target }) => { play(false); seek(target.valueAsNumber); };
$("#time").onchange = keepTime;
form.oninput = () => releaseAnew(false);
form.onsubmit = () => false;
addEventListener("resize", resize);
addEventListener("beforeprint", () => { play(false); seek(film.start_s); });
addEventListener("hashchange", () => seek(addressNumbers().t ?? time));

// The player of a figure is hidden until a place of the figure is chosen: angles in degrees by their keys.
function releaseAt(angles) {
  fillForm();
  for (const [key, angle] of Object.entries(angles)) {
    const link = /\[(\d)\]$/.exec(key)?.[1] ?? "";
    for (const input of form.querySelectorAll(`[name^=angle${link}]`)) input.value = angle;
  }
  $(".player").hidden = false;
  resize();
  releaseAnew(true);
}

// The start: at the time of the address, or by itself where the reader has not asked for less motion.
async function begin(made) {
  motion = original = await withCurves(made, true);
  say(isLive ? "Drag a bob to release the pendulums anew." : "This film only plays: the page cannot compute its motion.");
  const { t } = addressNumbers();
  seek(t ?? film.start_s);
  if (t === undefined && !matchMedia("(prefers-reduced-motion: reduce)").matches) play(true);
}
for (const [name, color] of Object.entries(theme)) $(".player").style.setProperty(`--${name}`, color);
if (film.transparent) $(".player").style.background = "none";
canvas.ariaLabel = `${film.title}. ${$("header p").textContent}`;
$("#time").max = film.duration_s;
$("#open").hidden = !isLive;
$("#back").hidden = $(".player").hidden = isOfFigure;
$("#close").hidden = !isOfFigure;
makeForm();
if (!isOfFigure) {
  if (isLive) fillForm();
  resize();
  if (film.motion) embeddedMotion(film.motion).then(begin);
  else compute(bodies.map(body => body.chain), begin);
}
