#include "scene/way.hpp"

#include "scene/choose.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

constexpr double loosest = 1e-2;  // of tolerances

/// The least of 1, 2, 3, 4, 6, 8, 12 … that is `least` or more.
long round_steps(double least) {
    for (long n = 1;; n *= 2) {
        if (static_cast<double>(n) >= least) return n;
        if (n > 1 && static_cast<double>(n / 2 * 3) >= least) return n / 2 * 3;
    }
}

/// The largest of 1e-k and 3e-k that is `most` or less.
double round_tolerance(double most) {
    const int decade = static_cast<int>(std::floor(std::log10(most) + 1e-9));
    const double one = std::pow(10, decade);
    return 3 * one <= most * (1 + 1e-9) ? 3 * one : one;
}

ModelChoice choice_of(Model model) {
    return model == Model::angles        ? ModelChoice::angles
           : model == Model::constraints ? ModelChoice::constraints
                                         : ModelChoice::mechanism;
}

}  // namespace

Way::Way(const SideSpec& spec, const Rational& sample_hz, const MeasuredWay& measured, double time_unit)
    : spec_(spec), sample_hz_(sample_hz), method_(*find_method(measured.method)) {
    spec_.accuracy.reset();
    spec_.integrator = measured.method;
    spec_.model = choice_of(measured.model);
    const bool quad = spec.precision == Precision::in_quad;
    finest_ = quad ? 1e-30 : 1e-14;
    finest_check_ = quad ? 1e-33 : 1e-15;
    if (method_.adaptive)
        start_.tolerance = round_tolerance(std::clamp(measured.setting, finest_, loosest));
    else
        start_.steps = round_steps(1 / (sample_hz.value() * measured.setting * time_unit));
}

Side Way::side(const Pace& setting) const {
    auto spec = spec_;
    if (method_.adaptive)
        spec.tolerance = parse_quad(fmt::format("{:.0e}", setting.tolerance));
    else
        spec.step_s = quotient({1, setting.steps}, sample_hz_);
    return make_side(spec, sample_hz_);
}

Pace Way::finer(const Pace& setting) const {
    if (method_.adaptive) return {.tolerance = std::max(1e-3 * setting.tolerance, finest_check_)};
    return {.steps = setting.steps * std::max(2L, 16L >> (method_.order - 1))};
}

std::optional<Pace> Way::scaled(const Pace& setting, double factor) const {
    Pace next = setting;
    if (method_.adaptive) {
        next.tolerance = round_tolerance(std::clamp(setting.tolerance * factor, finest_, loosest));
        if (next.tolerance == setting.tolerance) return std::nullopt;
        return next;
    }
    next.steps = round_steps(static_cast<double>(setting.steps) * std::pow(factor, -1.0 / method_.order));
    constexpr long most_times = 64;  // as many as the table's: then another way is better
    if (next.steps == setting.steps || next.steps > most_times * start_.steps) return std::nullopt;
    return next;
}

std::vector<MeasuredWay> allowed_ways(const SideSpec& spec, double accuracy) {
    const std::size_t links = spec.particles.empty() ? spec.links() : spec.particles.size();
    // what only quad can do is not in the table: there, the order is that of its last digits
    auto ways = measured_ways(links, std::max(accuracy, finest_in_table));
    const auto fits = [&](const MeasuredWay& way) {
        const auto& method = *find_method(way.method);
        if (way.model == Model::mechanism ? !spec.is_mechanism() && spec.model != ModelChoice::mechanism
                                          : spec.is_mechanism())
            return false;
        if (spec.stabilise != Stabilise::none && (way.model == Model::angles || !method.angles)) return false;
        if (spec.model == ModelChoice::automatic) return true;
        return spec.model == choice_of(way.model);
    };
    std::erase_if(ways, [&](const MeasuredWay& way) { return !fits(way); });
    for (auto& way : ways)
        if (find_method(way.method)->adaptive) way.setting *= std::min(1.0, accuracy / finest_in_table);
    return ways;
}

}  // namespace doppel
