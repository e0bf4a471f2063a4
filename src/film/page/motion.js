// motion.js: what the page shows, from its data: places of bobs at all samples, and the curves of strips.
"use strict";
const { film } = pageData, { theme, bodies, layout } = film, { strips } = film.pictures[0];
const count = film.samples + 1, degrees = 180 / Math.PI;
// whether the pendulums can be released anew
const isLive = bodies.every(body => body.chain && body.mass.length === bodies[0].mass.length);
const sumOf = list => list.reduce((a, b) => a + b, 0), mostOf = list => list.reduce((a, b) => Math.max(a, b));
const numbers = of => Float64Array.from({ length: count }, (_, i) => of(i));  // one of each sample
const still = [numbers(() => 0), numbers(() => 0)];

// Words as src/film/page.cpp packs them: the lowest byte of all, then the next one …, of second differences plus 128.
async function unpacked(base64, wordBytes) {
  const bytes = new Uint8Array(await inflated(base64).arrayBuffer());
  const words = new Uint32Array(bytes.length / wordBytes).fill(-128);
  bytes.forEach((byte, i) => { words[i % words.length] += byte << 8 * Math.floor(i / words.length); });
  for (let order = 0; order < 2; ++order)
    words.forEach((_, i) => { if (i % count > 0) words[i] += words[i - 1]; });
  return words;
}

// The motion that the page holds: for each pendulum places [xs, ys] of its pivot and its bobs.
async function embeddedMotion({ bits, channels, words }) {
  const steps = await unpacked(words, bits > 16 ? 3 : 2), most = 2 ** bits - 1;
  const lists = channels.map(([low, step], c) => numbers(i => low + step * (steps[c * count + i] & most)));
  const next = () => lists.shift(), place = () => [next(), next()];
  return { curves: {}, pendulums: bodies.map(({ mass, length, moves }) => {
    const found = mass.map(length ? next : place), pivot = moves ? place() : still;
    return { pivot, bobs: length ? placesOf(found, length, pivot) : found };
  }) };
}
// Places of bobs from the angles of their links.
function placesOf(angles, length, pivot) {
  let [xs, ys] = pivot;
  return angles.map((list, b) => [xs, ys] =
    [list.map((a, i) => xs[i] + length[b] * Math.sin(a)), list.map((a, i) => ys[i] - length[b] * Math.cos(a))]);
}

// The motion of chains from their states, at one sample or all; with the curves that follow from states, by the kind of
// the strip; of a phase panel angles, rates and angles of the first link, of both pendulums.
function motionOf(of, states) {
  const links = of[0].mass.length, size = 2 * links, list = (k, from) => states[k].filter((_, i) => i % size === from);
  const pendulums = of.map(({ length }, k) =>
    ({ pivot: still, bobs: placesOf(length.map((_, b) => list(k, b)), length, still) }));
  if (states[0].length === size) return { of, pendulums };
  const sides = [...new Set([0, of.length - 1])].map(k => {
    const { mass, length, gravity } = of[k];
    const bobs = Array.from(still[0], (_, i) => chains.bobs(of[k], states[k], size * i));
    const lowest = gravity * sumOf(mass.map((m, i) => m * sumOf(length.slice(0, i + 1))));  // J, below zero
    const total = numbers(i => chains.energy(gravity, bobs[i])), kinetic = numbers(i => chains.energy(0, bobs[i]));
    const above = total.map(now => now + lowest), potential = above.map((now, i) => now - kinetic[i]);
    const inDegrees = first => length.map((_, b) => list(k, first + b).map(v => v * degrees));
    const phase = film.phase && [film.phase.link, links + film.phase.link, 0].map(i => list(k, i));
    return { bobs, range: 2 * lowest, total, energies: [kinetic, potential, above], phase,
      angles: inDegrees(0), rates: inDegrees(links) };
  });
  const first = sides[0], last = sides.at(-1), range = Math.max(first.range, last.range);
  const distance = numbers(i => chains.distance(first.bobs[i], last.bobs[i]));
  const growth = distance.map((d, i) => 20 * i >= film.samples && d > 0 && distance[0] > 0
    ? Math.log(d / distance[0]) / (i * film.sample_s) : NaN);
  const energy = sides.map(({ total }) => total.map(now => Math.abs(now - total[0]) / range));
  const all = name => sides.flatMap(side => side[name]);
  const curves = { distance: [distance], exponent: [growth], energy, angles: all("angles"), rates: all("rates"),
    "energies-a": first.energies, "energies-b": last.energies, "total-energy": sides.map(side => side.energies[2]),
    phase: all("phase") };
  return { of, pendulums, curves, drift: mostOf(energy.map(mostOf)) };
}

// With the curves of the film's charts: computed ones, of the film also those that the page holds as floats.
async function withCurves(motion, isOriginal) {
  const held = film.curves && isOriginal ? new Float32Array((await unpacked(film.curves, 4)).buffer) : [];
  let at = 0;
  const next = () => isOriginal ? held.subarray(at, at += count) : numbers(() => NaN);
  const shown = strips.map(({ kind, pens }) => [kind, motion.curves[kind] ?? pens.map(next)]);
  if (film.phase) shown.push(["phase", motion.curves.phase ?? Array.from({ length: 6 }, next)]);
  motion.curves = Object.fromEntries(shown);
  motion.since = motion.curves.distance ? divergence(motion.curves.distance[0]) : NaN;
  return motion;
}

// From when on two that start as one are apart for a second without a break, s (src/analysis/difference.hpp).
function divergence(distance) {
  for (let i = 0, near = -1; distance[0] < 0.1 && i < count; ++i)
    if (!(distance[i] >= 1)) near = i;
    else if ((i - near - 1) * film.sample_s >= 1) return (near + 1) * film.sample_s;
  return NaN;
}

// The motion of chains, computed beside the page. While one is computed the others wait; of these only the last one is
// computed at all, and ends one that takes more than half a second, except the film's own.
let worker = null, turn = Promise.resolve(), wanted = null;
function compute(of) {
  wanted = of;
  return turn = turn.then(() => wanted === of && new Promise(done => {
    worker ??= new Worker(URL.createObjectURL(new Blob([`const chains = (${makeChains})();
      onmessage = ({ data: { of, samples } }) => {
        let next = Date.now() + 500;
        const states = of.map((p, k) => chains.run(p, p.method, p.step, p.steps, samples, sample => {
          if (Date.now() > next) next = Date.now() + 200, postMessage({ share: (k + sample / samples) / of.length });
        }));
        postMessage({ states }, states.map(list => list.buffer));
      };`], { type: "text/javascript" })));
    worker.onmessage = ({ data: { share, states } }) => {
      if (states) return done(motionOf(of, states));
      if (wanted !== of && (original || isOfFigure)) return worker.terminate(), done(worker = null);
      say(`computing the motion: ${Math.round(100 * share)} %`);
      if (motion?.curves) motion.curves = null, draw();
    };
    worker.postMessage({ of, samples: film.samples });
  }));
}
