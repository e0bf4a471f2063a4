#pragma once

#include "numeric/quad.hpp"
#include "physics/bob.hpp"

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

/// The errors of a run: energy (J) and rods (m), the largest in its first and its last tenth.
struct Errors {
    double early = 0, late = 0, rod = 0;
};
template <class Which, class Model>
Errors errors_of(const Pendulum<double>& p, double step, long steps) {
    Model model(p);
    typename Which::template Stepper<Model> stepper(model, Model::start(p), step);
    const auto bobs_now = [&] {
        const auto& y = stepper.state();
        if (y.size() == 2 * static_cast<Eigen::Index>(p.links())) return bobs_of_angles<double>(p, y);
        return bobs_of_particles<double>(p, y);
    };
    const double start = energy(bobs_now(), p.gravity);
    Errors errors;
    for (int part = 0; part < 1000; ++part) {
        stepper.advance(steps / 1000);
        const auto bobs = bobs_now();
        const double error = std::abs(energy(bobs, p.gravity) - start);
        if (part < 100) errors.early = std::max(errors.early, error);
        if (part >= 900) errors.late = std::max(errors.late, error);
        errors.rod = std::max(errors.rod, length_error(p, bobs));
    }
    return errors;
}

/// The order of the error at 0.5 s in the step, from three step sizes.
template <class Which, class Model>
double measured_order(std::size_t links, long steps) {
    const auto p = unequal<Quad>(links);
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

}  // namespace doppel
