// The recurrence of AngleSeries for chains of double, eight segments in eight lanes. Compiled for registers of 2, 4 and
// 8 doubles, by the rules of integrate/batch_width.cpp. Every lane has sums of its own, in the same order, and what goes
// from lane to lane goes the same way, so all give the same bits.

#include "integrate/segment_lanes.hpp"
#include "integrate/segment_series.hpp"
#include "numeric/sin_cos.hpp"

namespace doppel {
namespace {

struct ThisBuild;
using Pack = Lanes<SegmentSeries::lanes, ThisBuild>;
using Register = Lanes<compiled_width, ThisBuild>;
using Row = SegmentSeries::Row;
using Rod = SegmentSeries::Rod;
using Term = SegmentSeries::Term;
using Sums = SegmentSeries::Sums;
using Work = SegmentSeries::Work;
using View = SegmentSeries::View;
constexpr int lanes = SegmentSeries::lanes, group = SegmentSeries::group;

[[gnu::always_inline]] inline Pack load(const Row& row) {
    return Pack::load(row.of);
}

struct Recurrence {
    const View& chain;
    Pack sin0, cos0;  // of the first rod of each segment

    [[gnu::always_inline]] void run(const double* y) {
        start(y);
        const LastLinks<Pack> last = factor();
        for (int k = 0; k < chain.order; ++k) {
            if (k > 0 && k % group == 0)
                for (int b = 0; b < chain.blocks; ++b) add_known(chain.term(b), k, chain.sums[b]);
            for (int b = 0; b < chain.blocks; ++b)
                multiply(chain.rods[b], chain.term(b), k, chain.sums[b], chain.work[b]);
            solve(k, last);
            finish(k);
        }
    }

    /// Number b of each segment from one number a link, those that are not there 0.
    [[gnu::always_inline]] Pack gather(const double* all, int b) const {
        alignas(64) double some[lanes] = {};
        for (int l = 0; l < lanes; ++l)
            if (const int i = b + l * chain.blocks; i < chain.links) some[l] = all[i];
        return Pack::load(some);
    }

    /// Orders 0 and, of r, 1.
    [[gnu::always_inline]] void start(const double* y) {
        Pack most(0);
        for (int b = 0; b < chain.blocks; ++b) {
            const Pack angle = gather(y, b), rate = gather(y + chain.links, b);
            const SinCos<Pack> turn(angle);
            turn.sin.store(chain.work[b].sin.of);
            turn.cos.store(chain.work[b].cos.of);
            Term* term = chain.term(b);
            Pack(1).store(term[0].x.of);
            Pack(0).store(term[0].y.of);
            rate.store(term[0].rate.of);
            Pack(0).store(term[1].x.of);
            (-rate).store(term[1].y.of);
            most = greater(most, abs(rate));
        }
        set_greatest(0, most);
        sin0 = load(chain.work[0].sin);
        cos0 = load(chain.work[0].cos);
    }

    [[gnu::always_inline]] void set_greatest(int k, const Pack& most) const {
        double all = 0;
        for (int l = 0; l < lanes; ++l) all = greater(all, most[l]);
        chain.greatest[k] = all;
    }

    /// The matrix of the tensions, and its factors.
    [[gnu::always_inline]] LastLinks<Pack> factor() const {
        const int last = chain.blocks - 1;
        for (int b = 0; b <= last; ++b) {
            Rod& rod = chain.rods[b];
            const Pack s = load(chain.work[b].sin), c = load(chain.work[b].cos);
            const Pack s1 = b < last ? load(chain.work[b + 1].sin) : from_next(sin0);
            const Pack c1 = b < last ? load(chain.work[b + 1].cos) : from_next(cos0);
            ((s1 * c - c1 * s) * load(rod.between)).store(rod.s.of);
            ((c1 * c + s1 * s) * load(rod.between)).store(rod.c.of);
        }
        Pack c = from_last(load(chain.rods[last].c)), spike = c, share(0), taken(0), pivot = load(chain.rods[0].both);
        for (int b = 0;; ++b) {
            Rod& rod = chain.rods[b];
            share.store(rod.share.of);
            if (b == last) break;
            const Pack inverse = Pack(1) / pivot, inverse_spike = inverse * spike;
            inverse.store(rod.inverse.of);
            inverse_spike.store(rod.inverse_spike.of);
            taken += spike * inverse_spike;
            c = load(rod.c);
            share = c * inverse;
            pivot = load(chain.rods[b + 1].both) - share * c;
            spike = share * spike;
        }
        return LastLinks<Pack>(pivot - from_next(taken), spike);
    }

    /// sums ← Σ_j r_j ω_{k+1−j} and Σ_j r_j · F_{k−j} of what is known before order `first`, for it and the next ones.
    [[gnu::always_inline]] static void add_known(const Term* term, int first, std::array<Sums, group>& sums) {
        for (int l = 0; l < lanes; l += Register::width) {
            Register x[group], y[group], across[group];
            for (int g = 0; g < group; ++g) x[g] = y[g] = across[g] = Register(0);
            const auto add = [&]<int orders>(int j) __attribute__((always_inline)) {
                const Register one = Register::load(term[j].x.of + l), other = Register::load(term[j].y.of + l);
#pragma GCC unroll 4
                for (int g = 0; g < orders; ++g) {
                    const Term &after = term[first + g + 1 - j], &with = term[first + g - j];
                    const Register rate = Register::load(after.rate.of + l);
                    x[g] += one * rate;
                    y[g] += other * rate;
                    across[g] += one * Register::load(with.across.of + l) + other * Register::load(with.along.of + l);
                }
            };
            add.template operator()<1>(1);
            add.template operator()<2>(2);
            add.template operator()<3>(3);
            for (int j = 4; j <= first + 1; ++j) add.template operator()<4>(j);
            for (int g = 0; g < group; ++g) {
                x[g].store(sums[g].x.of + l);
                y[g].store(sums[g].y.of + l);
                across[g].store(sums[g].across.of + l);
            }
        }
    }

    /// R_k, F_k across, r_{k+2} across, and what the tensions' equation has on its right: the sums of products, with those
    /// that add_known() did not know.
    [[gnu::always_inline]] void multiply(const Rod& rod, Term* term, int k, const std::array<Sums, group>& sums,
                                         Work& work) const {
        const int g = k % group, first = k - g;
        Pack x(0), y(0), across(0);
        const auto add = [&](int j) __attribute__((always_inline)) {
            const Pack one = load(term[j].x), other = load(term[j].y), rate = load(term[k + 1 - j].rate);
            x += one * rate;
            y += other * rate;
            across += one * load(term[k - j].across) + other * load(term[k - j].along);
        };
        if (first == 0) {
            for (int j = 1; j <= k + 1; ++j) add(j);
        } else {
            const Sums& known = sums[static_cast<std::size_t>(g)];
            x = load(known.x);
            y = load(known.y);
            across = load(known.across);
            for (int j = 1; j <= g; ++j) add(j);
            for (int j = first + 2; j <= k + 1; ++j) add(j);
        }
        x.store(work.x.of);
        (-across).store(work.across.of);
        (-across).store(term[k].across.of);
        (load(rod.length) * y * Pack(k + 1)).store(work.along.of);
        (y * Pack(chain.inverse[k + 2])).store(term[k + 2].x.of);
    }

    /// F_k along.
    [[gnu::always_inline]] void solve(int k, const LastLinks<Pack>& last_links) const {
        const int last = chain.blocks - 1;
        Work* const work = chain.work;
        if (k == 0) work[0].along.of[0] -= chain.gravity * cos0[0];
        const Pack first_across = load(work[0].across);
        Pack before = from_last(load(chain.rods[last].s) * load(work[last].across)), across = first_across;
        Pack left(0), taken(0);
        for (int b = 0;; ++b) {
            const Rod& rod = chain.rods[b];
            const Pack after = b < last ? load(work[b + 1].across) : from_next(first_across), s = load(rod.s);
            left = load(work[b].along) + (before - s * after) + load(rod.share) * left;
            if (b == last) break;
            left.store(work[b].along.of);
            taken += load(rod.inverse_spike) * left;
            before = s * across;
            across = after;
        }
        Pack along = last_links.solve(left + from_next(taken));
        const Pack above = from_last(along);
        along.store(work[last].along.of);
        for (int b = last - 1; b >= 0; --b) {
            const Rod& rod = chain.rods[b];
            along = (load(work[b].along) * load(rod.inverse) + load(rod.inverse_spike) * above) +
                    load(chain.rods[b + 1].share) * along;
            along.store(work[b].along.of);
        }
    }

    /// ω_{k+1} and r_{k+2} along.
    [[gnu::always_inline]] void finish(int k) const {
        const int last = chain.blocks - 1;
        Work* const work = chain.work;
        const Pack scale(chain.inverse[k + 1]), next_scale(-chain.inverse[k + 2]);
        const Pack first_across = load(work[0].across), first_along = load(work[0].along);
        const auto pull_of = [&](int b) __attribute__((always_inline)) {
            return load(chain.rods[b].s) * load(work[b].along) - load(chain.rods[b].c) * load(work[b].across);
        };
        Pack before = from_last(pull_of(last)), most(0);
        Pack across = first_across, along = first_along;
        Pack gravity(0);
        if (k == 0) gravity.set(0, chain.gravity * sin0[0]);
        for (int b = 0; b <= last; ++b) {
            const Rod& rod = chain.rods[b];
            Term* const term = chain.term(b);
            const Pack s = load(rod.s), c = load(rod.c);
            const Pack next_across = b < last ? load(work[b + 1].across) : from_next(first_across);
            const Pack next_along = b < last ? load(work[b + 1].along) : from_next(first_along);
            Pack sum = (load(rod.both) * across - (c * next_across + s * next_along)) + before;
            if (k == 0 && b == 0) sum -= gravity;
            const Pack turn = sum * (load(rod.by_length) * scale), rate = turn - load(work[b].x);
            rate.store(term[k + 1].rate.of);
            along.store(term[k].along.of);
            (turn * next_scale).store(term[k + 2].y.of);
            most = greater(most, abs(rate));
            before = s * along - c * across;
            across = next_across;
            along = next_along;
        }
        set_greatest(k + 1, most);
    }
};

void expand(const View& chain, const double* y) {
    Recurrence{chain, Pack(0), Pack(0)}.run(y);
}

/// change ← Σ_{k≥0} ω_k h^{k+1} / (k + 1) and Σ_{k≥1} ω_k h^k.
void move(const View& chain, double h, double* change) {
    const Pack by(h);
    for (int b = 0; b < chain.blocks; ++b) {
        const Term* term = chain.term(b);
        Pack angle(0), rate(0);
        for (int k = chain.order; k > 0; --k) {
            const Pack c = load(term[k].rate);
            angle = (angle + c * Pack(chain.inverse[k + 1])) * by;
            rate = (rate + c) * by;
        }
        angle = (angle + load(term[0].rate)) * by;
        alignas(64) double all[2][lanes];
        angle.store(all[0]);
        rate.store(all[1]);
        for (int l = 0; l < lanes; ++l)
            if (const int i = b + l * chain.blocks; i < chain.links) {
                change[i] = all[0][l];
                change[chain.links + i] = all[1][l];
            }
    }
}

}  // namespace

template <>
SegmentSeries::Kernel segment_kernel<compiled_width>() {
    return {expand, move};
}

}  // namespace doppel
