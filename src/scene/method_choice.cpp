#include "scene/method_choice.hpp"

#include "integrate/turns.hpp"
#include "scene/captions.hpp"
#include "scene/side_keys.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace doppel {
namespace {

constexpr double accuracy_margin = 0.8;  // allowed error at the samples, relative to the accuracy
constexpr double max_error = 0.5;        // rad; errors above this have no meaning
constexpr double horizon_share = 0.97;   // of the longest horizon, if round-off limits all settings

bool in_quad(const SideSpec& spec) {
    return spec.precision == Precision::in_quad;
}

/// √(l/g) for the mean link length, s; without gravity, a sixtieth of the run.
double time_unit_of(const SideSpec& spec, double duration) {
    if (spec.gravity_m_per_s2 == 0) return duration / 60;
    double length = 1;
    if (spec.particles.empty()) {
        const auto chain = chain_of(spec).cast<double>();
        length = chain.reach() / static_cast<double>(chain.links());
    }
    return std::sqrt(length / static_cast<double>(spec.gravity_m_per_s2));
}

/// The smallest error that can be measured, rad.
double min_error(const SideSpec& spec) {
    return 2 * pi *
           (in_quad(spec) ? static_cast<double>(std::numeric_limits<Quad>::epsilon())
                          : std::numeric_limits<double>::epsilon());
}

/// 1e-2, 3e-3, 1e-3 …
std::string tolerance_at(int level) {
    constexpr int first_decade = -2;
    return fmt::format("{}e{}", level % 2 == 0 ? 1 : 3, first_decade - (level + 1) / 2);
}

/// The loosest level with a tolerance of at most `maximum`.
int level_of_tolerance(double maximum) {
    int level = 0;
    while (static_cast<double>(parse_quad(tolerance_at(level))) > maximum * (1 + 1e-9)) ++level;
    return level;
}

/// 1, 2, 3, 4, 6, 8, 12 …
long steps_at(int level) {
    return level == 0 ? 1 : level % 2 == 1 ? 1L << (level + 1) / 2 : 3L << (level / 2 - 1);
}

/// The smallest level with at least `minimum` steps per sample. Throws Error (exit 2) if there would be too many.
int level_of_steps(double minimum) {
    constexpr double maximum = 0x1p40;
    if (!(minimum <= maximum))
        throw bad_input("accuracy would need {:.2g} steps a sample; such a run never ends", minimum);
    int level = 0;
    while (static_cast<double>(steps_at(level)) < minimum) ++level;
    return level;
}

/// The loosest level that passes, searched level by level from the start. Finer levels are only tried while the work is
/// worthwhile.
template <class Does, class IsWorth>
std::optional<int> loosest(const StepLevels& method, const Does& does, const IsWorth& is_worth) {
    int level = method.start;
    if (does(level)) {
        while (level > 0 && does(level - 1)) --level;
        return level;
    }
    while (level < method.finest && is_worth(level))
        if (does(++level)) return level;
    return std::nullopt;
}

}  // namespace

// The rule, and the few costs it uses; tests/scene/choice_study_test.cpp measures its quality.

std::span<const std::string_view> methods_for(const MotionSpec& motion) {
    static constexpr std::array<std::string_view, 1> series{"taylor"};
    static constexpr std::array<std::string_view, 4> all{"dop853", "dopri5", "adams", "taylor"};
    const bool is_ideal = motion.model == Model::angles && !motion.physical;
    if (is_ideal || motion.precision == Precision::in_quad) return series;
    const bool has_events = motion.physical && !motion.physical->friction.coulomb.empty();
    // Adams methods miss events between steps; the taped Taylor series is only worthwhile where the right-hand side
    // solves for constraints
    return std::span(all).first(has_events ? 2 : motion.model == Model::mechanism ? 4 : 3);
}

double work_of(const MotionSpec& motion, const Effort& effort, long samples) {
    // for two and three masses on one core of an AMD EPYC: one evaluation takes 95 to 180 ns
    constexpr double on_rods = 0.35, of_order = 4.5;  // 45 ns; 365 to 960 ns for one order of a taped series
    const double interpolation = motion.method == "dop853"   ? 1.3  // 190 ns; 75 ns; 300 ns
                                 : motion.method == "dopri5" ? 0.5
                                 : motion.method == "taylor" ? 2
                                                             : 0;
    const bool by_tape = motion.method == "taylor" && motion.model != Model::angles;
    const bool follows_turns = motion.chain && motion.model != Model::angles;
    const double portions = follows_turns ? std::ceil(motion.sample_interval.value() / Turns::longest) : 1;
    return static_cast<double>(effort.evaluations) * (by_tape ? of_order : 1) *
               (motion.model == Model::constraints ? on_rods : 1) +
           static_cast<double>(samples) * portions * interpolation;
}

StepLevels::StepLevels(std::string_view method_name, const SideSpec& spec, const Rational& sample_hz, double time_unit)
    : method(method_name) {
    const auto accuracy = static_cast<double>(*spec.accuracy);
    if (find_method(method)->adaptive) {
        finest = level_of_tolerance(in_quad(spec) ? 1e-30 : 1e-14);
        start = std::min(level_of_tolerance(accuracy / 1000), finest);
    } else {
        const double step = 0.08 * std::pow(accuracy, 0.14) * time_unit;  // for adams
        start = level_of_steps(1 / (sample_hz.value() * step));
        finest = start + 12;  // 64 times as many steps
    }
}

Side StepLevels::side(SideSpec spec, const Rational& sample_hz, int level) const {
    spec.accuracy.reset();
    spec.integrator = method;
    if (find_method(method)->adaptive)
        spec.tolerance = parse_quad(tolerance_at(level));
    else
        spec.step_s = quotient({1, steps_at(level)}, sample_hz);
    return make_side(spec, sample_hz);
}

MethodChooser::MethodChooser(const Preset& preset, const std::atomic<bool>& stop)
    : preset_(preset), samples_(product(preset.duration_s, preset.sample_hz)->numerator) {
    for (const char name : {'a', 'b'}) {
        const auto& spec = name == 'a' ? preset_.a : preset_.b;
        if (!spec.is_chosen()) continue;
        const auto differences =
            groups_.empty() ? std::vector<KeyPair>() : differing_keys(groups_.front().sides.front().spec, spec);
        // sides that differ only in the system get the same choice
        const bool is_other = std::ranges::any_of(differences, [](const auto& pair) { return pair.any().is_setting; });
        if (groups_.empty() || is_other) groups_.emplace_back();
        auto& group = groups_.back();
        if (!group.sides.empty() && differences.empty())
            group.sides.front().names += name;
        else
            group.sides.push_back(
                for_side(preset_, name, [&] { return requirement(name, spec, group.methods, stop); }));
    }
}

MethodChooser::SideRequirement MethodChooser::requirement(char name, const SideSpec& spec,
                                                          std::vector<StepLevels>& methods,
                                                          const std::atomic<bool>& stop) const {
    const double time_unit = time_unit_of(spec, preset_.duration_s.value());
    const double swing = std::ceil(2 * pi * time_unit * preset_.sample_hz.value() * (1 - 1e-9));
    const auto levels = [&](std::string_view method) { return StepLevels(method, spec, preset_.sample_hz, time_unit); };
    const auto any = levels("taylor").side(spec, preset_.sample_hz, 0);
    std::vector<StepLevels> own;
    for (const auto& method : methods_for(any.motion)) own.push_back(levels(method));
    if (methods.empty()) {
        methods = std::move(own);
    } else {  // methods that both sides can use
        std::erase_if(methods, [&](StepLevels& method) {
            const auto same = std::ranges::find(own, method.method, &StepLevels::method);
            if (same != own.end()) method.finest = std::max(method.finest, same->finest);
            return same == own.end();
        });
        if (methods.empty()) methods = {levels("dop853")};  // supports every model
    }
    return {.names = std::string(1, name),
            .spec = spec,
            .accuracy = static_cast<double>(*spec.accuracy),
            .swing_samples = std::lround(std::min(swing, static_cast<double>(samples_))),
            .reference = std::make_shared<const ReferenceTrajectory>(
                reference_trajectory(any.motion, samples_, any.reach, max_error, stop))};
}

const ErrorHistory& MethodChooser::tried(SideRequirement& side, const StepLevels& method, int level,
                                         const std::atomic<bool>& stop) const {
    const std::pair setting(method.method, level);
    const auto known = side.tried.find(setting);
    if (known != side.tried.end()) return known->second;
    const auto motion = method.side(side.spec, preset_.sample_hz, level).motion;
    return side.tried.emplace(setting, error_history(motion, *side.reference, max_error, stop)).first->second;
}

Error MethodChooser::out_of_reach(double accuracy, long horizon, SideRequirement& side,
                                  const std::vector<StepLevels>& methods, const std::atomic<bool>& stop) const {
    const auto& reference = *side.reference;
    const auto seconds = [&](long sample) { return static_cast<double>(sample) / preset_.sample_hz.value(); };
    const auto known = static_cast<long>(reference.seen.size());
    if (!reference.failure.empty() && known <= side.swing_samples)
        return method_failed(
            "no accuracy can be verified, because the reference fails within {} s: {}; give integrator and tolerance",
            two_digits(seconds(known)), reference.failure);
    const auto within = [&](long sample) {  // the least error of all methods
        double error = std::numeric_limits<double>::infinity();
        for (const auto& method : methods)
            error = std::min(error, tried(side, method, method.finest, stop).at(static_cast<std::size_t>(sample)));
        return error / accuracy_margin;
    };
    const double for_swing = within(side.swing_samples), to_end = within(samples_);
    const auto up = [](double value) {
        const double digit = std::pow(10, std::floor(std::log10(value)));
        return fmt::format("{:.0e}", std::ceil(value / digit) * digit);
    };
    const bool quad = in_quad(side.spec);
    return bad_input("accuracy = {:.3g} {} is beyond {} here: it would be kept for {} s; possible: {} for {} s{}{}",
                     accuracy, reference.in_angles ? "rad" : "of its size", quad ? "quad" : "double",
                     two_digits(std::max(0.0, seconds(horizon))), std::isfinite(for_swing) ? up(for_swing) : "none",
                     two_digits(seconds(side.swing_samples)),
                     to_end < max_error ? fmt::format(" and {} to the end", up(to_end)) : "",
                     quad ? "" : "; precision = \"quad\" allows more");
}

double MethodChooser::work(SideRequirement& side, const StepLevels& method, int level,
                           const std::atomic<bool>& stop) const {
    const auto& history = tried(side, method, level, stop);
    const long samples = std::max(history.effort_samples, 1L);
    return work_of(method.side(side.spec, preset_.sample_hz, level).motion, history.effort, samples) *
           static_cast<double>(samples_) / static_cast<double>(samples);
}

std::array<std::optional<Side>, 2> MethodChooser::choose(double factor, const std::atomic<bool>& stop) {
    std::array<std::optional<Side>, 2> chosen;
    for (auto& group : groups_) {
        auto& sides = group.sides;
        const auto& methods = group.methods;
        const auto horizon = [&](SideRequirement& side, const StepLevels& method, int level) {
            return tried(side, method, level, stop).last_within(accuracy_margin * factor * side.accuracy);
        };
        std::vector<long> goals(sides.size(), samples_);
        const auto does = [&](const StepLevels& method, int level) {
            return std::equal(sides.begin(), sides.end(), goals.begin(),
                              [&](SideRequirement& side, long goal) { return horizon(side, method, level) >= goal; });
        };
        if (std::ranges::none_of(methods, [&](const auto& method) { return does(method, method.start); })) {
            // nearly as long as the method that remains accurate longest
            const auto& best = *std::ranges::max_element(methods, {}, [&](const StepLevels& method) {
                return std::accumulate(sides.begin(), sides.end(), 0L, [&](long sum, SideRequirement& side) {
                    return sum + horizon(side, method, method.finest);
                });
            });
            for (std::size_t i = 0; i < sides.size(); ++i) {
                const long furthest = horizon(sides[i], best, best.finest);
                if (furthest < sides[i].swing_samples)
                    for_side(preset_, sides[i].names[0], [&] {
                        throw out_of_reach(factor * sides[i].accuracy, furthest, sides[i], methods, stop);
                    });
                if (furthest < samples_)
                    goals[i] =
                        std::max(sides[i].swing_samples, std::lround(horizon_share * static_cast<double>(furthest)));
            }
        }
        const auto work_at = [&](const StepLevels& method, int level) {
            return std::accumulate(sides.begin(), sides.end(), 0.0, [&](double sum, SideRequirement& side) {
                return sum + work(side, method, level, stop);
            });
        };
        struct Found {
            const StepLevels* method;
            int level;
            double work;
        };
        std::vector<Found> found;  // sorted by work
        for (const auto& method : methods) {
            const auto level = loosest(
                method, [&](int at) { return does(method, at); },
                [&](int at) { return found.empty() || work_at(method, at) < found.front().work; });
            if (level) found.push_back({&method, *level, work_at(method, *level)});
            std::ranges::stable_sort(found, {}, &Found::work);
        }
        const auto& [method, level, minimum] = found.front();
        auto why = fmt::format("; fastest method: {}", method->method);
        if (found.size() > 1)
            why += fmt::format(", {:.2g} times the work of {}", minimum / found[1].work, found[1].method->method);
        for (auto& requirement : sides) {
            auto side = method->side(requirement.spec, preset_.sample_hz, level);
            const auto& history = tried(requirement, *method, level, stop);
            const long last = horizon(requirement, *method, level);
            side.why += why;
            side.choice = MethodChoice{
                .accuracy = factor * requirement.accuracy,
                .estimated_error = std::max(history.at(static_cast<std::size_t>(last)), min_error(requirement.spec)),
                .horizon = last,
                .reference = requirement.reference,
                .work = work(requirement, *method, level, stop)};
            for (const char name : requirement.names) chosen[name == 'a' ? 0 : 1] = side;
        }
    }
    return chosen;
}

void use_common_method(Preset& pair, const Preset& first, const std::atomic<bool>& stop) {
    const std::array sides{&pair.a, &pair.b};
    if (!pair.a.is_chosen() && !pair.b.is_chosen()) return;
    // ideal chains of two or three links in angles always reach this accuracy for one swing in double
    const auto surely_keeps = [&](const SideSpec* side) {
        return !side->is_chosen() ||
               (*side->accuracy >= Quad(1e-13) && side->physical.is_none() && !side->is_mechanism() &&
                side->stabilise == Stabilise::none && side->links() <= 3 &&
                (side->model == ModelChoice::automatic || side->model == ModelChoice::angles));
    };
    std::array<std::optional<Side>, 2> chosen;
    if (!std::ranges::all_of(sides, surely_keeps)) chosen = MethodChooser(first, stop).choose(1, stop);
    for (std::size_t i = 0; i < 2; ++i) {
        auto& side = *sides[i];
        if (!side.is_chosen()) continue;
        const bool by_series = !chosen[i] || chosen[i]->method.name == "taylor";
        side.accuracy.reset();
        side.step_s.reset();
        side.integrator = by_series ? "taylor" : "dop853";
        side.tolerance = parse_quad(in_quad(side) ? "1e-30" : by_series ? "1e-15" : "1e-14");
    }
}

}  // namespace doppel
