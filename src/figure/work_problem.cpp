#include "figure/work_problem.hpp"

#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "analysis/tangent.hpp"
#include "numeric/nan.hpp"
#include "scene/assemble.hpp"
#include "scene/choose.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// A standard problem: unit masses and lengths, from rest.
struct StandardProblem {
    std::string_view name;
    std::vector<int> angle_deg;
    int seconds;
};

const std::vector<StandardProblem>& standard_problems() {
    static const std::vector<StandardProblem> all{
        {"P1", {90, 90}, 10}, {"P2", {30, 0}, 60}, {"P3", {150, 90}, 5}, {"P4", {120, 0, 0}, 5}};
    return all;
}

std::string release_words(const SideSpec& side) {
    std::vector<std::string> angles;
    for (const auto& angle : side.angle_deg) angles.push_back(fmt::format("{}°", text_of(angle)));
    return fmt::format("{}", fmt::join(angles, "/"));
}

std::string title_words(const std::string& name, const SideSpec& side, const Rational& duration) {
    const auto seconds = fmt::format("{:.6g} s", duration.value());
    if (!side.particles.empty()) return fmt::format("{} · {}", name, seconds);
    return fmt::format("{} · {}{}, {}", name, release_words(side), side.is_mechanism() ? " and more" : "", seconds);
}

WorkProblem standard_problem(const StandardProblem& standard) {
    SideSpec side;
    const auto links = standard.angle_deg.size();
    side.mass_kg.assign(links, 1);
    side.length_m.assign(links, 1);
    side.angle_deg.assign(standard.angle_deg.begin(), standard.angle_deg.end());
    side.omega_deg_per_s.assign(links, 0);
    return make_problem(std::string(standard.name), side, {standard.seconds, 1});
}

WorkProblems read_standard(TomlReader& table) {
    std::vector<std::string> names, quoted;
    for (const auto& standard : standard_problems()) names.emplace_back(standard.name);
    if (const auto asked = table.read_texts("problems")) names = *asked;
    if (names.empty()) throw table.fault("problems", "must name at least one of P1, P2, P3, P4");
    WorkProblems problems;
    for (const auto& name : names) {
        const auto& all = standard_problems();
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
        if (found == all.end()) throw table.fault("problems", "are of P1, P2, P3, P4; \"{}\" is not", name);
        if (std::count(names.begin(), names.end(), name) > 1)
            throw table.fault("problems", "must differ; \"{}\" is there twice", name);
        problems.all.push_back(standard_problem(*found));
        quoted.push_back(toml_text(name));
    }
    if (table.has("duration_s"))
        throw table.fault("duration_s", "is for the motion of a \"scene\"; the problems have their own");
    problems.resolved = fmt::format("problems = [{}]\n", fmt::join(quoted, ", "));
    problems.subtitle =
        "double and triple pendulums released at rest, links of 1 m and 1 kg, g = 9.8 m/s²; double precision, one core";
    return problems;
}

/// "1", or "1, 2, 0.5" where they differ.
std::string numbers_words(const std::vector<double>& numbers) {
    const bool alike = std::all_of(numbers.begin(), numbers.end(), [&](double x) { return x == numbers.front(); });
    return alike ? fmt::format("{}", numbers.front()) : fmt::format("{}", fmt::join(numbers, ", "));
}

/// What moves, in the words of a subtitle.
std::string system_words(const WorkProblem& problem) {
    constexpr std::string_view computed = "double precision, one core";
    const auto& side = problem.side;
    if (!side.motion.chain) return fmt::format("side a of {}, a mechanism; {}", problem.name, computed);
    const auto chain = side.motion.chain->cast<double>();
    const bool rests = std::all_of(chain.rate.begin(), chain.rate.end(), [](double rate) { return rate == 0; });
    return fmt::format("side a of {}{}: links of {} m and {} kg{}, g = {} m/s²; {}", problem.name,
                       rests ? ", released at rest" : "", numbers_words(chain.length), numbers_words(chain.mass),
                       problem.plain ? "" : " and more", chain.gravity, computed);
}

/// Side a of a film. What it says stands beside its name, so that two films of one name are told apart.
WorkProblems read_scene(TomlReader& table) {
    std::string name;
    table.read_text("scene", name);
    if (table.has("problems")) throw table.fault("problems", "cannot stand beside \"scene\", which is one of its own");
    const auto source = [&] {
        try {
            return find_preset(name);
        } catch (const Error& fault) {
            throw table.fault("scene", "cannot be taken: {}", fault.what());
        }
    }();
    table.demand_drawable("scene", source.name);
    if (is_figure(source)) throw table.fault("scene", "must name a film; \"{}\" is a figure", name);
    auto film = read_preset(source);
    if (table.has("duration_s")) table.read_positive_ratio("duration_s", film.duration_s);
    WorkProblems problems;
    problems.all.push_back(make_problem(source.name, film.a, film.duration_s));
    problems.subtitle = system_words(problems.all.back());
    problems.resolved = fmt::format("scene = {}\nduration_s = \"{}\"\n", toml_text(name), film.duration_s.text());
    film.b = film.a;
    std::string comment;
    for (const char c : resolved_sides(film)) comment += c == '\n' ? std::string("\n# ") : std::string(1, c);
    problems.resolved += "#" + comment + "\n";
    return problems;
}

}  // namespace

WorkProblem make_problem(const std::string& name, SideSpec side, const Rational& duration) {
    const bool plain = !side.is_mechanism();
    side.model = plain ? ModelChoice::automatic : ModelChoice::mechanism;
    side.integrator = "taylor";
    side.precision = Precision::in_double;
    side.stabilise = Stabilise::none;
    WorkProblem problem{.name = name,
                        .title = title_words(name, side, duration),
                        .duration = duration,
                        .side = make_side(side, {1, 1}),
                        .parts = assembly_of(side),
                        .plain = plain,
                        .natural_time = 1};
    problem.conserves_energy = problem.parts.conserves_energy();
    const double gravity = std::abs(problem.side.gravity);
    if (problem.side.motion.chain)
        problem.natural_time = NaturalUnits(problem.side.motion.chain->cast<double>()).time;
    else if (gravity > 0)
        problem.natural_time = std::sqrt(problem.side.reach / gravity);
    return problem;
}

MotionSpec WorkProblem::motion(Model model) const {
    MotionSpec spec;
    spec.chain = side.motion.chain;
    spec.model = model;
    if (model == Model::mechanism) spec.parts = parts;
    spec.sample_interval = duration;
    spec.follows_turns = false;
    return spec;
}

double WorkProblem::error(const Observation& seen, const Reference& truth) const {
    return side.has_angles ? angle_error(seen.bobs, truth.end) : place_error(seen.bobs, truth.end) / side.reach;
}

const Truth& Truths::of(std::size_t index, const WorkProblem& problem, const std::atomic<bool>& stop) const {
    // quad at its tolerance comes to some 1e-30 of the sensitivity; of that of a mechanism nothing is known
    constexpr double allowed = 1e-26, allowed_blindly = 1e-15;
    auto& found = found_[index];
    std::call_once(found.once, [&] {
        const auto spec = problem.motion(problem.plain ? Model::angles : Model::mechanism);
        const double sensitivity =
            problem.plain ? angle_sensitivity(spec.chain->cast<double>(), problem.duration.value(), stop) : nan_value;
        const double most = problem.plain ? allowed * std::max(sensitivity, 1.0) : allowed_blindly;
        found.truth = {reference_end(spec, problem.duration, most, stop), sensitivity};
    });
    return found.truth;
}

WorkProblems read_problems(TomlReader& table) {
    return table.has("scene") ? read_scene(table) : read_standard(table);
}

}  // namespace doppel
