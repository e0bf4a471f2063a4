#include "scene/way.hpp"

#include "scene/choose.hpp"

#include <algorithm>
#include <string>

namespace doppel {
namespace {

constexpr int first_decade = -2;  // of tolerances

/// 1e-2, 3e-3, 1e-3 …
std::string tolerance_at(int rung) {
    return fmt::format("{}e{}", rung % 2 == 0 ? 1 : 3, first_decade - (rung + 1) / 2);
}

/// The loosest that is `most` or less.
int rung_of_tolerance(double most) {
    int rung = 0;
    while (static_cast<double>(parse_quad(tolerance_at(rung))) > most * (1 + 1e-9)) ++rung;
    return rung;
}

/// 1, 2, 3, 4, 6, 8, 12 …
long steps_at(int rung) {
    return rung == 0 ? 1 : rung % 2 == 1 ? 1L << (rung + 1) / 2 : 3L << (rung / 2 - 1);
}

/// The fewest that are `least` or more.
int rung_of_steps(double least) {
    int rung = 0;
    while (static_cast<double>(steps_at(rung)) < least) ++rung;
    return rung;
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
    if (method_.adaptive) {
        finest_ = rung_of_tolerance(spec.precision == Precision::in_quad ? 1e-30 : 1e-14);
        start_ = std::min(rung_of_tolerance(measured.setting), finest_);
    } else {
        start_ = rung_of_steps(1 / (sample_hz.value() * measured.setting * time_unit));
        constexpr int further = 12;  // 64 times as many; then another way is better
        finest_ = start_ + further;
    }
}

Side Way::side(int rung) const {
    auto spec = spec_;
    if (method_.adaptive)
        spec.tolerance = parse_quad(tolerance_at(rung));
    else
        spec.step_s = quotient({1, steps_at(rung)}, sample_hz_);
    return make_side(spec, sample_hz_);
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
