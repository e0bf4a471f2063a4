#pragma once

#include "base/error.hpp"
#include "integrate/events.hpp"
#include "integrate/series.hpp"
#include "numeric/roots.hpp"
#include "numeric/tape.hpp"
#include "physics/mechanism.hpp"
#include "physics/physical_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <type_traits>
#include <utility>
#include <vector>

namespace doppel {

/// The part of a model's state that step control uses: the first `coordinates`, and the rates from index `rates` on.
struct SeriesScale {
    Eigen::Index coordinates, rates;
    double length;   // accelerations a count as a rate of √(length |a|): 1 for angles, in m for positions
    double longest;  // longest step, s
};

/// The Taylor series of a model from its right-hand side alone. The right-hand side is recorded on a tape once, and
/// again when a comparison in it has changed. `Model` is one over Taped<Scalar>. A comparison (such as the sign of a
/// rate in a drag |ω| ω) may change during a step. The step then ends just after the first change, so close that the
/// error, of third order in the time, is below rounding. Joints with Coulomb friction have events of the model
/// (integrate/events.hpp), where the step ends, too.
template <class Model>
class TapedSeries : public Series<typename Model::Scalar::Scalar> {
public:
    using Scalar = typename Model::Scalar::Scalar;
    using State = typename Series<Scalar>::State;

    /// `modes`: of the joints of bodies.
    TapedSeries(Model taped, const SeriesScale& scale, int order, const std::vector<int>* modes = nullptr)
        : Series<Scalar>(scale.longest, !std::is_same_v<Scalar, double>),
          taped_(std::move(taped)),
          order_(order),
          tape_(order + 1),
          scale_(scale),
          modes_(modes) {}

    void expand(const State& y) override {
        if (!is_as_recorded(y)) record(y);
        for (int k = 0; k <= order_; ++k) {
            if (k > 0) tape_.compute(k);
            const Scalar by_next = Scalar(1) / Scalar(k + 1);
            for (Eigen::Index i = 0; i < y.size(); ++i) {
                const int node = rate_[i].node();
                const Scalar rate = node >= 0 ? tape_.term(node, k) : k == 0 ? rate_[i].value : Scalar(0);
                tape_.term(y_[i].node(), k + 1) = rate * by_next;
            }
        }
        this->take_scale(scale_.length);
    }

    void move(const Scalar& h, State& change) override {
        for (Eigen::Index i = 0; i < change.size(); ++i) {
            Scalar sum(0);
            for (int k = order_ + 1; k > 0; --k) sum = (sum + series(i)[k]) * h;
            change[i] = sum;
        }
    }

    double rate(int k, Eigen::Index i) const override { return static_cast<double>(series(scale_.rates + i)[k]); }

    /// Just after the first change of a comparison, s; at most `h`.
    double first_event(double h) const override {
        const double beyond = 0.1 * std::cbrt(static_cast<double>(std::numeric_limits<Scalar>::epsilon())) * h;
        // where the force jumps, its series is singular; the step goes as close to it as the coefficients' range allows
        constexpr int range = std::numeric_limits<Scalar>::max_exponent10;
        const double just_beyond = std::max(1e-15, std::pow(10.0, 1.0 - range / (order_ + 2.0))) * h;
        double first = h;
        std::pmr::vector<double> powers(&memory_);  // in powers of t / first; negative at the start
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
        for (const auto& event : tape_.events()) {
            const auto *x = tape_.series(event.node), *end = x + order_ + 1;
            x = std::find_if(x, end, [](const Scalar& c) { return c != Scalar(0); });
            if (x == end) continue;
            powers.clear();
            for (Scalar scale = *x < Scalar(0) ? Scalar(1) : Scalar(-1); x != end; ++x, scale *= Scalar(first))
                powers.push_back(static_cast<double>(Scalar(*x * scale)));
            const auto rises = Bernstein::of_powers(powers, 1, &memory_).rises();
            if (rises.empty()) continue;
            const double t = root(rises.front(), at) * first;
            first = std::min(first, t + (event.may_jump ? just_beyond : beyond));
        }
        return first;
    }

private:
    void record(const State& y) {
        tape_.clear();
        y_.setZero(y.size());
        rate_ = y_;
        for (Eigen::Index i = 0; i < y.size(); ++i) y_[i] = Taped<Scalar>::argument(y[i], tape_);
        if constexpr (HasEvents<Model>) taped_.keep_modes(*modes_);
        taped_.rate(y_, rate_);
        tape_.finish();
        start_at(y);
    }
    bool is_as_recorded(const State& y) {
        if (tape_.empty()) return false;
        if constexpr (HasEvents<Model>)
            if (taped_.modes() != *modes_) return false;
        start_at(y);
        return tape_.is_as_recorded();
    }
    void start_at(const State& y) {
        for (Eigen::Index i = 0; i < y.size(); ++i) tape_.term(y_[i].node(), 0) = y[i];
        tape_.compute(0);
    }

    const Scalar* series(Eigen::Index i) const { return tape_.series(y_[i].node()); }
    /// The largest coefficient k of the rates of angles or positions.
    Scalar largest(int k) const override {
        using std::abs;
        Scalar maximum(0);
        for (Eigen::Index i = 0; i < scale_.coordinates; ++i) {
            const Scalar size = abs(series(scale_.rates + i)[k]);
            if (!(size <= maximum) && maximum == maximum) maximum = size;  // keeps NaN
        }
        return maximum;
    }

    Model taped_;
    int order_;
    Tape<Scalar> tape_;
    SeriesScale scale_;
    const std::vector<int>* modes_;
    typename Model::State y_, rate_;
    mutable std::pmr::unsynchronized_pool_resource memory_;  // of first_event(), kept for the next step
};

template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const PhysicalChain<Scalar>& model, int order) {
    using Model = PhysicalChain<Taped<Scalar>>;
    const auto& chain = model.pendulum.chain;
    const SeriesScale scale{
        .coordinates = model.layout.coordinates,
        .rates = model.layout.half,
        .length = 1,
        .longest = longest_chain_step(static_cast<double>(chain.reach()), static_cast<double>(chain.gravity))};
    return std::make_unique<TapedSeries<Model>>(Model(model.pendulum.template cast<Taped<Scalar>>()), scale, order,
                                                &model.modes());
}

/// The Taylor series of a mechanism, from its right-hand side. It also checks the path of each step, because the series
/// does not show a singular configuration through which the motion could continue smoothly. The lengths are those of
/// the state; errors of the constraints are not corrected.
/// Errors  those of the mechanism, if a singular configuration lies on the path of move().
template <class S>
class MechanismSeries final : public TapedSeries<Mechanism<Taped<S>>> {
public:
    using Scalar = S;
    using Model = Mechanism<Scalar>;
    using State = typename Model::State;

    MechanismSeries(const Assembly<Scalar>& parts, int order)
        : Base(Mechanism<Taped<Scalar>>(parts.template cast<Taped<Scalar>>()), scale_of(parts), order),
          model_(parts),
          gradients_(model_.blank_gradients()),
          ahead_(gradients_) {}

    void expand(const State& y) override {
        start_ = y;
        for (std::size_t i = 0; i < model_.parts.forces.size(); ++i)
            if (const auto* spring = std::get_if<Spring<Scalar>>(&model_.parts.forces[i]);
                spring && spring->has_direction() && part_of(y, spring->a) == place_of(spring->b, y))
                throw method_failed(
                    "{}: its ends are at the same place, where its direction is undefined; choose a start that does "
                    "not lead there",
                    name_of(model_.parts.forces, i));
        Base::expand(start_);
        start_checking();
    }

    void move(const Scalar& h, State& change) override {
        check_path(h);
        Base::move(h, change);
    }

private:
    using Base = TapedSeries<Mechanism<Taped<S>>>;
    using Half = typename Model::Half;
    using Gradients = typename Model::Gradients;

    /// The longest step is that of a chain of all rods, or half a period of the stiffest spring.
    static SeriesScale scale_of(const Assembly<Scalar>& parts) {
        const auto plain = parts.template cast<double>();
        SeriesScale scale{.coordinates = 2 * static_cast<Eigen::Index>(parts.particles.size()),
                          .rates = 2 * static_cast<Eigen::Index>(parts.particles.size()),
                          .length = size_of(plain),
                          .longest = std::numeric_limits<double>::max()};
        const auto by_mass = [&](std::size_t particle) { return 1 / plain.particles[particle].mass; };
        double reach = 0, gravity = 0;
        for (const auto& constraint : plain.constraints)
            if (const auto rod = rod_of(constraint)) reach += rod->length;
        for (const auto& force : plain.forces) {
            if (const auto* down = std::get_if<Gravity<double>>(&force)) gravity += down->g;
            if (const auto* spring = std::get_if<Spring<double>>(&force)) {
                const auto* other = std::get_if<std::size_t>(&spring->b);
                const double square = spring->stiffness * (by_mass(spring->a) + (other ? by_mass(*other) : 0));
                scale.longest = std::min(scale.longest, pi / std::sqrt(square));
            }
        }
        if (reach > 0) scale.longest = std::min(scale.longest, longest_chain_step(reach, gravity));
        return scale;
    }

    void start_checking() {
        checked_ = Scalar(0);
        model_.update(start_.head(start_.size() / 2), gradients_);
        if (const auto row = first_singular_row(gradients_, gradients_); row < model_.constraints())
            model_.fail(start_.head(start_.size() / 2), row);
    }

    /// Checks the path up to h for singular configurations. Between two positions so close that no gradient changes its
    /// direction much, the volume spanned by the gradients must not change its sign. If it seems to, positions in
    /// between are checked, until they are almost equal.
    void check_path(const Scalar& h) {
        if (gradients_.empty()) return;
        if (h < checked_) start_checking();
        while (checked_ < h) {
            Scalar reached = h;
            for (int halvings = 0; !is_clear(reached, halvings == max_halvings); ++halvings)
                reached = checked_ + (reached - checked_) * Scalar(0.5);
            checked_ = reached;
            gradients_.swap(ahead_);
        }
    }

    /// Whether there is certainly no singular configuration between the last checked position and that at time h. In
    /// the last attempt, throws if one is suspected.
    bool is_clear(const Scalar& h, bool last) {
        here_.resize(start_.size() / 2);
        Base::move(h, here_);
        here_ += start_.head(here_.size());
        model_.update(here_, ahead_);
        if (!Model::nearly_parallel(ahead_, gradients_)) return last;
        const auto row = first_singular_row(ahead_, gradients_);
        if (last && row < model_.constraints()) model_.fail(here_, row);
        return row == model_.constraints();
    }

    /// The first row of J1 M⁻¹ J0ᵀ that depends on others, or whose pivot is negative.
    Eigen::Index first_singular_row(const Gradients& one, const Gradients& zero) {
        auto& matrix = model_.matrix_;
        model_.couple(one, zero, matrix);
        matrix.factor();
        return std::min(matrix.dependent_row(), matrix.negative_row());
    }

    static constexpr int max_halvings = 40;

    Model model_;
    State start_;
    Scalar checked_ = Scalar(0);  // end of the checked path, s
    Half here_;                   // q there
    Gradients gradients_;         // J there
    Gradients ahead_;             // J at the next position
};

template <class Scalar>
std::unique_ptr<Series<Scalar>> series_of(const Assembly<Scalar>& parts, int order) {
    return std::make_unique<MechanismSeries<Scalar>>(parts, order);
}

}  // namespace doppel
