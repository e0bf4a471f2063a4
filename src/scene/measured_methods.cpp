#include "base/error.hpp"
#include "embedded/scene.hpp"
#include "scene/method_choice.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <set>

namespace doppel {
namespace {

/// One row: the cheapest setting of a method that came within `error` on one of the table's pendulums.
struct Row {
    std::size_t links;
    std::string problem;
    std::pair<std::string, std::string> method;  // after its model
    double error, setting, cost;                 // rad; tolerance, or step in time units; CPU s a time unit
};

std::string_view next_field(std::string_view& text, char end) {
    const auto field = text.substr(0, text.find(end));
    text.remove_prefix(std::min(field.size() + 1, text.size()));
    return field;
}

double number(std::string_view field) {
    double value = 0;
    std::from_chars(field.data(), field.data() + field.size(), value);
    return value;
}

std::vector<Row> rows() {
    const auto files = scene_files();
    const auto file =
        std::find_if(files.begin(), files.end(), [](const auto& f) { return f.name == "scene/costs.csv"; });
    if (file == files.end()) throw Error(ExitCode::io_failed, "the table of costs is missing from this program");
    std::vector<Row> all;
    std::string_view text(file->contents);
    for (next_field(text, '\n'); !text.empty();) {  // after the heading
        auto line = next_field(text, '\n');
        auto& row = all.emplace_back();
        row.problem = next_field(line, ',');
        row.links = static_cast<std::size_t>(number(next_field(line, ',')));
        row.method.first = next_field(line, ',');
        row.method.second = next_field(line, ',');
        row.error = number(next_field(line, ','));
        row.setting = number(next_field(line, ','));
        row.cost = number(next_field(line, ','));
    }
    return all;
}

/// Every model and method that reached `accuracy` (rad) on all pendulums of the table most like a system of `links`,
/// point masses or bodies, cheapest first.
std::vector<MeasuredMethod> methods_in_table(std::size_t links, bool of_bodies, double accuracy) {
    auto table = rows();
    std::erase_if(table, [&](const Row& row) { return (row.problem == "rods") != of_bodies; });
    std::size_t measured_links = table.front().links;  // two for short ones, three for all longer ones
    for (const auto& row : table)
        if (row.links <= std::max<std::size_t>(links, 2)) measured_links = std::max(measured_links, row.links);

    std::set<std::string> problems;
    std::map<std::pair<std::string, std::string>, std::map<std::string, Row>> best;
    for (const auto& row : table) {
        if (row.links != measured_links) continue;
        problems.insert(row.problem);
        if (row.error > accuracy) continue;
        auto& cheapest = best[row.method].emplace(row.problem, row).first->second;
        if (row.cost < cheapest.cost) cheapest = row;
    }
    std::vector<MeasuredMethod> all;
    for (const auto& [names, by_problem] : best) {
        if (by_problem.size() < problems.size()) continue;  // not reached on one of them
        MeasuredMethod method{value_named<Model>(names.first), names.second, by_problem.begin()->second.setting, 0};
        for (const auto& [problem, row] : by_problem) {
            method.setting = std::min(method.setting, row.setting);
            method.cost += row.cost / static_cast<double>(by_problem.size());
        }
        all.push_back(method);
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.cost < y.cost; });
    return all;
}

/// 1e-2, 3e-3, 1e-3 …
std::string tolerance_at(int level) {
    constexpr int first_decade = -2;
    return fmt::format("{}e{}", level % 2 == 0 ? 1 : 3, first_decade - (level + 1) / 2);
}

/// The loosest that is `most` or less.
int level_of_tolerance(double most) {
    int level = 0;
    while (static_cast<double>(parse_quad(tolerance_at(level))) > most * (1 + 1e-9)) ++level;
    return level;
}

/// 1, 2, 3, 4, 6, 8, 12 …
long steps_at(int level) {
    return level == 0 ? 1 : level % 2 == 1 ? 1L << (level + 1) / 2 : 3L << (level / 2 - 1);
}

/// The fewest that are `least` or more. Throws Error (exit 2) where those are too many to count.
int level_of_steps(double least) {
    constexpr double most = 0x1p40;
    if (!(least <= most)) throw bad_input("accuracy would take {:.2g} steps a sample: no run of these ends", least);
    int level = 0;
    while (static_cast<double>(steps_at(level)) < least) ++level;
    return level;
}

ModelChoice choice_of(Model model) {
    return static_cast<ModelChoice>(static_cast<int>(model) + 1);  // after `automatic`
}

}  // namespace

std::vector<MeasuredMethod> measured_methods(const SideSpec& spec, double accuracy) {
    const std::size_t links = spec.particles.empty() ? spec.links() : spec.particles.size();
    // what only quad can do is not in the table: there, the order is that of its last digits
    auto all = methods_in_table(links, !spec.physical.is_none(), std::max(accuracy, finest_in_table));
    std::erase_if(all, [&](const MeasuredMethod& measured) {
        const bool is_mechanism = measured.model == Model::mechanism;
        if (!spec.physical.is_none() && measured.model != Model::angles) return true;
        if (is_mechanism ? !spec.is_mechanism() && spec.model != ModelChoice::mechanism : spec.is_mechanism())
            return true;
        // a fixed step looks for events at its end alone
        if (spec.physical.has_coulomb() && !find_method(measured.method)->adaptive) return true;
        if (spec.stabilise != Stabilise::none &&
            (measured.model == Model::angles || !find_method(measured.method)->angles))
            return true;
        return spec.model != ModelChoice::automatic && spec.model != choice_of(measured.model);
    });
    for (auto& measured : all)
        if (find_method(measured.method)->adaptive) measured.setting *= std::min(1.0, accuracy / finest_in_table);
    return all;
}

StepSettings::StepSettings(const SideSpec& spec, const Rational& sample_hz, const MeasuredMethod& measured,
                           double time_unit)
    : spec_(spec), sample_hz_(sample_hz), method_(*find_method(measured.method)) {
    spec_.accuracy.reset();
    spec_.integrator = measured.method;
    spec_.model = choice_of(measured.model);
    if (method_.adaptive) {
        finest_ = level_of_tolerance(spec.precision == Precision::in_quad ? 1e-30 : 1e-14);
        start_ = std::min(level_of_tolerance(measured.setting), finest_);
    } else {
        start_ = level_of_steps(1 / (sample_hz.value() * measured.setting * time_unit));
        constexpr int further = 12;  // 64 times as many; then another method is better
        finest_ = start_ + further;
    }
}

Side StepSettings::side(int level) const {
    auto spec = spec_;
    if (method_.adaptive)
        spec.tolerance = parse_quad(tolerance_at(level));
    else
        spec.step_s = quotient({1, steps_at(level)}, sample_hz_);
    return make_side(spec, sample_hz_);
}

}  // namespace doppel
