#include "figure/work_ladder.hpp"

#include "base/error.hpp"
#include "figure/work_run.hpp"
#include "integrate/methods.hpp"
#include "numeric/nan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace doppel {
namespace {

/// Steps of 2^(k/2)/30000 s, from the problem's natural time down.
std::vector<Setting> step_settings(const WorkProblem& problem, const LadderSpec& spec) {
    const double at_study = problem.duration.value() / study_step;
    std::vector<Setting> all;
    for (int k = static_cast<int>(2 * std::log2(problem.natural_time / study_step));; --k) {
        const double factor = std::ldexp(k % 2 == 0 ? 1 : std::numbers::sqrt2, -((k + (k % 2 != 0)) / 2));
        const long steps = std::max(1L, std::lround(at_study * factor));
        if (steps > spec.most_evaluations && !all.empty()) return all;
        if (all.empty() || steps > all.back().steps)
            all.push_back({problem.duration.value() / static_cast<double>(steps), steps, 0});
    }
}

/// 10^(−k/2), to three digits as they would be written, from a tenth to what double can give.
std::vector<Setting> tolerance_settings() {
    constexpr int last = 15;
    std::vector<Setting> all;
    for (int decade = 1; decade <= last; ++decade) {
        for (const auto* digits : {"1", "0.316"}) {
            const auto tolerance = parse_quad(fmt::format("{}e-{}", digits, decade));
            if (decade == last && all.size() % 2 == 1) break;
            all.push_back({static_cast<double>(tolerance), 0, tolerance});
        }
    }
    return all;
}

std::vector<Setting> settings(const WorkProblem& problem, const Contender& contender, const LadderSpec& spec) {
    auto all = contender.adaptive() ? tolerance_settings() : step_settings(problem, spec);
    if (const auto* peer = contender.peer)
        std::erase_if(all, [&](const Setting& s) { return s.value < peer->least || s.value > peer->most; });
    return all;
}

/// Tells when finer settings no longer help.
class Floor {
public:
    explicit Floor(double error) : floor_(error) {}

    bool reached(double error) {
        constexpr double near = 100, useful = 1e-3;
        constexpr int patience = 3, long_patience = 8;
        ++since_best_;
        if (error < best_) {
            best_ = error;
            since_best_ = 0;
        }
        return since_best_ >= (best_ < near * floor_ ? patience : best_ < useful ? long_patience : never);
    }

private:
    static constexpr int never = std::numeric_limits<int>::max();
    double floor_, best_ = std::numeric_limits<double>::infinity();
    int since_best_ = 0;
};

}  // namespace

bool Contender::adaptive() const {
    return peer ? peer->adaptive : find_method(method)->adaptive;
}

std::vector<Rung> climb(const WorkProblem& problem, const Truth& truth, const Contender& contender,
                        const LadderSpec& spec, const std::atomic<bool>& stop) {
    const auto rung_at = [&](const Setting& setting) {
        if (stop) throw Error(ExitCode::interrupted, "interrupted");
        return contender.peer ? peer_rung(problem, truth, *contender.peer, setting, spec)
                              : motion_rung(problem, truth, contender, setting, spec, stop);
    };
    std::vector<Rung> rungs;
    Floor floor(truth.floor());
    for (const auto& setting : settings(problem, contender, spec)) {
        const auto& rung = rungs.emplace_back(rung_at(setting));
        const bool enough = std::numbers::sqrt2 * rung.evaluations > static_cast<double>(spec.most_evaluations);
        if (enough || rung.error < spec.least_error || floor.reached(rung.error)) break;
    }
    if (contender.is_study() && std::none_of(rungs.begin(), rungs.end(), [](auto& r) { return r.is_study(); })) {
        const double steps = std::round(problem.duration.value() / study_step);
        rungs.push_back(rung_at({problem.duration.value() / steps, static_cast<long>(steps), 0}));
    }
    if (rungs.empty()) rungs.push_back({nan_value, nan_value, nan_value, nan_value, nan_value, nan_value, nan_value});
    return rungs;
}

TrialNumbers flattened(const std::vector<Rung>& rungs) {
    TrialNumbers numbers;
    for (const auto& rung : rungs)
        for (const double number :
             {rung.setting, rung.error, rung.energy_error, rung.length_error, rung.cpu_s, rung.evaluations, rung.steps})
            numbers.push_back(number);
    return numbers;
}

std::vector<Rung> rungs_of(const TrialNumbers& numbers) {
    std::vector<Rung> rungs;
    for (auto n = numbers.begin(); n != numbers.end(); n += Rung::numbers)
        rungs.push_back({n[0], n[1], n[2], n[3], n[4], n[5], n[6]});
    return rungs;
}

bool is_ladder(std::span<const double> numbers) {
    if (numbers.empty() || numbers.size() % Rung::numbers != 0) return false;
    constexpr std::size_t first_count = 5;  // evaluations, then steps
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (i % Rung::numbers >= first_count && !std::isnan(numbers[i]) && !is_count(numbers[i])) return false;
    return true;
}

}  // namespace doppel
