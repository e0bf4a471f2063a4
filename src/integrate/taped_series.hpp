#pragma once

#include "integrate/taylor_series.hpp"
#include "numeric/roots.hpp"
#include "numeric/tape.hpp"
#include "physics/physical_chain.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <utility>
#include <vector>

namespace doppel {

/// The Taylor series of a model from its right-hand side alone, as a tape takes it down at the start of each step.
/// `Model` is one over plain numbers, `TapedModel` the same over Taped<Scalar>.
///
/// What the right-hand side compares (the sign of a rate in a drag like |ω| ω) may change on the way: a step ends just
/// behind the first such change, by so little that what it errs there, its third power, is below rounding. Where a force
/// jumps the model has an event (integrate/events.hpp), at which the step ends.
template <class Model, class TapedModel>
class TapedSeries {
public:
    using Scalar = typename Model::Scalar;
    using State = typename Model::State;

    TapedSeries(const Model& model, int order)
        : order_(order),
          source_(model),
          layout_(model.layout),
          model_(model.pendulum.template cast<Taped<Scalar>>()),
          tape_(order + 1),
          longest_(
              longest_chain_step(plain_value(model.pendulum.chain.reach()), plain_value(model.pendulum.chain.gravity))),
          y_(2 * layout_.half),
          rate_(y_) {}

    void expand(const State& y) {
        tape_.clear();
        for (Eigen::Index i = 0; i < y.size(); ++i) y_[i] = Taped<Scalar>::argument(y[i], tape_);
        if constexpr (requires { model_.keep_modes_of(source_); }) model_.keep_modes_of(source_);
        model_.rate(y_, rate_);
        tape_.finish();
        for (Eigen::Index i = 0; i < y.size(); ++i) tape_.term(y_[i].node(), 0) = y[i];
        for (int k = 0; k <= order_; ++k) {
            tape_.compute(k);
            const Scalar by_next = Scalar(1) / Scalar(k + 1);
            for (Eigen::Index i = 0; i < y.size(); ++i) {
                const int node = rate_[i].node();
                const Scalar rate = node >= 0 ? tape_.term(node, k) : k == 0 ? rate_[i].value : Scalar(0);
                tape_.term(y_[i].node(), k + 1) = rate * by_next;
            }
        }
        amount_ = greatest(0) + std::sqrt(greatest(1));
    }

    void move(const Scalar& h, State& change) const {
        for (Eigen::Index i = 0; i < change.size(); ++i) {
            Scalar sum(0);
            for (int k = order_ + 1; k > 0; --k) sum = (sum + series(i)[k]) * h;
            change[i] = sum;
        }
    }

    double size(int k) const { return amount_ == 0 ? 0 : greatest(k) / amount_; }
    double longest_step() const { return longest_; }

    /// log2 of size(k), also where no double holds it: soon after rest, quadratic drag has coefficients like 10^(14 k).
    double log2_size(int k) const requires(!std::same_as<Scalar, double>) {
        Scalar most = greatest_of(k);
        if (!(most - most == Scalar(0))) return std::numeric_limits<double>::infinity();  // infinite, or NaN
        constexpr int shift = 512;
        int shifts = 0;
        for (; most > Scalar(0x1p512); ++shifts) most *= Scalar(0x1p-512);
        return amount_ == 0 ? -std::numeric_limits<double>::infinity()
                            : rough_log2(plain_value(most) / amount_) + shift * shifts;
    }

    /// At most `h`, s: just behind the first change of what the right-hand side compares.
    double first_event(double h) const {
        const double beyond = 0.1 * std::cbrt(plain_value(std::numeric_limits<Scalar>::epsilon())) * h;
        double first = h;
        std::vector<double> powers;  // of t / first, made to start below 0
        const auto at = [&](double t) {
            struct {
                double value = 0, rate = 0;
            } now;
            for (auto c = powers.rbegin(); c != powers.rend(); ++c) {
                now.rate = now.rate * t + now.value;
                now.value = now.value * t + *c;
            }
            return now;
        };
        for (const int node : tape_.events()) {
            const auto *x = tape_.series(node), *end = x + order_ + 1;
            x = std::find_if(x, end, [](const Scalar& c) { return c != Scalar(0); });
            if (x == end) continue;
            powers.clear();
            for (Scalar scale = *x < Scalar(0) ? Scalar(1) : Scalar(-1); x != end; ++x, scale *= Scalar(first))
                powers.push_back(plain_value(Scalar(*x * scale)));
            const auto rises = Bernstein::of_powers(powers, 1).rises();
            if (!rises.empty()) first = std::min(first, root(rises.front(), at) * first + beyond);
        }
        return first;
    }

private:
    const Scalar* series(Eigen::Index i) const { return tape_.series(y_[i].node()); }
    /// The greatest coefficient k of the rates of angles or places.
    Scalar greatest_of(int k) const {
        using std::abs;
        Scalar most(0);
        for (Eigen::Index i = 0; i < layout_.coordinates; ++i) {
            const Scalar size = abs(series(layout_.half + i)[k]);
            if (!(size <= most) && most == most) most = size;  // NaN stays
        }
        return most;
    }
    double greatest(int k) const { return plain_value(greatest_of(k)); }

    int order_;
    const Model& source_;
    PhysicalLayout layout_;
    TapedModel model_;
    Tape<Scalar> tape_;
    double longest_, amount_ = 0;  // s; rad/s or m/s
    typename TapedModel::State y_, rate_;
};

template <class Scalar>
struct SeriesOf<PhysicalChain<Scalar>> {
    using type = TapedSeries<PhysicalChain<Scalar>, PhysicalChain<Taped<Scalar>>>;
};

}  // namespace doppel
