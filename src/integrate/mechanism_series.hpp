#pragma once

#include "integrate/stabilise.hpp"
#include "integrate/taped_series.hpp"
#include "physics/mechanism.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace doppel {

/// The Taylor series of a mechanism: that of its right-hand side, and a look at the way, for no series notices a singular
/// configuration where the motion could go on smoothly. Lengths are what they are in the state: nothing pulls the rods back.
/// Errors  those of the mechanism, wherever a singular configuration lies on the way that move() goes.
template <class S>
class MechanismSeries {
public:
    using Scalar = S;
    using Model = Mechanism<Scalar>;
    using State = typename Model::State;
    using Half = typename Model::Half;

    MechanismSeries(const Model& model, int order)
        : model_(model),
          series_(model_, Mechanism<Taped<Scalar>>(model.parts.template cast<Taped<Scalar>>()), scale_of(model.parts),
                  order),
          gradients_(model_.set_.blank_gradients()),
          ahead_(gradients_) {}

    template <class Y>
    void expand(const Y& y) {
        start_ = y;
        for (std::size_t i = 0; i < model_.parts.forces.size(); ++i)
            if (ends_have_met(model_.parts.forces[i]))
                throw method_failed("{}: its ends have met, where it has no direction; start so that they do not",
                                    name_of(model_.parts.forces, i));
        series_.expand(start_);
        start_checking();
    }

    template <class Y>
    void move(const Scalar& h, Y& change) {
        check_path(h);
        series_.move(h, change);
    }

    double size(int k) const { return series_.size(k); }
    double log2_size(int k) const requires(!std::same_as<Scalar, double>) { return series_.log2_size(k); }
    double longest_step() const { return series_.longest_step(); }
    double first_event(double h) const { return series_.first_event(h); }

private:
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

    bool ends_have_met(const Force<Scalar>& force) const {
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
        model_.set_.update(start_.head(start_.size() / 2), gradients_);
        if (const auto row = first_fault(gradients_, gradients_); row < model_.set_.rows())
            model_.fail(start_.head(start_.size() / 2), row);
    }

    /// Finds out whether a singular configuration lies on the way to h. From one place to another so near that no gradient
    /// has turned far, the volume that the gradients span must not turn over; where it seems to, somewhere between them,
    /// until they are all but the same.
    void check_path(const Scalar& h) {
        if (gradients_.empty()) return;
        if (h < checked_) start_checking();
        while (checked_ < h) {
            Scalar reached = h;
            for (int halvings = 0; !is_clear(reached, halvings == most_halvings); ++halvings)
                reached = checked_ + (reached - checked_) * Scalar(0.5);
            checked_ = reached;
            gradients_.swap(ahead_);
        }
    }

    /// Whether nothing can be between the place last passed and that at time h. Throws if something seems to be and
    /// this is the last attempt.
    bool is_clear(const Scalar& h, bool last) {
        here_.resize(start_.size() / 2);
        series_.move(h, here_);
        here_ += start_.head(here_.size());
        model_.set_.update(here_, ahead_);
        if (!Model::alike(ahead_, gradients_)) return last;
        const auto row = first_fault(ahead_, gradients_);
        if (last && row < model_.set_.rows()) model_.fail(here_, row);
        return row == model_.set_.rows();
    }

    /// The first row of J1 M⁻¹ J0ᵀ that depends on others or has turned over.
    Eigen::Index first_fault(const Gradients& one, const Gradients& zero) {
        auto& matrix = model_.matrix_;
        model_.set_.couple(one, zero, model_.masses_.w, matrix);
        matrix.factor();
        return std::min(matrix.dependent_row(), matrix.negative_row());
    }

    static constexpr int most_halvings = 40;

    Model model_;
    TapedSeries<Model, Mechanism<Taped<Scalar>>> series_;
    State start_;
    Scalar checked_ = Scalar(0);  // how far the way has been checked, s
    Half here_;                   // q there
    Gradients gradients_;         // J there
    Gradients ahead_;             // further on
};

template <class Scalar>
struct SeriesOf<Mechanism<Scalar>> {
    using type = MechanismSeries<Scalar>;
};
/// A chain of particles on rods is the mechanism of its parts.
template <class Scalar, int N>
struct SeriesOf<RodChain<Scalar, N>> {
    struct type : MechanismSeries<Scalar> {
        type(const RodChain<Scalar, N>& model, int order)
            : MechanismSeries<Scalar>(Mechanism<Scalar>(parts_of(model.pendulum)), order) {}
    };
};
/// Projected after every step, the motion is the same.
template <HasSeries Model>
struct SeriesOf<Projected<Model>> : SeriesOf<Model> {};

}  // namespace doppel
