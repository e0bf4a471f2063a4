// motion.js: what the page shows, from its data: places of bobs at all samples, and the curves of strips.
"use strict";
const pageData = JSON.parse(document.getElementById("data").textContent), film = pageData.film ?? pageData;
const { theme, bodies, layout } = film, count = film.samples + 1, degrees = 180 / Math.PI;
// whether the pendulums can be released anew
const isLive = bodies.every(body => body.chain && body.mass.length === bodies[0].mass.length);
const sumOf = list => list.reduce((a, b) => a + b, 0), mostOf = list => list.reduce((a, b) => Math.max(a, b));

// The words of so many bytes behind base64 of what zlib made of them: the lowest byte of each, then the next one of each …
async function unpacked(base64, wordBytes) {
  const packed = new Blob([Uint8Array.from(atob(base64), c => c.charCodeAt(0))]);
  const bytes = new Uint8Array(await new Response(packed.stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer());
  const words = new Uint32Array(bytes.length / wordBytes);
  for (let b = 0; b < wordBytes; ++b) for (let i = 0; i < words.length; ++i) words[i] |= bytes[b * words.length + i] << (8 * b);
  return words;
}

// The curves that the page holds: floats, each the difference of its bits to those of the one before.
async function embeddedCurves() {
  const bits = film.curves ? await unpacked(film.curves, 4) : [], curves = [];
  for (let at = 0; at < bits.length; at += count) {
    for (let i = at + 1; i < at + count; ++i) bits[i] += bits[i - 1];
    curves.push(new Float32Array(bits.buffer, 4 * at, count));
  }
  return curves;
}

// Places in whole steps, as src/film/page.cpp writes them: for each pendulum [xs, ys] of its bobs, and of a pivot that moves.
async function embeddedPlaces({ bits, low, high, pendulums, words }) {
  const steps = await unpacked(words, bits > 16 ? 3 : 2), most = 2 ** bits - 1;
  let at = 0, before = 0;
  return pendulums.map((pendulum, k) => {
    const links = bodies[k].mass.length, first = at, channel = read => {
      const values = new Float32Array(count);
      for (let i = 0, last = 0, change = 0; i < count; ++i, ++at) {
        if (pendulum.like_last) steps[at] += steps[at - before];
        change = change + steps[at] & most;
        last = last + change & most;
        values[i] = read(last);
      }
      return values;
    };
    const place = () => [0, 1].map(() => channel(step => low + (high - low) * step / most));
    const angles = pendulum.angles && Array.from({ length: links }, () => channel(step => (step << 32 - bits >> 32 - bits) * pendulum.step));
    const bobs = angles ? [] : Array.from({ length: links }, place), pivot = pendulum.pivot ? place() : null;
    for (let b = 0; angles && b < links; ++b) {
      const [xs, ys] = b > 0 ? bobs[b - 1] : pivot ?? [new Float32Array(count), new Float32Array(count)], l = pendulum.length[b];
      bobs.push([angles[b].map((a, i) => xs[i] + l * Math.sin(a)), angles[b].map((a, i) => ys[i] - l * Math.cos(a))]);
    }
    before = at - first;
    return { bobs, pivot };
  });
}

// A motion of chains from their states, at one sample or more.
function motionOf(of, states, embedded) {
  const links = of[0].mass.length, samples = states[0].length / (2 * links);
  const pendulums = of.map((chain, k) => {
    const bobs = chain.mass.map(() => [new Float32Array(samples), new Float32Array(samples)]);
    for (let i = 0; i < samples; ++i) {
      const now = chains.bobs(chain, states[k], 2 * links * i);
      bobs.forEach(([xs, ys], b) => { xs[i] = now[4 * b]; ys[i] = now[4 * b + 1]; });
    }
    return { bobs, pivot: null };
  });
  return samples === 1 ? { pendulums, of } : withCurves({ pendulums, of }, computedCurves(of, states), embedded);
}

// Those that follow from states, by the kind of the strip; of a phase panel angles, rates and angles of the first link.
function computedCurves(of, states) {
  const links = of[0].mass.length, ends = [...new Set([0, of.length - 1])], make = () => new Float64Array(count);
  const distance = make(), totals = ends.map(make);
  for (let i = 0; i < count; ++i) {
    const bobs = ends.map(k => chains.bobs(of[k], states[k], 2 * links * i));
    if (ends.length > 1) distance[i] = chains.distance(of[0], of[ends[1]], ...bobs);
    ends.forEach((k, e) => { totals[e][i] = chains.energy(of[k], bobs[e]); });
  }
  const range = mostOf(ends.map(k => 2 * of[k].gravity * sumOf(of[k].mass.map((m, i) => m * sumOf(of[k].length.slice(0, i + 1))))));
  const growth = (d, i) => i > 0 && 20 * i >= film.samples && d > 0 && distance[0] > 0 ? Math.log(d / distance[0]) / (i * film.sample_s) : NaN;
  const phase = film.phase && ends.map(k => [film.phase.link, links + film.phase.link, 0].map(from => distance.map((_, i) => states[k][2 * links * i + from])));
  return { distance: [distance], exponent: [distance.map(growth)], energy: totals.map(total => total.map(e => Math.abs(e - total[0]) / range)), phase };
}

function withCurves(motion, computed, embedded = []) {
  let next = 0;
  const held = () => embedded[next++] ?? new Float32Array(count).fill(NaN);
  motion.curves = film.strips.map(strip => computed[strip.kind] ?? strip.colors.map(held));
  motion.phase = computed.phase ?? (film.phase && [0, 1].map(() => [held(), held(), held()]));
  motion.drift = computed.energy && mostOf(computed.energy.map(mostOf));
  motion.distance = motion.curves[film.strips.findIndex(strip => strip.kind === "distance")]?.[0];
  motion.since = motion.distance ? divergence(motion.distance) : NaN;
  return motion;
}

// From when on two that start as one are apart for a second without a break, s (src/analysis/difference.hpp).
function divergence(distance) {
  for (let i = 0, from = NaN; distance[0] < 0.1 && i < count; ++i) {
    if (!(distance[i] >= 1)) from = NaN;
    else if (Number.isNaN(from)) from = i * film.sample_s;
    if (i * film.sample_s - from >= 1) return from;
  }
  return NaN;
}

// Computes the states of chains beside the page, and calls done(motion): of several requests that wait, of the last one.
let worker = null, waiting = null, isBusy = false;
function compute(of, done, say, embedded) {
  waiting = [of, done, say, embedded];
  if (!isBusy) computeNext();
}
function computeNext() {
  const [of, done, say, embedded] = waiting, begun = performance.now();
  waiting = null;
  isBusy = true;
  worker ??= new Worker(URL.createObjectURL(new Blob([`const chains = (${makeChains})();
    onmessage = ({ data: { of, samples } }) => {
      let last = Date.now();
      const states = of.map((p, k) => chains.run(p, p.method, p.step, p.steps, samples, sample => {
        if (Date.now() - last > 200) last = Date.now(), postMessage({ share: (k + sample / samples) / of.length });
      }));
      postMessage({ states }, states.map(list => list.buffer));
    };`], { type: "text/javascript" })));
  worker.onmessage = ({ data: { share, states } }) => {
    if (!states) return performance.now() - begun > 500 && say(`computing the motion: ${Math.round(100 * share)} %`);
    isBusy = false;
    done(motionOf(of, states, embedded));
    if (waiting) computeNext();
  };
  worker.postMessage({ of, samples: film.samples });
}
