#include "figure/quantity.hpp"

#include "analysis/difference.hpp"
#include "analysis/stability.hpp"
#include "base/machine.hpp"
#include "numeric/roots.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace doppel {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

QuantityWords words_of(Quantity quantity, const std::string& seconds, const StroboscopeSpec& stroboscope) {
    // in the order of Quantity; {0} is the duration, {1} the number of the stroboscope's link
    const std::array<QuantityWords, names_of<Quantity>.size()> all{{
        {.label = "mean of ln(d/d₀) over {0} s", .columns = {"average_log_ratio"}, .short_label = "mean of ln(d/d₀)"},
        {.label = "largest Lyapunov exponent, 1/s",
         .columns = {"exponent_per_s", "exponent_uncertainty_per_s"},
         .none = "",
         .method = "tangent equations by Dormand–Prince 8(5,3)",
         .short_label = "Lyapunov exponent",
         .last_column = "exponent_unsettled"},
        {.label = "time to the first flip, s",
         .columns = {"flip_time_s"},
         .logarithmic = true,
         .none = "no flip within {0} s"},
        {.label = "distance after {0} s", .columns = {"distance_at_end"}, .logarithmic = true},
        {.label = "greatest distance within {0} s", .columns = {"greatest_distance"}, .logarithmic = true},
        {.label = "largest energy error, of the potential range", .columns = {"energy_error"}, .logarithmic = true},
        {.label = "time of divergence, s", .columns = {"parting_time_s"}, .none = "together for {0} s"},
        {.label = "maximum deviation of an angle within {0} s, °", .columns = {"deviation_deg"}},
        {.label = "period, s", .columns = {"period_s"}, .none = "no whole period within {0} s"},
        {.label = "rate ω{1} at each drive period, rad/s",
         .columns = {"theta_rad", "omega_rad_per_s"},
         .rows = static_cast<std::size_t>(stroboscope.periods)},
        {.label = "CPU time of an Euler step, ns",
         .columns = {"angles_step_ns", "constraints_step_ns"},
         .curves = {"in angles", "with constraints"},
         .method = "explicit Euler"},
        {.label = "greatest energy error in {0} s, of the energy released",
         .columns = {"energy_error"},
         .logarithmic = true,
         .none = "failed run",
         .none_is_bad = true,
         .range = Range{1e-12, failure_error}},
        {.label = "greatest distance within {0} s",
         .columns = {"step_s", "distance", "steps"},
         .logarithmic = true,
         .drawn = 1},
    }};
    auto words = all.at(static_cast<std::size_t>(quantity));
    for (auto* text : {&words.label, &words.none})
        *text = fmt::format(fmt::runtime(*text), seconds, subscript(static_cast<std::size_t>(stroboscope.link)));
    if (words.short_label.empty()) words.short_label = words.label.substr(0, words.label.rfind(", "));
    return words;
}

/// CPU time per step of explicit Euler in double, ns, with angles and with constraints. It is the minimum over some
/// rounds in turn, so that other load on the machine does not matter.
TrialNumbers step_costs(const SideSpec& side, const std::atomic<bool>& stop) {
    constexpr int rounds = 12;
    std::vector<std::unique_ptr<Motion>> motions;
    for (const auto model : {Model::angles, Model::constraints})
        motions.push_back(make_motion({.chain = chain_of(side), .model = model}));
    TrialNumbers minimum(motions.size(), std::numeric_limits<double>::max());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < motions.size(); ++i) {
            const double start = seconds_of(CLOCK_THREAD_CPUTIME_ID);
            motions[i]->advance(stop);
            const double spent = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start;
            minimum[i] = std::min(minimum[i], 1e9 * spent / static_cast<double>(MotionSpec().steps_per_sample));
        }
    return minimum;
}

/// How pairs can be integrated in lanes, if they can be: plain chains in double by the methods of Batch.
std::optional<PairBatchSpec> lanes_of(const Scene& scene) {
    const auto supports = [](const Side& side) {
        const auto& motion = side.motion;
        return !side.choice && !motion.physical && motion.model != Model::mechanism &&
               motion.precision == Precision::in_double && motion.stabilise == Stabilise::none &&
               Batch::supports(motion.method, motion.chain->links());
    };
    const auto &a = scene.a.motion, &b = scene.b.motion;
    if (!supports(scene.a) || !supports(scene.b) || a.chain->links() != b.chain->links()) return std::nullopt;
    return PairBatchSpec{a, b, scene.samples};
}

/// A quantity computed from the distances of a pair, or from the changes of its energy, J, at all samples in order.
class Watch {
public:
    explicit Watch(Quantity quantity) : quantity_(quantity) {}
    void add(double time, double value) {
        last_ = value;
        if (!(value <= largest_)) largest_ = value;  // keeps NaN
        if (quantity_ == Quantity::divergence) mean_.add(value);
        if (quantity_ == Quantity::parting_time) divergence_.add(time, value);
    }
    double greatest() const { return largest_; }
    double value() const {
        if (quantity_ == Quantity::divergence) return mean_.value();
        if (!std::isfinite(last_)) return NAN;
        if (quantity_ == Quantity::greatest_distance) return largest_;
        if (quantity_ == Quantity::distance_at_end) return last_;
        const auto time = divergence_.since();
        return time ? *time : NAN;
    }

private:
    Quantity quantity_;
    AverageLogRatio mean_;
    Divergence divergence_;
    double last_ = NAN, largest_ = 0;
};

/// Finds the first flip of any link, or the period of a single link, from samples. Between samples angles are cubic.
class FlipWatch {
public:
    /// Adds a sample. Returns the time of the first flip, if one has occurred.
    std::optional<double> add(double time, const Bobs<double>& bobs) {
        double first = never;
        for (std::size_t i = 0; i < bobs.size() && before_.size() == bobs.size(); ++i)
            for (const double sense : {1.0, -1.0}) first = std::min(first, rise(time, before_[i], bobs[i], sense, pi));
        for (const auto& bob : bobs)
            if (before_.empty() && std::abs(bob.theta) > pi) first = 0;
        keep(time, bobs);
        return first < never ? std::optional(first) : std::nullopt;
    }
    /// Records when the link passes the downward vertical, in whatever turn, in the direction of the first passage.
    void add_swing(double time, const Bobs<double>& bobs) {
        for (const double sense : {1.0, -1.0}) {
            if (before_.empty() || sense * sense_ < 0) continue;
            const double turns = std::round((before_[0].theta + bobs[0].theta) / (4 * pi));
            const double passed = rise(time, before_[0], bobs[0], sense, sense * 2 * pi * turns);
            if (passed == never) continue;
            if (passes_++ == 0) first_s_ = passed, sense_ = sense;
            last_s_ = passed;
        }
        keep(time, bobs);
    }
    /// The mean period; NaN if no period is complete.
    double period() const { return passes_ > 1 ? (last_s_ - first_s_) / (passes_ - 1) : NAN; }

private:
    void keep(double time, const Bobs<double>& bobs) {
        before_ = bobs;
        before_s_ = time;
    }
    /// The time at which the angle times `sense` rises through `level`.
    double rise(double time, const Bob<double>& from, const Bob<double>& to, double sense, double level) const {
        const double h = time - before_s_, p = sense * from.theta - level, v = sense * from.omega;
        const double q = sense * to.theta - level, w = sense * to.omega;
        const auto rises = Bernstein{{p, p + h / 3 * v, q - h / 3 * w, q}, h}.rises();
        if (rises.empty()) return never;
        const double second = (3 * (q - p) / h - 2 * v - w) / h, third = (v + w - 2 * (q - p) / h) / (h * h);
        struct Beyond {
            double value, rate;  // rad beyond the level; rad/s
        };
        return before_s_ + root(rises.front(), [&](double t) {
                   return Beyond{p + t * (v + t * (second + t * third)), v + t * (2 * second + t * 3 * third)};
               });
    }

    Bobs<double> before_;
    double before_s_ = 0;
    int passes_ = 0;
    double sense_ = 0, first_s_ = 0, last_s_ = 0;  // sense 1: to the right
};

/// The drive frequency of a side, Hz; nothing without a drive, or with several frequencies.
std::optional<Rational> drive_of(const SideSpec& side) {
    std::vector<Quad> all;
    if (side.physical.pivot.amplitude_m != 0) all.push_back(side.physical.pivot.frequency_hz);
    for (const auto& torque : side.physical.torques) all.push_back(torque.frequency_hz);
    if (all.empty() || std::ranges::any_of(all, [&](const Quad& f) { return f != all[0]; })) return {};
    const auto frequency = parse_rational(text_of(all[0]));
    return frequency && frequency->numerator > 0 ? frequency : std::nullopt;
}

/// Angle, rad in −π…π, and rate, rad/s, of the link of side a at the end of each period except the transient ones. NaN
/// from the failure of the motion on. Throws Error (exit 130) soon after `stop` is set.
TrialNumbers stroboscope(const Scene& scene, const StroboscopeSpec& spec, const std::atomic<bool>& stop) {
    auto motion_spec = scene.a.motion;
    motion_spec.sample_interval = *quotient({1, 1}, *drive_of(scene.preset.a));
    if (!scene.a.method.adaptive)  // steps that fit the drive period
        motion_spec.steps_per_sample =
            std::max(1L, std::lround(motion_spec.sample_interval.value() / scene.a.step.value()));
    TrialNumbers numbers;
    try {
        const auto motion = make_motion(motion_spec);
        for (int n = 0; n < spec.transient_periods; ++n) motion->advance(stop);
        for (int n = 0; n < spec.periods; ++n) {
            motion->advance(stop);
            const auto bob = motion->observe().bobs[static_cast<std::size_t>(spec.link - 1)];
            numbers.push_back(std::remainder(bob.theta, 2 * pi));
            numbers.push_back(bob.omega);
        }
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
    }
    numbers.resize(2 * static_cast<std::size_t>(spec.periods), NAN);
    return numbers;
}

/// Throws Error (exit 2) at the table's `key` or `link` without exactly one drive frequency of at most 18 digits, or such
/// a link.
void require_drive(const TomlReader& table, std::string_view key, const StroboscopeSpec& spec, const SideSpec& side) {
    if (static_cast<std::size_t>(spec.link) > side.links())
        throw table.error("link", "must be 1 to {}, the number of links; it is {}", side.links(), spec.link);
    if (!drive_of(side))
        throw table.error(
            key,
            "\"stroboscopic\" is of a pendulum that is driven, [system.pivot] or [[system.torque]], at one "
            "frequency of at most 18 digits");
}

/// As Measurement's constructor, for the scenes of the first and last pair.
void require_difference(const TomlReader& table, Quantity quantity, const InCommon& all,
                        const std::array<Scene, 2>& ends) {
    if (!is_of_distance(quantity)) return;
    const auto name = name_of(quantity);
    const auto& difference = all.difference;
    const auto same = std::ranges::count_if(ends, are_one);
    const bool are_all = same == std::ssize(ends);
    if (are_all && all.is_of_one_side)
        throw table.error("quantity", "\"{}\" compares the two sides, which are the same; let [b] differ from [a]",
                          name);
    if (are_all || (difference != 0 && same > 0))
        throw table.error(
            "difference",
            "must make the two pendulums of a pair differ, because \"{}\" compares them; {}: give {}grid.difference",
            name,
            difference == 0 ? "it is 0, and both sides are the same" : text_of(difference) + " is lost in rounding",
            difference == 0 ? "" : "a greater ");
    const auto start = [](const Scene& scene) -> double {
        try {
            return PairRun(scene).next(false).distance;
        } catch (const RunFailure&) {  // reported when the pair is run
            return NAN;
        }
    };
    if (quantity == Quantity::divergence &&
        std::ranges::all_of(ends, [&](const Scene& scene) { return start(scene) == 0; }))
        throw table.error(
            "quantity",
            "\"divergence\" needs sides that are released differently: there is no ratio to a distance of "
            "0; \"distance_at_end\" and \"parting_time\" need none");
}

}  // namespace

std::string seconds_text(const Preset& pair) {
    return fmt::format("{:.10g}", pair.duration_s.value());
}

Measurement::Measurement(const TomlReader& table, std::string_view key, Quantity quantity,
                         const std::array<Preset, 2>& ends, const InCommon& all, const QuantityOptions& options)
    : quantity_(quantity),
      words_(words_of(quantity, seconds_text(ends[0]), options.stroboscope)),
      options_(options),
      flip_{ends[0].duration_s.value(), options.flip_tolerance.value_or(flip_tolerance(ends[0].duration_s.value()))} {
    const auto& a = ends[0].a;
    const bool is_ideal = quantity == Quantity::step_cost || quantity == Quantity::stability;
    if ((is_ideal || quantity == Quantity::exponent) && (a.is_mechanism() || (is_ideal && !all.are_ideal)))
        throw table.error(key, "needs a plain chain, without further forces and constraints");
    if (quantity == Quantity::exponent && a.physical.has_coulomb())
        throw table.error(key, "needs a smooth motion; joints with joint_coulomb_N_m stick and slip");
    const bool is_of_angles =
        quantity == Quantity::deviation || quantity == Quantity::flip_time || quantity == Quantity::period;
    if (is_of_angles && !a.particles.empty())
        throw table.error(key, "\"{}\" needs a chain, whose rods have angles", name_of(quantity));
    if (quantity == Quantity::period && a.links() != 1)
        throw table.error(key, "\"period\" needs one link; there are {}", a.links());
    if (is_of_distance(quantity) && differ_in_kind(a, ends[0].b))
        throw table.error(key, "\"{}\" needs sides with the same number of masses", name_of(quantity));
    if (quantity == Quantity::stroboscopic) require_drive(table, key, options_.stroboscope, a);
    const auto scene = make_scene(ends[0]);
    if (quantity == Quantity::stability &&
        !(released_energy(chain_of(a).cast<double>()) > 1e-10 * chain_of(a).cast<double>().potential_range()))
        throw table.error(key, "\"stability\" needs a release with more energy than hanging at rest");
    if (quantity == Quantity::energy_error && !scene.a.has_energy_error)
        throw table.error(key, "\"energy_error\" needs a system that conserves energy; a spring is damped");
    const bool has_lanes = all.are_ideal && all.have_same_links;
    flips_in_lanes_ = quantity == Quantity::flip_time && has_lanes && !all.are_compared_by_method &&
                      !a.is_mechanism() && a.links() == 2;
    if (flips_in_lanes_) words_.method = fmt::format("Taylor series, tolerance {}", scientific(flip_.tolerance));
    if (has_lanes && all.have_same_method && (is_of_distance(quantity) || quantity == Quantity::energy_error))
        run_ = lanes_of(scene);
    if (run_ && !is_of_distance(quantity)) run_->b = run_->a;
    require_difference(table, quantity, all, {scene, make_scene(ends[1])});
    if (quantity == Quantity::stroboscopic) require_drive(table, key, options_.stroboscope, ends[1].a);
}

std::size_t Measurement::together(bool shared) const {
    if (flips_in_lanes_) return 256;
    if (quantity_ == Quantity::stability) return 128;
    if (!run_) return 1;
    // neighbours share a pendulum, which is integrated once
    const bool is_shared = shared || !is_of_distance(quantity_);
    return pendulums_together / (is_shared ? 1 : 2) - (shared && is_of_distance(quantity_) ? 1 : 0);
}

void Measurement::append(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const {
    if (flips_in_lanes_) return append_flips(pair, into, stop);
    if (run_) return append_in_lanes(pair, into, stop);
    if (quantity_ == Quantity::stability) return append_energies(pair, into, stop);
    for (std::size_t i = 0; i < into.size(); ++i) {
        const auto numbers = found(pair(i), stop);
        into[i].insert(into[i].end(), numbers.begin(), numbers.end());
    }
}

TrialNumbers Measurement::found(const Preset& pair, const std::atomic<bool>& stop) const {
    const auto& a = pair.a;
    if (quantity_ == Quantity::step_cost) return step_costs(a, stop);
    if (quantity_ == Quantity::stroboscopic) return stroboscope(make_scene(pair, stop), options_.stroboscope, stop);
    if (quantity_ != Quantity::exponent) return watched(pair, stop);
    const ExponentSpec spec{.duration_s = options_.exponent_duration_s};
    const auto exponent = a.physical.is_none() ? largest_exponent(chain_of(a).cast<double>(), spec, stop)
                                               : largest_exponent(physical_of(a).cast<double>(), spec, stop);
    return {exponent.value, exponent.uncertainty, exponent.is_settled ? 0.0 : 1.0};
}

void Measurement::append_flips(const PairAt& pair, std::span<TrialNumbers> into, const std::atomic<bool>& stop) const {
    std::vector<Pendulum<double>> chains;
    for (std::size_t i = 0; i < into.size(); ++i) {
        const auto& side = pair(i).a;
        auto& chain = chains.emplace_back(chain_of(side).cast<double>());
        // as in cells of a map, in double: mirror images have exactly opposite angles
        for (std::size_t k = 0; k < side.links(); ++k) chain.angle[k] = radians(static_cast<double>(side.angle_deg[k]));
    }
    std::vector<double> times(into.size());
    first_flips(chains, flip_, times, stop);
    for (std::size_t i = 0; i < into.size(); ++i) into[i].push_back(times[i]);
}

void Measurement::append_in_lanes(const PairAt& pair, std::span<TrialNumbers> into,
                                  const std::atomic<bool>& stop) const {
    const bool is_distance = is_of_distance(quantity_);
    std::vector<PendulumPair> pairs;
    for (std::size_t i = 0; i < into.size(); ++i) {
        const auto& sides = pair(i);
        const auto a = chain_of(sides.a).cast<double>();
        pairs.push_back({a, is_distance ? chain_of(sides.b).cast<double>() : a});
    }
    std::vector<double> start(into.size());  // energy, J; 0 for distances
    std::vector<Watch> watches(into.size(), Watch(quantity_));
    const double interval = run_->a.sample_interval.value();
    const auto watch = [&](std::size_t i, long n, const Bobs<double>& a, const Bobs<double>& b) {
        const double now = is_distance ? state_space_distance(a, b) : energy(a, pairs[i].a.gravity);
        if (n == 0 && !is_distance) start[i] = now;
        watches[i].add(static_cast<double>(n) * interval, std::abs(now - start[i]));
    };
    step_pairs(pairs, *run_, watch, stop);
    for (std::size_t i = 0; i < into.size(); ++i) {
        const double error = watches[i].greatest() / pairs[i].a.potential_range();
        into[i].push_back(is_distance ? watches[i].value() : std::isfinite(error) ? error : NAN);
    }
}

/// Runs a pair with the sample loop of films: any model, method and precision.
TrialNumbers Measurement::watched(const Preset& pair, const std::atomic<bool>& stop) const {
    const auto scene = make_scene(pair, stop);
    try {
        if (is_of_distance(quantity_)) {
            PairRun run(scene);
            Watch watch(quantity_);
            for (long n = 0; n <= scene.samples; ++n) watch.add(scene.time(n), run.next(stop).distance);
            if (quantity_ != Quantity::convergence) return {watch.value()};
            const auto steps = static_cast<double>(run.effort_a().steps + run.effort_b().steps);
            return {2 * pair.duration_s.value() / steps, watch.greatest(), steps};
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
            if (quantity_ == Quantity::period) flips.add_swing(scene.time(n), seen.bobs);
            if (quantity_ != Quantity::flip_time) continue;
            if (const auto time = flips.add(scene.time(n), seen.bobs)) return {*time};
        }
        if (quantity_ == Quantity::deviation) return {furthest * (180 / pi)};
        if (quantity_ == Quantity::period) return {flips.period()};
        return {quantity_ == Quantity::flip_time ? never : worst / scene.a.energy_unit};
    } catch (const RunFailure&) {
        return quantity_ == Quantity::convergence ? TrialNumbers{NAN, NAN, 0} : TrialNumbers{NAN};
    }
}

/// Computes energy errors as max_energy_errors(), one group of equal settings at a time.
void Measurement::append_energies(const PairAt& pair, std::span<TrialNumbers> into,
                                  const std::atomic<bool>& stop) const {
    for (std::size_t first = 0; first < into.size();) {
        const auto first_pair = pair(first);
        const auto scene = make_scene(first_pair, stop);
        auto motion = scene.a.motion;
        motion.follows_turns = false;
        std::vector<Pendulum<Quad>> chains{chain_of(first_pair.a)};
        for (auto i = first + 1; i < into.size(); ++i) {
            const auto& next = pair(i);
            if (next.sample_hz != first_pair.sample_hz || next.a.step_s != first_pair.a.step_s ||
                next.a.tolerance != first_pair.a.tolerance || next.a.links() != first_pair.a.links())
                break;
            chains.push_back(chain_of(next.a));
        }
        for (const double error : max_energy_errors(motion, chains, scene.samples, stop))
            into[first++].push_back(error);
    }
}

bool Measurement::fits(std::span<const double> numbers) const {
    if (numbers.size() != this->numbers()) return false;
    if (quantity_ == Quantity::exponent || quantity_ == Quantity::step_cost) return all_finite(numbers);
    if (quantity_ == Quantity::stroboscopic) return finite_or_none(numbers);
    if (quantity_ == Quantity::convergence)
        return is_count(numbers[2]) && (all_finite(numbers) || (std::isnan(numbers[0]) && std::isnan(numbers[1])));
    if (quantity_ == Quantity::flip_time) return !(numbers[0] < 0);  // failed: NaN
    return !std::isinf(numbers[0]);
}

}  // namespace doppel
