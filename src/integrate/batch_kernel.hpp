#pragma once

#include "integrate/euler.hpp"
#include "integrate/runge_kutta.hpp"
#include "numeric/lanes.hpp"
#include "physics/pendulum.hpp"

#include <cstddef>

namespace doppel {

// Declarations shared by integrate/batch.cpp and the code for each register width (integrate/batch_width.cpp). No
// function of a common type may be compiled in the latter.

/// Pendulums with the same number of links.
struct BatchRequest {
    const Pendulum<double>* members;
    std::size_t count;
    double step;       // s
    bool constraints;  // as particles with constraints; otherwise in angles
    bool by_rk4;       // otherwise by Euler
};

/// Some members that are integrated side by side.
class BatchBlock {
public:
    virtual ~BatchBlock();
    virtual void advance(long steps) = 0;
    virtual std::size_t dimensions() const = 0;
    /// Writes the state of member `lane` of the block, dimensions() numbers, to `entries`.
    virtual void read(std::size_t lane, double* entries) const = 0;
};

/// The members of one block: two registers, so that one is computed while the other waits for results.
inline constexpr int batch_block(int width) {
    return 2 * width;
}

/// The block of the members from `first` on, filled up with copies of the last one, for registers of `width` doubles: 2
/// on every processor, 4 with AVX2, 8 with AVX-512 (cmake/widths.cmake). The caller deletes it.
template <int width>
BatchBlock* make_batch_block(const BatchRequest& request, std::size_t first);
template <>
BatchBlock* make_batch_block<2>(const BatchRequest& request, std::size_t first);
template <>
BatchBlock* make_batch_block<4>(const BatchRequest& request, std::size_t first);
template <>
BatchBlock* make_batch_block<8>(const BatchRequest& request, std::size_t first);

template <class Model, class Which>
class SteppedBlock final : public BatchBlock {
public:
    using Scalar = typename Model::Scalar;
    using Stepper = typename Which::template Stepper<Model>;

    SteppedBlock(const Pendulum<Scalar>& pendulum, double step)
        : model_(pendulum), stepper_(model_, Model::start(pendulum), Scalar(step)) {}

    void advance(long steps) override { stepper_.advance(steps); }
    std::size_t dimensions() const override { return static_cast<std::size_t>(stepper_.state().size()); }
    void read(std::size_t lane, double* entries) const override {
        const auto& y = stepper_.state();
        for (Eigen::Index i = 0; i < y.size(); ++i) entries[i] = y[i][static_cast<int>(lane)];
    }

private:
    Model model_;
    Stepper stepper_;
};

/// The members from `first` on, side by side.
template <class Pack>
Pendulum<Pack> pendulum_of(const BatchRequest& request, std::size_t first) {
    const std::size_t links = request.members->links();
    Pendulum<Pack> all;
    for (auto* of : {&all.mass, &all.length, &all.angle, &all.rate}) of->resize(links);
    for (int lane = 0; lane < Pack::width; ++lane) {
        const std::size_t member = first + static_cast<std::size_t>(lane);
        const auto& one = request.members[member < request.count ? member : request.count - 1];
        for (std::size_t j = 0; j < links; ++j) {
            all.mass[j].set(lane, one.mass[j]);
            all.length[j].set(lane, one.length[j]);
            all.angle[j].set(lane, one.angle[j]);
            all.rate[j].set(lane, one.rate[j]);
        }
        all.gravity.set(lane, one.gravity);
    }
    return all;
}

template <class Model>
BatchBlock* with_method(const BatchRequest& request, const Pendulum<typename Model::Scalar>& pendulum) {
    if (request.by_rk4) return new SteppedBlock<Model, Rk4>(pendulum, request.step);
    return new SteppedBlock<Model, Euler>(pendulum, request.step);
}

}  // namespace doppel
