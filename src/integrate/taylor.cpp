#include "integrate/taylor.hpp"

#include "base/error.hpp"
#include "numeric/compensated.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace doppel {
namespace {

template <class Scalar>
double epsilon_of() {
    return static_cast<double>(std::numeric_limits<Scalar>::epsilon());
}

/// 2^a within 0.3 % for |a| < 1000.
double power_of_two(double a) {
    const double whole = std::floor(a), part = a - whole;
    const auto power = std::bit_cast<double>((static_cast<std::int64_t>(whole) + 1023) << 52);
    return power * (1 + part * (0.6565 + 0.3435 * part));
}

}  // namespace

int taylor_order(double tolerance, double epsilon, int digits, int asked) {
    if (!(tolerance >= 4 * epsilon))
        throw bad_input("taylor: tolerance = {:.3g} cannot be met with {} digits; the finest is {:.1g}", tolerance,
                        digits, 4 * epsilon);
    const auto order = asked == 0 ? static_cast<int>(std::lround(10 - 0.5 * std::log(tolerance))) : asked;
    return std::clamp(order, watched_coefficients + 1, 64);
}

template <class S>
SeriesStepper<S>::SeriesStepper(std::unique_ptr<Series<S>> series, std::optional<AnySystem<State>> system,
                                const State& start, double tolerance, int order)
    : tolerance_(tolerance),
      order_(order),
      series_(std::move(series)),
      system_(std::move(system)),
      base_(start),
      lost_(State::Zero(start.size())),
      change_(start),
      out_(start) {
    if (has_events()) system_->take_modes(base_);
}

template <class S>
void SeriesStepper<S>::advance(const S& seconds) {
    add_compensated(offset_, offset_lost_, seconds);
    while (offset_ > step_) next_step(static_cast<double>(seconds));
    at(offset_);
}

template <class S>
void SeriesStepper<S>::take_step() {
    offset_ = step_;
    offset_lost_ = S(0);
    next_step(static_cast<double>(step_));
    at(S(0));
}

template <class S>
const typename SeriesStepper<S>::State& SeriesStepper<S>::at(const S& t) {
    series_->move(t, change_);
    out_ = base_ + (change_ + lost_);
    project(out_);
    return out_;
}

template <class S>
Bernstein SeriesStepper<S>::on_step(Eigen::Index coordinate) {
    std::vector<double> powers{static_cast<double>(at(S(0))[coordinate])};
    for (int k = 0; k <= order_; ++k) powers.push_back(series_->rate(k, coordinate) / (k + 1));
    auto path = Bernstein::of_powers(powers, static_cast<double>(step_));
    path.b.back() = static_cast<double>(at(step_)[coordinate]);
    return path;
}

/// Goes to the end of the step and expands the next one there. `seconds`, the interval asked for, tells when steps have
/// vanished.
template <class S>
void SeriesStepper<S>::next_step(double seconds) {
    if (steps_ > 0) {
        series_->move(step_, change_);
        for (Eigen::Index i = 0; i < base_.size(); ++i) add_compensated(base_[i], lost_[i], change_[i]);
        project(base_);
        add_compensated(offset_, offset_lost_, S(-step_));
        if (ends_at_event_) {
            system_->settle(base_);
            lost_.setZero();
        }
    }
    expand(seconds);
}

template <class S>
void SeriesStepper<S>::expand(double seconds) {
    series_->expand(base_);
    const double h = chosen_step();
    step_ = S(h);
    if (has_events()) {
        step_ = std::min(step_, system_->longest_step());
        ends_at_event_ = ends_at_event();
    }
    if (!(h > epsilon_of<S>() * seconds))
        throw method_failed(
            "taylor: a step of {:.3g} s is all that tolerance = {:.3g} allows, too little to get on; "
            "the motion has a singularity there, which no explicit method passes",
            h, tolerance_);
    if (steps_ == 0 || step_ < smallest_) smallest_ = step_;
    ++steps_;
}

/// Whether the system has an event in the step, which then ends there.
template <class S>
bool SeriesStepper<S>::ends_at_event() {
    const auto event = first_event(*system_, step_, [&](const S& t) -> const State& {
        series_->move(t, change_);
        change_ = base_ + (change_ + lost_);
        return change_;
    });
    if (!event) return false;
    stall_.note(*event > S(4) * std::numeric_limits<S>::epsilon() * step_);
    step_ = *event;
    return true;
}

template <class S>
double SeriesStepper<S>::chosen_step() {
    constexpr double growth = 2;
    double exponent = 900;  // log2 h
    for (int k = order_ - watched_coefficients + 1; k <= order_; ++k) {
        const double room = series_->log2_room(tolerance_, k);
        if (std::isnan(room))
            throw method_failed("taylor: coefficient {} of the series is not finite; the motion has blown up", k);
        exponent = std::min(exponent, room / k);
    }
    const double longest = series_->longest_step();
    free_step_ =
        std::min({power_of_two(std::max(exponent, -900.0)), longest, steps_ == 0 ? longest : growth * free_step_});
    return series_->first_event(free_step_);
}

template class SeriesStepper<double>;
template class SeriesStepper<Quad>;

}  // namespace doppel
