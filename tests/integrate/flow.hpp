#pragma once

#include "numeric/quad.hpp"
#include "physics/pendulum.hpp"

namespace doppel {

/// The state so many steps after `start`.
template <class Which, class Model>
typename Model::State after(const Pendulum<typename Model::Scalar>& p, const typename Model::State& start,
                            const typename Model::Scalar& step, long steps) {
    Model model(p);
    typename Which::template Stepper<Model> stepper(model, start, step);
    stepper.advance(steps);
    return stepper.state();
}

template <class State>
double distance(const State& a, const State& b) {
    return static_cast<double>((a - b).cwiseAbs().maxCoeff());
}

/// How far SᵀJS is from J, where S is the Jacobian at z = (θ1, θ2, p1, p2) of `map`, by differences in quad.
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
