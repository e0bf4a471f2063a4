#pragma once

#include "base/error.hpp"
#include "integrate/taped_series.hpp"
#include "physics/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {

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
            if (ends_coincide(model_.parts.forces[i]))
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

    bool ends_coincide(const Force<Scalar>& force) const {
        const auto meet = [&](std::size_t a, const End<Scalar>& b) {
            return part_of(start_, a) == place_of(b, start_);
        };
        if (const auto* spring = std::get_if<Spring<Scalar>>(&force))
            return spring->has_direction() && meet(spring->a, spring->b);
        if (const auto* pair = std::get_if<Attraction<Scalar>>(&force)) return meet(pair->a, pair->b);
        const auto* droplet = std::get_if<Droplet<Scalar>>(&force);
        for (std::size_t i = 0; droplet && i < model_.parts.particles.size(); ++i)
            if (meet(i, droplet->place)) return true;
        return false;
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
