#include "figure/parameter.hpp"

#include "scene/numeric_key.hpp"

#include <algorithm>
#include <array>

namespace doppel {
namespace {

constexpr std::array<std::string_view, 4> of_releases{"theta1_deg", "theta2_deg", "mass_ratio", "length_ratio"};

Parameter release(const TomlReader& table, std::string_view key, const std::string& name, const Preset& pair) {
    const auto& known = release_parameter(name);
    if (pair.a.links() < known.links || pair.b.links() < known.links || !pair.a.particles.empty() ||
        !pair.b.particles.empty())
        throw table.fault(key, "\"{}\" takes a chain of {} links", known.name, known.links);
    constexpr double most_degrees = 1e6;  // as of [system] angle_deg
    Parameter parameter{.name = name,
                        .label = std::string(known.label),
                        .bounds = known.is_ratio ? positive : from_to(-most_degrees, most_degrees),
                        .every = known.every,
                        .taken = [](const Quad& value) { return value; },
                        .set =
                            [&known](Preset& preset, const Quad& value, const Quad& difference) {
                                known.set(preset.a, value);
                                known.set(preset.b, value + difference);
                            },
                        .set_both =
                            [&known](Preset& preset, const Quad& value) {
                                known.set(preset.a, value);
                                known.set(preset.b, value);
                            }};
    if (!known.is_ratio) parameter.angle = known.links - 1;
    return parameter;
}

}  // namespace

std::string Parameter::apart(const Quad& difference) const {
    if (difference == 0) return "";
    const auto far = text_of(difference < 0 ? Quad(-difference) : difference);
    if (angle) return fmt::format("twins {}° apart", far);
    const auto comma = label.rfind(", ");
    if (comma == std::string::npos) {
        auto words = label;  // "mass ratio m₁/m₂"
        if (const auto ratio = words.find(" ratio"); ratio != std::string::npos) words.insert(ratio + 6, "s");
        return fmt::format("{} apart by {}", words, far);
    }
    return fmt::format("{} apart by {} {}", label.substr(0, comma), far, label.substr(comma + 2));
}

void Parameter::demand(const TomlReader& table, std::string_view key, const Quad& value) const {
    if (is_whole && value != round(value))
        throw table.fault(key, "must be a whole number, as {} is; it is {}", name, text_of(value));
    const bool too_low =
        bounds.has_low() && (bounds.is_open || bounds.is_positive ? value <= bounds.low : value < bounds.low);
    if (!too_low && !(bounds.has_high() && value > bounds.high)) return;
    const auto low = fmt::format("{} {}", bounds.is_open || bounds.is_positive ? ">" : "at least", bounds.low);
    const auto range = !bounds.has_high() ? low
                       : bounds.is_open   ? fmt::format("{} and at most {}", low, bounds.high)
                                          : fmt::format("from {} to {}", bounds.low, bounds.high);
    if (key == "difference") throw table.fault(key, "must keep {} {}; one would be {}", name, range, text_of(value));
    throw table.fault(key, "must be {}, as {} is; it is {}", range, name, text_of(value));
}

Parameter parameter_of(FigureReader& reader, const TomlReader& table, std::string_view key, const std::string& name,
                       const Preset& pair) {
    if (std::find(of_releases.begin(), of_releases.end(), name) != of_releases.end())
        return release(table, key, name, pair);
    const NumericKey number(table, key, name, pair);
    table.demand_drawable(key, number.label);  // an entry's name may have other letters
    const bool is_scalar = !number.element && number.inside.find('.') == std::string::npos;
    for (const auto* side : {"a", "b"})
        if (is_scalar && number.sides == NumericKey::Sides::both &&
            reader.document.table(reader.top, side).has(number.inside))
            throw table.fault(key, "\"{}\" is in [{}] as well, which has the last word; vary {}.{} or take it out",
                              name, side, side, number.inside);
    Parameter parameter{.name = name,
                        .label = number.label,
                        .bounds = number.bounds,
                        .is_whole = number.is_whole,
                        .is_of_method = !number.keeps_method && !number.is_whole,
                        .keeps_method = number.keeps_method,
                        .is_of_one_side = number.sides != NumericKey::Sides::both || number.is_step,
                        .taken = [number, pair](const Quad& value) { return number.taken(value, pair); },
                        .set = [number](Preset& preset, const Quad& value,
                                        const Quad& difference) { number.set(preset, value, difference); },
                        .set_both =
                            [number](Preset& preset, const Quad& value) {
                                auto of_both = number;
                                of_both.sides = NumericKey::Sides::both;
                                of_both.set(preset, value, 0);
                            }};
    if (number.inside == "angle_deg" && number.element) {
        parameter.angle = number.element;
        parameter.every = 30;
    }
    return parameter;
}

void demand_apart(const TomlReader& table, Quantity quantity, const Parameter& parameter, const Quad& difference,
                  const EndPairs& ends) {
    if (!is_of_distance(quantity)) return;
    const auto name = name_of(quantity);
    const auto same = std::count_if(ends.begin(), ends.end(), are_one);
    const bool are_all = same == std::ssize(ends);
    if (are_all && parameter.is_of_one_side)
        throw table.fault("quantity", "\"{}\" compares the two sides, which are the same; let [b] differ from [a]",
                          name);
    if (are_all || (difference != 0 && same > 0))
        throw table.fault(
            "difference", "must set the two of a pair apart, which \"{}\" compares; {}: give {}{}.difference", name,
            difference == 0 ? "it is 0, and both sides are the same" : text_of(difference) + " is lost in rounding",
            difference == 0 ? "" : "a greater ", table.bare_name());
    const auto start = [](const Scene& scene) -> double {
        try {
            return PairRun(scene).next(false).distance;
        } catch (const BreakDown&) {  // told when it is run
            return NAN;
        }
    };
    if (quantity == Quantity::divergence &&
        std::all_of(ends.begin(), ends.end(), [&](const Scene& scene) { return start(scene) == 0; }))
        throw table.fault(
            "quantity",
            "\"divergence\" takes sides that are released differently: there is no ratio to a distance of "
            "0; \"distance_at_end\" and \"parting_time\" need none");
}

std::string varied_subtitle(Preset pair, std::span<const Parameter* const> parameters, std::span<const Quad> values,
                            const Quad& difference, const QuantityWords& quantity) {
    Varied varied{.method = quantity.method};
    if (quantity.is_of_side_a) pair.b = pair.a;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        // the difference of all twins is named on its own
        parameters[i]->set_both(pair, values[i]);
        if (parameters[i]->angle) varied.angles.push_back(*parameters[i]->angle);
        varied.step |= parameters[i]->is_of_method;
    }
    return pair_subtitle(make_scene(pair), varied, quantity.is_of_side_a ? "" : parameters.front()->apart(difference));
}

}  // namespace doppel
