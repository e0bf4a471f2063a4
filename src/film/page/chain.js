// chain.js: the motion of chains of one to three ideal links in angles, to the last bit as Doppel computes it: + − × ÷
// and √ of doubles round the same everywhere; nothing else is used. In the syntax of 2009, which every engine reads.
// A chain is {mass: [kg], length: [m], angle: [rad], rate: [rad/s], gravity: m/s²}; a state θ1 … θN, ω1 … ωN.
"use strict";
function makeChains() {
  var largestTurn = 1 / 1024;  // rad

  function array(size) { return new Float64Array(size); }
  function turns(count) { return { sin: array(count), cos: array(count) }; }

  // Element k of `to` ← sine and cosine, as src/numeric/sin_cos.hpp: angle = n π/2 + r + tail.
  function sinCos(angle, to, k) {
    var shift = 6755399441055744, n = (angle * 0.6366197723675814 + shift) - shift;
    var coarse = angle - n * 1.5707963267341256, fine = n * 6.077100506303966e-11;
    var r = coarse - fine, tail = ((coarse - r) - fine) - n * 2.0222662487959506e-21;
    var z = r * r, half = 0.5 * z, rest = 1 - half;
    var odd = z * (8.33333333332248946124e-03 + z * (-1.98412698298579493134e-04 + z * (2.75573137070700676789e-06 +
      z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10))));
    var even = z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 + z * (2.48015872894767294178e-05 +
      z * (-2.75573143513906633035e-07 + z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    var s = r + (tail * rest + (r * z) * (odd - 1.66666666666666324348e-01));
    var c = rest + (((1 - rest) - half) + (z * even - r * tail));
    var quarter = n & 3, isNear = Math.abs(angle) <= 1e5;
    to.sin[k] = isNear ? (quarter & 1 ? c : s) * (quarter & 2 ? -1 : 1) : Math.sin(angle);
    to.cos[k] = isNear ? (quarter & 1 ? s : c) * (quarter + 1 & 2 ? -1 : 1) : Math.cos(angle);
  }
  // The same after a turn of at most largestTurn from those in `from`, which may be scaled.
  function turn(from, to, k, by) {
    var square = by * by, t = by * (0.5 + square * (1 / 24)), s = from.sin[k], c = from.cos[k], u = c - t * s;
    s += (by * (1 - square * (1 / 6))) * u;
    to.sin[k] = s;
    to.cos[k] = u - t * s;
  }

  // For each number of links, ω′ (the last elements of dydt) from a state and from sine and cosine of θ1 and of the
  // angles between neighbours, as DoublePendulum and AngleChain in src/physics/angle_chain.hpp.
  var models = [null, function (p) {
    var byLength = 1 / p.length[0];
    return function (y, sin, cos, dydt) { dydt[1] = -(p.gravity * sin[0]) * byLength; };
  }, function (p) {
    var ratio = p.mass[0] / p.mass[1], longer = p.length[1] / p.length[0];
    var lever = (p.mass[0] + p.mass[1]) / (p.mass[1] * longer), pull = p.gravity / p.length[0];
    return function (y, sin, cos, dydt) {
      var square2 = y[3] * y[3], f = sin[1] / (ratio + sin[1] * sin[1]), q = y[2] * y[2] + pull * cos[0];
      dydt[2] = (q * cos[1] + longer * square2) * f - pull * sin[0];
      dydt[3] = -((q * lever + square2 * cos[1]) * f);
    };
  }, function (p) {  // the tensions of the rods solve a tridiagonal system, eliminated from both ends
    var m = p.mass[0], l = p.length, g = p.gravity, w0 = 1 / m, w1 = 1 / p.mass[1], w2 = 1 / p.mass[2];
    var byLast = 1 / (w1 + w2), by0 = 1 / l[0], by1 = 1 / l[1], by2 = 1 / l[2];
    return function (y, sin, cos, dydt) {
      var s0 = sin[1] * w0, c0 = cos[1] * w0, s1 = sin[2] * w1, c1 = cos[2] * w1;
      var pivot = s0 * s0 * m + (w1 * w2 + s1 * s1) * byLast;
      var t0 = l[0] * y[3] * y[3] + g * cos[0], t1 = l[1] * y[4] * y[4], t2 = l[2] * y[5] * y[5];
      t1 = ((t1 + c0 * m * t0) + c1 * byLast * t2) * (1 / pivot);
      t0 = (t0 + c0 * t1) * m;
      t2 = (t2 + c1 * t1) * byLast;
      dydt[3] = (-(g * sin[0]) + t1 * s0) * by0;
      dydt[4] = (-(t0 * s0) + t2 * s1) * by1;
      dydt[5] = -(t1 * s1) * by2;
    };
  }];

  // A function that advances a state by so many steps of length h.
  function stepper(p, method, h) {
    var n = p.mass.length, size = 2 * n, accelerate = models[n](p), i, k;
    var angle = array(n), start = turns(n), now = turns(n), at = array(size);
    var a = array(size), b = array(size), c = array(size), d = array(size), sixth = h * (1 / 6), third = h * (1 / 3);
    // dydt at y. In `now` two or three links are turned from `start` where that is little (in C++ chains of a length
    // known to the compiler).
    function slope(y, dydt, to) {
      for (k = 0; k < n; ++k) {
        var turned = k === 0 ? y[0] : y[k] - y[k - 1], by = turned - angle[k];
        if (to === now && n > 1 && Math.abs(by) <= largestTurn) turn(start, to, k, by);
        else sinCos(turned, to, k);
        if (to === start) angle[k] = turned;
        dydt[k] = y[n + k];
      }
      accelerate(y, to.sin, to.cos, dydt);
    }
    function stage(y, share, from, dydt) {
      for (i = 0; i < size; ++i) at[i] = y[i] + share * from[i];
      slope(at, dydt, now);
    }
    var step = {
      "euler": function (y) {
        for (i = 0; i < size; ++i) y[i] += h * a[i];
      },
      "semi-implicit-euler": function (y) {
        for (i = n; i < size; ++i) y[i] += h * a[i];
        for (i = 0; i < n; ++i) y[i] += h * y[n + i];
      },
      "rk4": function (y) {
        stage(y, h * 0.5, a, b);
        stage(y, h * 0.5, b, c);
        stage(y, h, c, d);
        for (i = 0; i < size; ++i) y[i] += sixth * a[i] + third * b[i] + third * c[i] + sixth * d[i];
      }
    }[method];
    return function (y, steps) {
      for (; steps > 0; --steps) {
        slope(y, a, start);
        step(y);
      }
    };
  }

  // Euler's method of two links with rates as changes h ω of one step, and sine and cosine of θ1 and D = θ2 − θ1 turned
  // on from step to step (src/integrate/euler.hpp).
  function eulerOfPair(p, h) {
    var longer = p.length[1] / p.length[0], masses = p.mass[0] / p.mass[1], square = longer * longer;
    var ratio = masses / square, lever = (1 + masses) / square, scale = [h * h * p.gravity / p.length[0], 1 / longer];
    var d1 = h * p.rate[0], d2 = h * p.rate[1], now = turns(2), taken = 0;
    function update(k, angle) {
      sinCos(angle, now, k);
      now.sin[k] *= scale[k];
      now.cos[k] *= scale[k];
    }
    update(0, p.angle[0]);
    update(1, p.angle[1] - p.angle[0]);
    return function (y, steps) {
      var x1 = y[0], x2 = y[1];
      for (; steps > 0; --steps) {
        var sin = now.sin[1], cos = now.cos[1], f = sin / (ratio + sin * sin), q = d1 * d1 + now.cos[0];
        var was = d1, d = d2 - d1, square2 = d2 * d2, isExact = ++taken % 256 === 0;
        x1 += d1;
        x2 += d2;
        d1 = (d1 - now.sin[0]) + (square2 + q * cos) * f;
        d2 -= (q * lever + square2 * cos) * f;
        if (isExact || !(Math.abs(was) <= largestTurn)) update(0, x1);
        else turn(now, now, 0, was);
        if (isExact || !(Math.abs(d) <= largestTurn)) update(1, x2 - x1);
        else turn(now, now, 1, d);
      }
      y.set([x1, x2, d1 / h, d2 / h]);
    };
  }

  // The states at samples 0 … samples, one after the other.
  function run(p, method, h, perSample, samples, progress) {
    var size = 2 * p.mass.length, states = array(size * (samples + 1)), y = new Float64Array(p.angle.concat(p.rate));
    var advance = size === 4 && method === "euler" ? eulerOfPair(p, h) : stepper(p, method, h);
    for (var sample = 0; sample <= samples; ++sample) {
      if (sample > 0) advance(y, perSample);
      states.set(y, size * sample);
      progress(sample);
    }
    return states;
  }

  // The bobs of a state that begins at `from`: [mass, x, y, vx, vy] one after the other; kg, m, m/s.
  function bobs(p, states, from) {
    var n = p.mass.length, x = 0, y = 0, vx = 0, vy = 0, all = [], turned = turns(1);
    for (var i = 0; i < n; ++i) {
      var l = p.length[i], omega = states[from + n + i];
      sinCos(states[from + i], turned, 0);
      x += l * turned.sin[0];
      y -= l * turned.cos[0];
      vx += l * omega * turned.cos[0];
      vy += l * omega * turned.sin[0];
      all.push(p.mass[i], x, y, vx, vy);
    }
    return all;
  }
  // The distance in state space of two chains of as many links, from their bobs.
  function distance(of, other) {
    return Math.sqrt(of.reduce(function (sum, v, i) { return sum + (v - other[i]) * (v - other[i]); }, 0));
  }
  // The energy of bobs, J, zero at rest with every mass level with the pivot.
  function energy(gravity, of) {
    var total = 0;
    for (var i = 0; i < of.length; i += 5)
      total += of[i] * (0.5 * (of[i + 3] * of[i + 3] + of[i + 4] * of[i + 4]) + gravity * of[i + 2]);
    return total;
  }

  return { run: run, bobs: bobs, distance: distance, energy: energy };
}
var chains = makeChains();
