// chain.js: the motion of chains of one to three ideal links in angles, to the last bit as Doppel computes it: + − × ÷ and √ of
// doubles round the same everywhere, and nothing else is used. In the syntax of 2009, which every engine reads.
// A chain is {mass: [kg], length: [m], angle: [rad], rate: [rad/s], gravity: m/s²}; a state θ1 … θN, ω1 … ωN.
"use strict";
function makeChains() {
  var largestTurn = 1 / 1024, sine = 0, cosine = 0;  // rad; what sinCos() found

  // As src/numeric/sin_cos.hpp: angle = n π/2 + r + tail.
  function sinCos(angle) {
    if (!(Math.abs(angle) <= 1e5)) { sine = Math.sin(angle); cosine = Math.cos(angle); return; }
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
    var quarter = n & 3;
    sine = quarter & 1 ? c : s;
    cosine = quarter & 1 ? s : c;
    if (quarter & 2) sine = -sine;
    if ((quarter + 1) & 2) cosine = -cosine;
  }

  // A model finds dydt from a state and from sine and cosine of θ1 and of each angle between neighbours.
  // Two links: the closed form of DoublePendulum (src/physics/angle_chain.hpp).
  function pairModel(p) {
    var ratio = p.mass[0] / p.mass[1], longer = p.length[1] / p.length[0];
    var lever = (p.mass[0] + p.mass[1]) / (p.mass[1] * longer), pull = p.gravity / p.length[0];
    return function (y, sin, cos, dydt) {
      var square2 = y[3] * y[3], f = sin[1] / (ratio + sin[1] * sin[1]), q = y[2] * y[2] + pull * cos[0];
      dydt[0] = y[2];
      dydt[1] = y[3];
      dydt[2] = (q * cos[1] + longer * square2) * f - pull * sin[0];
      dydt[3] = -((q * lever + square2 * cos[1]) * f);
    };
  }

  // One or three links: the tensions of the rods, a tridiagonal system eliminated from both ends (AngleChain and
  // src/numeric/chain_matrix.hpp).
  function chainModel(p) {
    var n = p.mass.length, last = n - 1, middle = n >> 1, w = [], byLength = [], k;
    var s = [], c = [], upper = [], lower = [], inverse = [], tension = [];
    for (k = 0; k < n; ++k) { w[k] = 1 / p.mass[k]; byLength[k] = 1 / p.length[k]; }
    var byLast = n > 1 ? 1 / (w[n - 2] + w[n - 1]) : 0;
    function factor(sin, cos) {
      for (k = 0; k < last; ++k) {
        s[k] = sin[k + 1] * w[k];
        c[k] = cos[k + 1] * w[k];
        upper[k] = lower[k] = -c[k];
      }
      var e = 0, f = w[last];
      for (k = 0; k < middle; ++k) {
        inverse[k] = k === 0 ? p.mass[0] : 1 / (w[k] + e);
        lower[k] *= inverse[k];
        e = k === 0 ? s[k] * s[k] * inverse[k] : (w[k] * e + s[k] * s[k]) * inverse[k];
      }
      for (k = last; k > middle; --k) {
        inverse[k] = k === last ? byLast : 1 / (w[k - 1] + f);
        upper[k - 1] *= inverse[k];
        f = (w[k - 1] * f + s[k - 1] * s[k - 1]) * inverse[k];
      }
      inverse[middle] = 1 / (e + f);
    }
    function solve(x) {
      for (k = 0; k < middle; ++k) x[k + 1] -= lower[k] * x[k];
      for (k = last; k > middle; --k) x[k - 1] -= upper[k - 1] * x[k];
      x[middle] *= inverse[middle];
      for (k = middle; k > 0; --k) x[k - 1] = (x[k - 1] - upper[k - 1] * x[k]) * inverse[k - 1];
      for (k = middle + 1; k < n; ++k) x[k] = (x[k] - lower[k - 1] * x[k - 1]) * inverse[k];
    }
    return function (y, sin, cos, dydt) {
      factor(sin, cos);
      for (k = 0; k < n; ++k) tension[k] = p.length[k] * y[n + k] * y[n + k];
      tension[0] += p.gravity * cos[0];
      solve(tension);
      for (k = 0; k < n; ++k) {
        var across = k === 0 ? -(p.gravity * sin[0]) : -(tension[k - 1] * s[k - 1]);
        if (k < last) across += tension[k + 1] * s[k];
        dydt[k] = y[n + k];
        dydt[n + k] = across * byLength[k];
      }
    };
  }

  // A step of length h of the method, as a function of the state.
  function stepper(p, method, h) {
    var n = p.mass.length, rates = n === 2 ? pairModel(p) : chainModel(p), i, k;
    var array = function (size) { return new Float64Array(size); };
    var angle = array(n), sin0 = array(n), cos0 = array(n), sin = array(n), cos = array(n), at = array(2 * n);
    var slopes = [array(2 * n), array(2 * n), array(2 * n), array(2 * n)];
    function turned(y, k) { return k === 0 ? y[0] : y[k] - y[k - 1]; }
    function start(y) {
      for (k = 0; k < n; ++k) {
        sinCos(angle[k] = turned(y, k));
        sin0[k] = sine;
        cos0[k] = cosine;
      }
      rates(y, sin0, cos0, slopes[0]);
    }
    // at ← y + share · slope, and the slope there: sine and cosine by a turn from those at the start, where it is small, of two or
    // three links (in C++ chains of a length known to the compiler)
    function stage(y, share, from, to) {
      for (i = 0; i < 2 * n; ++i) at[i] = y[i] + share * from[i];
      for (k = 0; k < n; ++k) {
        var now = turned(at, k), d = now - angle[k], square = d * d;
        if (n === 1 || !(Math.abs(d) <= largestTurn)) {
          sinCos(now);
          sin[k] = sine;
          cos[k] = cosine;
          continue;
        }
        var t = d * (0.5 + square * (1 / 24)), u = cos0[k] - t * sin0[k];
        sin[k] = sin0[k] + (d * (1 - square * (1 / 6))) * u;
        cos[k] = u - t * sin[k];
      }
      rates(at, sin, cos, to);
    }
    var a = slopes[0], b = slopes[1], c = slopes[2], d = slopes[3], half = h * 0.5, sixth = h * (1 / 6), third = h * (1 / 3);
    return {
      "euler": function (y) {
        start(y);
        for (i = 0; i < 2 * n; ++i) y[i] += h * a[i];
      },
      "semi-implicit-euler": function (y) {
        start(y);
        for (i = n; i < 2 * n; ++i) y[i] += h * a[i];
        for (i = 0; i < n; ++i) y[i] += h * y[n + i];
      },
      "rk4": function (y) {
        start(y);
        stage(y, half, a, b);
        stage(y, half, b, c);
        stage(y, h, c, d);
        for (i = 0; i < 2 * n; ++i) y[i] += sixth * a[i] + third * b[i] + third * c[i] + sixth * d[i];
      }
    }[method];
  }

  // Euler's method of two links with rates as changes h ω of one step, and sine and cosine of θ1 and D = θ2 − θ1 turned
  // on from step to step (src/integrate/incremental_euler.hpp). Calls visit(sample, θ1, θ2, ω1, ω2).
  function eulerOfPair(p, h, perSample, samples, visit) {
    var longer = p.length[1] / p.length[0], masses = p.mass[0] / p.mass[1], square = longer * longer, inverse = 1 / longer;
    var gravity = h * h * p.gravity / p.length[0], ratio = masses / square, lever = (1 + masses) / square;
    var largest = largestTurn * largestTurn, q0 = largest + Math.abs(gravity);
    var slow = largestTurn - 16 * ((4 * largest + q0 * inverse + q0 * lever + 4 * largest * inverse) * longer /
      Math.sqrt(masses) + Math.abs(gravity));
    var x1 = p.angle[0], x2 = p.angle[1], d1 = h * p.rate[0], d2 = h * p.rate[1], sin1, cos1, sin2, cos2, taken = 0;
    function one() { sinCos(x1); sin1 = sine * gravity; cos1 = cosine * gravity; }
    function two() { sinCos(x2 - x1); sin2 = sine * inverse; cos2 = cosine * inverse; }
    one();
    two();
    visit(0, x1, x2, p.rate[0], p.rate[1]);
    for (var sample = 1; sample <= samples; ++sample) {
      for (var left = perSample; left > 0;) {
        var some = Math.min(left, 16, 256 - taken % 256), fast = !(Math.abs(d1) <= slow && Math.abs(d2 - d1) <= slow);
        for (var i = 0; i < some; ++i) {
          var d = d2 - d1, was1 = d1, square1 = d1 * d1, square2 = d2 * d2;
          var f = sin2 / (ratio + sin2 * sin2), q = square1 + cos1;
          var a1 = (square2 + q * cos2) * f, a2 = (q * lever + square2 * cos2) * f;
          x1 += d1;
          x2 += d2;
          d1 = (d1 - sin1) + a1;
          d2 -= a2;
          var t = was1 * (0.5 + square1 * (1 / 24)), u = cos1 - t * sin1;
          sin1 += (was1 * (1 - square1 * (1 / 6))) * u;
          cos1 = u - t * sin1;
          var turn = d * d;
          t = d * (0.5 + turn * (1 / 24));
          u = cos2 - t * sin2;
          sin2 += (d * (1 - turn * (1 / 6))) * u;
          cos2 = u - t * sin2;
          if (fast && !(Math.abs(was1) <= largestTurn)) one();
          if (fast && !(Math.abs(d) <= largestTurn)) two();
        }
        taken += some;
        left -= some;
        if (taken % 256 === 0) { one(); two(); }
      }
      visit(sample, x1, x2, d1 / h, d2 / h);
    }
  }

  // The states at samples 0 … samples, one after the other.
  function run(p, method, h, perSample, samples, progress) {
    var n = p.mass.length, states = new Float64Array(2 * n * (samples + 1));
    if (n === 2 && method === "euler") {
      eulerOfPair(p, h, perSample, samples, function (sample, x1, x2, w1, w2) {
        states[4 * sample] = x1;
        states[4 * sample + 1] = x2;
        states[4 * sample + 2] = w1;
        states[4 * sample + 3] = w2;
        progress(sample);
      });
      return states;
    }
    var step = stepper(p, method, h), y = new Float64Array(p.angle.concat(p.rate));
    for (var sample = 0; sample <= samples; ++sample) {
      for (var i = 0; sample > 0 && i < perSample; ++i) step(y);
      states.set(y, 2 * n * sample);
      progress(sample);
    }
    return states;
  }

  // The bobs of a state that begins at `from`: [x, y, vx, vy] one after the other; m, m/s.
  function bobs(p, states, from) {
    var n = p.mass.length, x = 0, y = 0, vx = 0, vy = 0, all = [];
    for (var i = 0; i < n; ++i) {
      var l = p.length[i], omega = states[from + n + i];
      sinCos(states[from + i]);
      x += l * sine;
      y -= l * cosine;
      vx += l * omega * cosine;
      vy += l * omega * sine;
      all.push(x, y, vx, vy);
    }
    return all;
  }

  // The distance in state space of two chains of as many links, from their bobs.
  function distance(p, q, of, other) {
    var sum = 0;
    for (var i = 0; i < p.mass.length; ++i) {
      var m = p.mass[i] - q.mass[i];
      sum += m * m;
      for (var k = 4 * i; k < 4 * i + 4; ++k) sum += (of[k] - other[k]) * (of[k] - other[k]);
    }
    return Math.sqrt(sum);
  }

  // The energy, J, zero at rest with every mass level with the pivot.
  function energy(p, of) {
    var total = 0;
    for (var i = 0; i < p.mass.length; ++i)
      total += p.mass[i] * (0.5 * (of[4 * i + 2] * of[4 * i + 2] + of[4 * i + 3] * of[4 * i + 3]) + p.gravity * of[4 * i + 1]);
    return total;
  }

  return { run: run, bobs: bobs, distance: distance, energy: energy };
}
var chains = makeChains();
