#include "figure/stability_spec.hpp"

#include "scene/scene.hpp"
#include "scene/resolved.hpp"

#include <algorithm>
#include <array>

namespace doppel {
namespace {

constexpr std::array stability_parameters{
    StabilityParameter{"theta1_deg", "release angle θ₁, °",
                       [](SideSpec& side, const Quad& x) { side.angle_deg[0] = x; }, 0, 180, 180, false, 45},
    StabilityParameter{"mass_ratio", "mass ratio m₁/m₂",
                       [](SideSpec& side, const Quad& x) { side.mass_kg[0] = x * side.mass_kg[1]; }, 0.01, 10, 1e6,
                       true, 0}};

void read_rows(TomlReader& table, StabilitySpec& spec) {
    std::vector<std::string_view> names;
    for (const auto& parameter : stability_parameters) names.push_back(parameter.name);
    std::string name(names.front());
    table.read_choice("parameter", name, names);
    for (const auto& parameter : stability_parameters)
        if (parameter.name == name) spec.parameter = &parameter;
    const auto& parameter = *spec.parameter;
    if (parameter.logarithmic && spec.release.links() != 2)
        throw table.fault("parameter", "\"{}\" takes two links; [system] has {}", name, spec.release.links());
    auto& rows = spec.rows = {parameter.from, parameter.to, 72, parameter.logarithmic};
    table.read_number("from", rows.from);
    table.read_number("to", rows.to);
    if (!(rows.logarithmic ? rows.from > 0 : rows.from >= 0))
        throw table.fault("from", "must be {} 0; it is {}", rows.logarithmic ? ">" : "at least", rows.from);
    if (!(rows.to > rows.from && rows.to <= parameter.most))
        throw table.fault("to", "must be more than from = {} and at most {}; it is {}", rows.from, parameter.most,
                          rows.to);
    table.read_whole("rows", rows.count, 1, 10'000);
}

bool serves(const MethodEntry& method, Model model) {
    return model == Model::angles ? method.angles : method.constraints;
}

void read_methods(TomlReader& table, StabilitySpec& spec) {
    constexpr std::array<std::string_view, 3> models{"auto", "angles", "constraints"};
    table.read_choice("model", spec.model, models);
    std::vector<std::string> names;
    for (const bool adaptive : {false, true})
        for (const auto& method : methods())
            if (method.adaptive == adaptive && serves(method, spec.model_of(method))) names.emplace_back(method.name);
    if (const auto given = table.read_texts("methods")) names = *given;
    if (names.empty()) throw table.fault("methods", "must name at least one");
    for (const auto& name : names) {
        const auto* method = find_method(name);
        if (!method)
            throw table.fault("methods", "must be names of methods (doppel list methods); \"{}\" is not", name);
        if (!serves(*method, spec.model_of(*method)))
            throw table.fault("methods", "must serve model = \"{}\"; \"{}\" does not", spec.model, name);
        spec.methods.push_back(method);
    }
    check_distinct(table, "methods", names);
}

/// The range of the methods that go by a tolerance, or of those that do not.
void read_range(TomlReader& table, const StabilitySpec& spec, bool adaptive, std::string_view from, std::string_view to,
                Cells& cells) {
    for (const auto key : {from, to})
        if (table.has(key) && !spec.has(adaptive))
            throw table.fault(key, "is for methods {}, of which none is named",
                              adaptive ? "that go by a tolerance" : "of fixed step");
    table.read_positive(from, cells.from);
    table.read_positive(to, cells.to);
    if (!(cells.to > cells.from))
        throw table.fault(to, "must be more than {} = {}; it is {}", from, cells.from, cells.to);
}

void read_columns(TomlReader& table, StabilitySpec& spec) {
    table.read_positive_ratio("duration_s", spec.duration);
    read_range(table, spec, false, "step_from_s", "step_to_s", spec.steps);
    read_range(table, spec, true, "tolerance_from", "tolerance_to", spec.tolerances);
    table.read_whole("columns", spec.steps.count, 1, 10'000);
    spec.tolerances.count = spec.steps.count;
    const double duration = spec.duration.value();
    constexpr double most_steps = 1e8, finest = 1e-15;
    if (spec.steps.to > duration)
        throw table.fault("step_to_s", "must be at most duration_s = {}; it is {}", duration, spec.steps.to);
    if (duration / spec.steps.from > most_steps)
        throw table.fault("step_from_s", "must leave at most {} steps; it is {}", most_steps, spec.steps.from);
    if (spec.tolerances.from < finest)
        throw table.fault("tolerance_from", "must be at least {}; it is {}", finest, spec.tolerances.from);
}

/// Errors are parts of the energy of a release, which must have some.
void make_releases(const TomlReader& system, const TomlReader& table, StabilitySpec& spec) {
    if (!(spec.release.gravity_m_per_s2 > 0))
        throw system.fault("gravity_m_per_s2", "must be > 0, for small oscillations; it is {}",
                           text_of(spec.release.gravity_m_per_s2));
    for (int row = 0; row < spec.rows.count; ++row) {
        auto side = spec.release;
        spec.parameter->set(side, Quad(spec.rows.middle(row)));
        auto p = chain_of(side);
        constexpr double least = 1e-10;
        if (!(released_energy(p.cast<double>()) > least * p.cast<double>().potential_range()))
            throw table.fault("parameter", "= \"{}\": at {} the pendulum hangs at rest, without energy to keep",
                              spec.parameter->name, spec.rows.middle(row));
        spec.releases.push_back(std::move(p));
    }
}

}  // namespace

Model StabilitySpec::model_of(const MethodEntry& method) const {
    if (model == "angles" || (model == "auto" && method.angles)) return Model::angles;
    return Model::constraints;
}

bool StabilitySpec::has(bool adaptive) const {
    return std::any_of(methods.begin(), methods.end(), [&](auto* method) { return method->adaptive == adaptive; });
}

StabilityRun StabilitySpec::run(const MethodEntry& method, int column) const {
    StabilityRun run{.method = std::string(method.name), .model = model_of(method), .duration = duration};
    const double pace = columns_of(method).middle(column);
    if (method.adaptive) {
        run.tolerance = Quad(pace);
        return run;
    }
    // whole steps to a look, whole looks to the duration
    const double whole = duration.value() / pace;
    run.steps_per_sample = std::max(1L, static_cast<long>(std::ceil(whole / static_cast<double>(run.samples))));
    run.samples = std::max(1L, std::lround(whole / static_cast<double>(run.steps_per_sample)));
    return run;
}

std::string StabilitySpec::resolved() const {
    std::vector<std::string> quoted;
    for (const auto* method : methods) quoted.push_back(toml_text(std::string(method->name)));
    auto text =
        resolved_release(release) +
        fmt::format(
            "\n[stability]\nparameter = \"{}\"\nfrom = {}\nto = {}\nrows = {}\ncolumns = {}\nduration_s = \"{}\"\n"
            "methods = [{}]\nmodel = \"{}\"\n",
            parameter->name, rows.from, rows.to, rows.count, steps.count, duration.text(), fmt::join(quoted, ", "),
            model);
    if (has(false)) text += fmt::format("step_from_s = {}\nstep_to_s = {}\n", steps.from, steps.to);
    if (has(true)) text += fmt::format("tolerance_from = {}\ntolerance_to = {}\n", tolerances.from, tolerances.to);
    return text;
}

StabilitySpec read_stability_spec(FigureReader& reader) {
    StabilitySpec spec{.release = reader.release()};
    auto table = reader.table("stability");
    read_rows(table, spec);
    read_methods(table, spec);
    read_columns(table, spec);
    table.finish();
    make_releases(reader.table("system"), table, spec);
    return spec;
}

}  // namespace doppel
