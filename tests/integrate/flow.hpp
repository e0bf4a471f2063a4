#pragma once

#include "integrate/dormand_prince.hpp"
#include "numeric/quad.hpp"
#include "physics/bob.hpp"
#include "physics/canonical.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {

/// Two or three unequal links in motion.
template <class Scalar>
Pendulum<Scalar> unequal(std::size_t links = 2) {
    Pendulum<double> p{{1.25, 0.5, 0.75}, {0.75, 1.5, 0.5}, {1.5, -0.5, 0.25}, {0.25, -1, 2}, 9.8};
    for (auto* values : {&p.mass, &p.length, &p.angle, &p.rate}) values->resize(links);
    return p.template cast<Scalar>();
}

/// The state after this number of steps from `start`, of the model of a pendulum or an assembly.
template <class Which, class Model, class System>
typename Model::State after(const System& system, const typename Model::State& start,
                            const typename Model::Scalar& step, long steps) {
    Model model(system);
    typename Which::template Stepper<Model> stepper(model, start, step);
    stepper.advance(steps);
    return stepper.state();
}

/// The state after `seconds` by an adaptive method.
template <class Which, class Model, class System, class... More>
typename Model::State end_of(const System& system, const typename Model::Scalar& seconds,
                             const typename Model::Scalar& tolerance, More... more) {
    Model model(system);
    typename Which::template Stepper<Model> stepper(model, Model::start(system), tolerance, more...);
    stepper.advance(seconds);
    return stepper.state();
}

/// An adaptive pair with fixed steps.
template <System Model, const auto& pair>
struct AtFixedStep {
    using State = typename Model::State;

    Model& model;
    State y;
    Quad h;
    Slopes<Model, pair> slopes{y};

    AtFixedStep(Model& m, const State& start, const Quad& step) : model(m), y(start), h(step) {}
    void advance(long steps) {
        for (long i = 0; i < steps; ++i) {
            model.rate(y, slopes[0]);
            slopes.template evaluate<1, pair.stages>(model, y, h);
            slopes.finish(y, h, y);
        }
    }
    const State& state() const { return y; }
};

template <class Adaptive>
struct Fixed {
    static constexpr Method method = Adaptive::method;
    template <System Model>
    using Stepper = AtFixedStep<Model, Adaptive::pair>;
};

template <class State>
double distance(const State& a, const State& b) {
    return static_cast<double>((a - b).cwiseAbs().maxCoeff());
}

/// The distance from the start after running forwards and backwards.
template <class Which, class Model>
double way_back(double step, long steps) {
    const auto p = unequal<double>();
    const typename Model::State start = Model::start(p);
    const auto half = start.size() / 2;
    auto end = after<Which, Model>(p, start, step, steps);
    end.tail(half) *= -1;
    end = after<Which, Model>(p, end, step, steps);
    end.tail(half) *= -1;
    return distance<typename Model::State>(end, start);
}

/// The largest errors of a run: energy (J), also in its first and its last tenth, rods (m), and J v (m²/s).
struct Errors {
    double energy = 0, early = 0, late = 0, rod = 0, slip = 0;
};
template <class Which, class Model>
Errors errors_of(const Pendulum<double>& p, double step, long steps, int samples = 1000) {
    Model model(p);
    typename Which::template Stepper<Model> stepper(model, Model::start(p), step);
    const auto bobs_now = [&] {
        const auto& y = stepper.state();
        if (y.size() == 2 * static_cast<Eigen::Index>(p.links())) return bobs_of_angles<double>(p, y);
        return bobs_of_particles<double>(p, y);
    };
    const double start = energy(bobs_now(), p.gravity);
    Errors errors;
    for (int sample = 0; sample < samples; ++sample) {
        stepper.advance(steps / samples);
        const auto bobs = bobs_now();
        const double error = std::abs(energy(bobs, p.gravity) - start);
        errors.energy = std::max(errors.energy, error);
        if (sample < samples / 10) errors.early = std::max(errors.early, error);
        if (sample >= samples - samples / 10) errors.late = std::max(errors.late, error);
        errors.rod = std::max(errors.rod, length_error(p, bobs));
        if constexpr (requires { model.w; }) {
            typename Model::Multipliers slip = model.w;
            const auto& y = stepper.state();
            model.constraint_velocity(y.head(y.size() / 2), y.tail(y.size() / 2), slip);
            errors.slip = std::max(errors.slip, slip.cwiseAbs().maxCoeff());
        }
    }
    return errors;
}

/// The order of the error at 0.5 s in the step, from three step sizes.
template <class Which, class Model, class System>
double measured_order(const System& p, long steps) {
    const auto run = [&](long n) { return after<Which, Model>(p, Model::start(p), Quad(0.5) / Quad(n), n); };
    const auto coarse = run(steps), middle = run(2 * steps), fine = run(4 * steps);
    return std::log2(distance(coarse, middle) / distance(middle, fine));
}

/// The difference between SᵀJS and J; S is the Jacobian at z = (θ1, θ2, p1, p2) of `map`, by differences in quad.
template <class Map>
double symplecticity_error(const Map& map, const State<Quad, 4>& z) {
    Eigen::Matrix<Quad, 4, 4> s, j;
    const Quad difference(1e-11);
    for (Eigen::Index i = 0; i < 4; ++i) {
        State<Quad, 4> less = z, more = z;
        less[i] -= difference;
        more[i] += difference;
        s.col(i) = (map(more) - map(less)) / (Quad(2) * difference);
    }
    j.setZero();
    for (Eigen::Index i = 0; i < 2; ++i) {
        j(i, i + 2) = Quad(1);
        j(i + 2, i) = Quad(-1);
    }
    return static_cast<double>(Quad((s.transpose() * j * s - j).cwiseAbs().maxCoeff()));
}

/// The same for a map of the states of two links in angles; their angles and rates begin the halves of the state.
template <class Model, class System, class Map>
double symplecticity_error_in_angles(const System& p, const Map& map) {
    Model model(p);
    Canonical<Model> form(model);
    const typename Model::State start = Model::start(p);
    const auto half = start.size() / 2;
    typename Model::State z = start;
    form.momenta(start, z);
    const auto links = [&](const auto& state) {
        State<Quad, 4> both;
        both << state.head(2), state.segment(half, 2);
        return both;
    };
    const auto one = [&](const State<Quad, 4>& from) {
        typename Model::State at = z, y = z;
        at.head(2) = from.head(2);
        at.segment(half, 2) = from.tail(2);
        form.velocities(at, y);
        y = map(y);
        form.momenta(y, at);
        return links(at);
    };
    return symplecticity_error(one, links(z));
}

/// The same for one step of a method.
template <class Which, class Model, class System>
double symplecticity_error(const System& p, const Quad& step) {
    return symplecticity_error_in_angles<Model>(
        p, [&](const typename Model::State& y) { return after<Which, Model>(p, y, step, 1); });
}

}  // namespace doppel
