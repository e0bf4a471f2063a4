#include "figure/quantity.hpp"

#include "analysis/difference.hpp"
#include "figure/kinds.hpp"
#include "numeric/roots.hpp"
#include "scene/captions.hpp"

#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

QuantityWords words_of(Quantity quantity, const std::string& seconds) {
    switch (quantity) {
        case Quantity::divergence:
            return {.label = fmt::format("average of ln(d/d₀) over {} s", seconds),
                    .columns = {"average_log_ratio"},
                    .none = "broke down",
                    .none_is_bad = true};
        case Quantity::exponent:
            return {.label = "largest Lyapunov exponent, 1/s",
                    .columns = {"exponent_per_s", "exponent_uncertainty_per_s", "exponent_unsettled"},
                    .is_of_side_a = true,
                    .method = "tangent equations by Dormand–Prince 8"};
        case Quantity::flip_time:
            return {.label = "time to the first flip, s",
                    .columns = {"flip_time_s"},
                    .logarithmic = true,
                    .none = fmt::format("no flip within {} s", seconds),
                    .is_of_side_a = true};
        case Quantity::distance_at_end:
            return {.label = fmt::format("distance after {} s", seconds),
                    .columns = {"distance_at_end"},
                    .logarithmic = true,
                    .none = "broke down",
                    .none_is_bad = true};
        case Quantity::energy_error:
            return {.label = "largest energy error, of the potential range",
                    .columns = {"energy_error"},
                    .logarithmic = true,
                    .none = "broke down",
                    .none_is_bad = true,
                    .is_of_side_a = true};
        case Quantity::deviation:
            return {.label = fmt::format("how far an angle goes from its start within {} s, °", seconds),
                    .columns = {"deviation_deg"},
                    .none = "broke down",
                    .none_is_bad = true,
                    .is_of_side_a = true};
        case Quantity::parting_time:
            return {.label = "time at which the two part, s",
                    .columns = {"parting_time_s"},
                    .none = fmt::format("together for {} s", seconds)};
    }
    return {};
}

/// How all pairs are stepped in lanes, where they can be: plain chains in double by the methods of Batch.
std::optional<TwinRun> lanes_of(const Scene& scene) {
    const auto serves = [](const Side& side) {
        const auto& motion = side.motion;
        return !side.choice && !motion.physical && motion.model != Model::mechanism &&
               motion.precision == Precision::in_double && motion.stabilise == Stabilise::none &&
               Batch::serves(motion.method, motion.chain->links());
    };
    const auto &a = scene.a.motion, &b = scene.b.motion;
    if (!serves(scene.a) || !serves(scene.b) || a.chain->links() != b.chain->links()) return std::nullopt;
    return TwinRun{a, b, scene.samples};
}

/// A quantity of distances, from those at all samples in their order.
class DistanceWatch {
public:
    explicit DistanceWatch(Quantity quantity) : quantity_(quantity) {}
    void add(double time, double distance) {
        last_ = distance;
        if (quantity_ == Quantity::divergence) mean_.add(distance);
        if (quantity_ == Quantity::parting_time) parting_.add(time, distance);
    }
    double value() const {
        if (quantity_ == Quantity::divergence) return mean_.value();
        if (!std::isfinite(last_)) return NAN;
        return quantity_ == Quantity::distance_at_end ? last_ : parting_.since().value_or(NAN);
    }

private:
    Quantity quantity_;
    AverageLogRatio mean_;
    Parting parting_;
    double last_ = NAN;
};

/// The first flip of any link, from the samples of a motion; between two of them an angle is a cubic.
class FlipWatch {
public:
    /// The time, if one flips by then.
    std::optional<double> add(double time, const Bobs<double>& bobs) {
        double first = never;
        for (std::size_t i = 0; i < bobs.size() && before_.size() == bobs.size(); ++i)
            for (const double sense : {1.0, -1.0}) first = std::min(first, flip(time, before_[i], bobs[i], sense));
        for (const auto& bob : bobs)
            if (before_.empty() && std::abs(bob.theta) > pi) first = 0;
        before_ = bobs;
        before_s_ = time;
        return first < never ? std::optional(first) : std::nullopt;
    }

private:
    double flip(double time, const Bob<double>& from, const Bob<double>& to, double sense) const {
        const double h = time - before_s_, p = sense * from.theta - pi, v = sense * from.omega;
        const double q = sense * to.theta - pi, w = sense * to.omega;
        const auto rises = Bernstein{{p, p + h / 3 * v, q - h / 3 * w, q}, h}.rises();
        if (rises.empty()) return never;
        const double second = (3 * (q - p) / h - 2 * v - w) / h, third = (v + w - 2 * (q - p) / h) / (h * h);
        struct Beyond {
            double value, rate;  // rad beyond the upright, rad/s
        };
        return before_s_ + root(rises.front(), [&](double t) {
                   return Beyond{p + t * (v + t * (second + t * third)), v + t * (2 * second + t * 3 * third)};
               });
    }

    Bobs<double> before_;
    double before_s_ = 0;
};

}  // namespace

std::optional<std::string> nothing_drawn(Quantity quantity, const QuantityWords& words, const Drawn& drawn,
                                         const std::string& pairs, const std::string& seconds) {
    if (words.logarithmic ? drawn.above_0 : drawn.any) return std::nullopt;
    const auto name = fmt::format(
        "{} {}", quantity == Quantity::exponent || quantity == Quantity::energy_error ? "an" : "a", name_of(quantity));
    if (drawn.any)
        return fmt::format("none of the {} pairs has {} above 0, which alone a logarithmic scale can show", pairs,
                           name);
    if (words.none_is_bad)
        return fmt::format(
            "every one of the {} pairs broke down within {} s; take a finer step or tolerance, or a shorter "
            "scene.duration_s",
            pairs, seconds);
    return fmt::format("none of the {} pairs has {}: {}{}", pairs, name, words.none,
                       quantity == Quantity::parting_time ? ", or apart from the start" : "");
}

Measurement::Measurement(const TomlReader& table, std::string_view key, Quantity quantity, const Preset& pair,
                         bool alike, double exponent_duration_s)
    : quantity_(quantity),
      words_(words_of(quantity, pair.duration_s.text())),
      exponent_{.duration_s = exponent_duration_s},
      flip_{pair.duration_s.value(), flip_tolerance(pair.duration_s.value())} {
    const auto& a = pair.a;
    if (quantity == Quantity::exponent && a.is_mechanism())
        throw table.fault(key, "is that of a plain chain, without forces and constraints of its own");
    if (quantity == Quantity::exponent && a.physical.has_coulomb())
        throw table.fault(key,
                          "is that of a smooth motion; joints with joint_coulomb_N_m come to rest and let go again");
    if (quantity == Quantity::deviation && !a.particles.empty())
        throw table.fault(key, "\"deviation\" is of a chain, whose rods have angles");
    if (quantity == Quantity::flip_time && !a.particles.empty())
        throw table.fault(key, "\"flip_time\" is of a chain, whose rods have angles");
    if (is_of_distance(quantity) && differ_in_kind(a, pair.b))
        throw table.fault(key, "\"{}\" takes sides of as many masses", name_of(quantity));
    const auto scene = make_scene(pair);
    if (quantity == Quantity::energy_error && !scene.a.has_energy_error)
        throw table.fault(key, "\"energy_error\" takes a system that keeps its energy; a spring is damped");
    flips_in_lanes_ = quantity == Quantity::flip_time && !a.is_mechanism() && a.physical.is_none() && a.links() == 2;
    if (flips_in_lanes_) words_.method = fmt::format("Taylor series, tolerance {}", scientific(flip_.tolerance));
    if (alike && quantity != Quantity::exponent && quantity != Quantity::flip_time && quantity != Quantity::deviation)
        run_ = lanes_of(scene);
    if (run_ && !is_of_distance(quantity)) run_->b = run_->a;
}

std::size_t Measurement::together(bool shared) const {
    if (flips_in_lanes_) return 256;
    if (!run_) return 1;
    // a pendulum that two neighbours share is stepped once
    const bool is_shared = shared || !is_of_distance(quantity_);
    return twins_block() / (is_shared ? 1 : 2) - (shared && is_of_distance(quantity_) ? 1 : 0);
}

void Measurement::append(std::span<const Preset> pairs, std::span<TrialNumbers> into,
                         const std::atomic<bool>& stop) const {
    if (flips_in_lanes_) return append_flips(pairs, into, stop);
    if (run_) return append_in_lanes(pairs, into, stop);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (quantity_ != Quantity::exponent) {
            into[i].push_back(watched(pairs[i], stop));
            continue;
        }
        const auto& a = pairs[i].a;
        const auto exponent = a.physical.is_none() ? largest_exponent(chain_of(a).cast<double>(), exponent_, stop)
                                                   : largest_exponent(physical_of(a).cast<double>(), exponent_, stop);
        into[i].insert(into[i].end(), {exponent.value, exponent.uncertainty, exponent.is_settled ? 0.0 : 1.0});
    }
}

void Measurement::append_flips(std::span<const Preset> pairs, std::span<TrialNumbers> into,
                               const std::atomic<bool>& stop) const {
    std::vector<Pendulum<double>> chains;
    for (const auto& pair : pairs) chains.push_back(chain_of(pair.a).cast<double>());
    std::vector<double> times(pairs.size());
    first_flips(chains, flip_, times, stop);
    for (std::size_t i = 0; i < pairs.size(); ++i) into[i].push_back(times[i]);
}

void Measurement::append_in_lanes(std::span<const Preset> pairs, std::span<TrialNumbers> into,
                                  const std::atomic<bool>& stop) const {
    std::vector<Twins> twins;
    for (const auto& pair : pairs) {
        const auto a = chain_of(pair.a).cast<double>();
        twins.push_back({a, is_of_distance(quantity_) ? chain_of(pair.b).cast<double>() : a});
    }
    if (is_of_distance(quantity_)) {
        std::vector<DistanceWatch> watches(pairs.size(), DistanceWatch(quantity_));
        const double interval = run_->a.sample_interval.value();
        const auto watch = [&](std::size_t i, long n, const Bobs<double>& a, const Bobs<double>& b) {
            watches[i].add(static_cast<double>(n) * interval, state_space_distance(a, b));
        };
        step_twins(twins, *run_, watch, stop);
        for (std::size_t i = 0; i < pairs.size(); ++i) into[i].push_back(watches[i].value());
        return;
    }
    std::vector<double> start(pairs.size()), worst(pairs.size());
    const auto watch = [&](std::size_t i, long n, const Bobs<double>& a, const Bobs<double>&) {
        const double now = energy(a, twins[i].a.gravity);
        if (n == 0) start[i] = now;
        const double error = std::abs(now - start[i]);
        if (!(error <= worst[i])) worst[i] = error;  // NaN stays
    };
    step_twins(twins, *run_, watch, stop);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double error = worst[i] / twins[i].a.potential_range();
        into[i].push_back(std::isfinite(error) ? error : NAN);
    }
}

/// By the sample loop of the films: any model, method and precision.
double Measurement::watched(const Preset& pair, const std::atomic<bool>& stop) const {
    const auto scene = make_scene(pair, stop);
    try {
        if (is_of_distance(quantity_)) {
            PairRun run(scene);
            DistanceWatch watch(quantity_);
            for (long n = 0; n <= scene.samples; ++n) watch.add(scene.time(n), run.next(stop).distance);
            return watch.value();
        }
        SideRun run(scene, scene.a, 'a');
        FlipWatch flips;
        Bobs<double> start;
        double worst = 0, furthest = 0;
        for (long n = 0; n <= scene.samples; ++n) {
            const auto seen = run.next(stop);
            if (n == 0) start = seen.bobs;
            for (std::size_t i = 0; i < start.size(); ++i)
                furthest = std::max(furthest, std::abs(seen.bobs[i].theta - start[i].theta));
            worst = std::max(worst, std::abs(seen.energy_change));
            if (quantity_ != Quantity::flip_time) continue;
            if (const auto time = flips.add(scene.time(n), seen.bobs)) return *time;
        }
        if (quantity_ == Quantity::deviation) return furthest * (180 / pi);
        return quantity_ == Quantity::flip_time ? never : worst / scene.a.energy_unit;
    } catch (const BreakDown&) {
        return NAN;
    }
}

bool Measurement::fits(std::span<const double> numbers) const {
    if (numbers.size() != this->numbers()) return false;
    if (quantity_ == Quantity::exponent) return all_finite(numbers);
    if (quantity_ == Quantity::flip_time) return !(numbers[0] < 0);  // broken down: NaN
    return !std::isinf(numbers[0]);
}

}  // namespace doppel
