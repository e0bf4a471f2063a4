#include "analysis/tangent.hpp"
#include "figure/system_words.hpp"
#include "figure/work_precision.hpp"
#include "scene/captions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// A standard problem: unit masses and lengths, released at rest.
struct StandardProblem {
    std::vector<int> angle_deg;
    int seconds;
};

constexpr std::array<std::string_view, 4> names_of_all{"P1", "P2", "P3", "P4"};
const std::array<StandardProblem, 4> all_standard{{{{90, 90}, 10}, {{30, 0}, 60}, {{150, 90}, 5}, {{120, 0, 0}, 5}}};

std::string title_words(const std::string& name, const SideSpec& side, const Rational& duration) {
    const auto seconds = fmt::format("{:.6g} s", duration.value());
    if (!side.particles.empty()) return fmt::format("{} · {}", name, seconds);
    return fmt::format("{} · {}{}, {}", name, slashed(side.angle_deg, "°"), side.is_mechanism() ? " and more" : "",
                       seconds);
}

/// A chain or mechanism as a problem. Throws Error (exit 2) if the system is invalid.
WorkProblem make_problem(const std::string& name, SideSpec spec, const Rational& duration) {
    if (spec.physical.has_coulomb())
        throw bad_input("{}: methods are compared on smooth motions; joints with joint_coulomb_N_m stick", name);
    const bool is_mechanism = spec.is_mechanism();
    spec.model = is_mechanism ? ModelChoice::mechanism : ModelChoice::automatic;
    spec.integrator = "taylor";
    spec.precision = Precision::in_double;
    spec.stabilise = Stabilise::none;
    const auto side = make_side(spec, {1, 1});
    WorkProblem problem{.name = name, .title = title_words(name, spec, duration)};
    problem.motion = {.chain = side.motion.chain,
                      .physical = side.motion.physical,
                      .model = is_mechanism ? Model::mechanism : Model::angles,
                      .sample_interval = duration,
                      .follows_turns = false};
    if (is_mechanism || !side.motion.physical) problem.motion.parts = assembly_of(spec);
    problem.conserves_energy = side.has_energy_error;
    problem.energy_unit = side.energy_unit;
    problem.size = side.reach;
    const double gravity = std::abs(side.gravity);
    if (side.motion.chain)
        problem.natural_time = NaturalUnits(physical(side.motion.chain->cast<double>())).time;
    else
        problem.natural_time = gravity > 0 ? std::sqrt(side.reach / gravity) : 1;
    return problem;
}

SideSpec side_of(const StandardProblem& standard) {
    SideSpec side;
    side.set_links(standard.angle_deg.size());  // unit masses and lengths, at rest
    side.angle_deg.assign(standard.angle_deg.begin(), standard.angle_deg.end());
    return side;
}

/// The system in the words of a subtitle.
std::string problem_words(const WorkProblem& problem, const SideSpec& side) {
    constexpr std::string_view computed = "double precision, one core";
    if (!problem.has_angles()) return fmt::format("side a of {}, a mechanism; {}", problem.name, computed);
    const auto besides = side.is_mechanism()        ? ", and more"
                         : problem.is_plain_chain() ? ""
                                                    : " with " + physical_words(side.physical);
    auto shown = side;
    shown.mass_kg = problem.motion.chain->mass;  // links with mass have none of their own in the preset
    return fmt::format("side a of {}{}: {}{}; {}", problem.name,
                       is_zero(side.omega_deg_per_s) ? ", released at rest" : "", links_words(shown), besides,
                       computed);
}

/// The text as TOML comments: data that the numbers depend on and no key contains.
std::string commented(std::string_view text) {
    std::string lines = "#";
    for (const char c : text) lines += c == '\n' ? std::string("\n# ") : std::string(1, c);
    return lines + "\n";
}

/// The systems of the standard problems: "double and triple pendulums".
std::string pendulums_words(const std::vector<WorkProblem>& problems) {
    const auto of = [&](std::size_t links) {
        return std::ranges::count_if(problems,
                                     [&](const auto& problem) { return problem.motion.chain->links() == links; });
    };
    const auto doubles = of(2), triples = of(3);
    if (doubles > 0 && triples > 0) return "double and triple pendulums";
    return doubles > 1 ? "double pendulums" : "a " + chain_words(doubles == 1 ? 2 : 3);
}

}  // namespace

std::span<const std::string_view> standard_problem_names() {
    return names_of_all;
}

WorkProblems standard_problems(const std::vector<std::string>& names, const TomlReader& table) {
    if (names.empty()) throw table.error("problems", "must name at least one of {}", fmt::join(names_of_all, ", "));
    check_distinct(table, "problems", names);
    WorkProblems problems;
    for (const auto& name : names) {
        const auto number = std::ranges::find(names_of_all, name) - names_of_all.begin();
        const auto& standard = all_standard.at(static_cast<std::size_t>(number));
        problems.all.push_back(make_problem(name, side_of(standard), {standard.seconds, 1}));
    }
    problems.subtitle =
        fmt::format("{} released at rest, {}; double precision, one core", pendulums_words(problems.all),
                    links_words(side_of(all_standard[0])));  // all links are alike
    return problems;
}

/// The film's settings follow its name, so that two films of the same name can be distinguished.
WorkProblems problem_of(Preset film) {
    WorkProblems problems;
    problems.all.push_back(make_problem(film.name, film.a, film.duration_s));
    problems.subtitle = problem_words(problems.all.back(), film.a);
    film.b = film.a;
    problems.comment = commented(resolved_sides(film));
    return problems;
}

}  // namespace doppel
