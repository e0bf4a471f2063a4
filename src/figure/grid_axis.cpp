#include "figure/grid_axis.hpp"

#include "scene/side_keys.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// "mass m₂" and "kg" of "mass m₂, kg"; no unit for "mass ratio m₁/m₂".
std::pair<std::string, std::string> name_and_unit(const std::string& label) {
    const auto comma = label.rfind(", ");
    return {label.substr(0, comma), comma == std::string::npos ? "" : label.substr(comma + 2)};
}

/// Removes the quotes: "rk4" from "\"rk4\"".
std::string unquoted(const std::string& text) {
    return text[0] == '"' || text[0] == '\'' ? text.substr(1, text.size() - 2) : text;
}

/// The number that a value is, 1e-4 or "1/30000"; nothing if it is another text.
std::optional<Quad> number_in(const std::string& text) {
    if (text.find_first_not_of("0123456789+-.eE") == std::string::npos) return parse_quad(text);
    const auto ratio = text.find('/') == std::string::npos ? std::nullopt : parse_rational(unquoted(text));
    return ratio ? std::optional(ratio->as<Quad>()) : std::nullopt;
}

/// Throws if [a] or [b] override a key of both sides. A resolved preset has all keys in both.
void require_last_word(FigureReader& reader, const TomlReader& table, const std::string& path) {
    const auto key = path.substr(path.find('.') + 1);
    const auto has = [&](const char* side) { return reader.top.inner(side).has(key); };
    for (const auto* side : {"a", "b"})
        if (path.starts_with("system.") && has(side) && has("a") != has("b"))
            throw table.error("key", "\"{}\" is also in [{}], which overrides it; vary {}.{} or take it out", path,
                              side, side, key);
}

}  // namespace

const std::array<GridAxis::ReleaseParameter, 4> GridAxis::releases{
    {{"theta1_deg", "release angle θ₁, °", 1, [](SideSpec& s, const Quad& x) { s.angle_deg[0] = x; }, false},
     {"theta2_deg", "release angle θ₂, °", 2, [](SideSpec& s, const Quad& x) { s.angle_deg[1] = x; }, false},
     {"mass_ratio", "mass ratio m₁/m₂", 2, [](SideSpec& s, const Quad& x) { s.mass_kg[0] = x * s.mass_kg[1]; }, true},
     {"length_ratio", "length ratio l₁/l₂", 2, [](SideSpec& s, const Quad& x) { s.length_m[0] = x * s.length_m[1]; },
      true}}};

void GridAxis::fields(KeyVisitor& visit) {
    constexpr int max_points = 1'048'576;
    constexpr std::size_t max_values = 1000;
    visit({.key = "key",
           .help = help,
           .absent = exists() ? "" : "no such axis",
           .pattern = R"(^(theta1_deg|theta2_deg|mass_ratio|length_ratio|links|setting|system|(system|a|b)\..+)$)"},
          key);
    visit({.key = "values",
           .help = "the values one by one: numbers, or what the key takes",
           .absent = "given by `from`, `to` and `step`",
           .only = {exists(), "is for an axis, and this one has no key"},
           .maximum = max_values},
          values);
    visit({.key = "labels",
           .help = "names of the values in the picture, and in the table where they are no numbers",
           .absent = "the values",
           .only = {values.has_value(), "needs values, one name for each"},
           .is_drawn = true},
          labels);
    const bool are_even = exists() && !values;
    const bool has_step = visit.from_command_line("step") && !visit.from_command_line("points");
    const Condition even{
        are_even, exists() ? "is for even values; give it, or values" : "is for an axis, and this one has no key",
        visit.from_command_line("values")};
    visit({.key = "from", .help = "the first value; for a map the lower edge, or the first whole number", .only = even},
          from);
    visit({.key = "to", .help = "the last value; for a map the upper edge, or the last whole number", .only = even},
          to);
    visit({.key = "spacing", .help = "by equal differences, or by equal ratios", .only = even}, spacing);
    visit({"points", "number of values; for a map number of cells, each computed at its centre", "",
           from_to(2, max_points), "given by `step`",
           Condition{even.applies && !has_step, even.error, even.drops || has_step}},
          points);
    visit({"step", "difference of two values; must divide the range from `from` to `to`", "", positive, "",
           Condition{are_even && !points && spacing == Spacing::linear, "is for even values; give it, or points",
                     even.drops || visit.from_command_line("points") || visit.from_command_line("spacing")}},
          step);
    const Condition of_setting{is_setting(), "is only for key = \"setting\""};
    constexpr Bounds tolerances{.low = 1e-32};
    visit({"tolerance_from", "of adaptive methods, in place of `from`", "", tolerances, "", of_setting},
          tolerance_from);
    visit({"tolerance_to", "of adaptive methods, in place of `to`", "", tolerances, "", of_setting}, tolerance_to);
    visit({"tolerance_points", "of adaptive methods", "", from_to(2, max_points), "as `points`", of_setting},
          tolerance_points);
}

void GridAxis::find(FigureReader& reader, const TomlReader& table, const Preset& pair) {
    if (!exists()) return;
    if (!labels.empty() && labels.size() != values->texts.size())
        throw table.error("labels", "must name the {} values; there are {}", values->texts.size(), labels.size());
    if (values) check_distinct(table, "values", values->texts);
    const bool takes_fractions = role == "x" || role == "y";  // curves and panels are named by them
    const auto is_number = [&](const std::string& text) {
        return number_in(text) && (takes_fractions || text.find('/') == std::string::npos);
    };
    if (values && !std::ranges::all_of(values->texts, is_number)) return find_texts(reader, table);
    if (is_setting()) return find_settings(table, pair);
    find_number(reader, table, pair);
    find_values(table, pair);
}

void GridAxis::find_settings(const TomlReader& table, const Preset& pair) {
    if (values || !points) throw table.error("points", "must be the number of settings from `from` to `to`");
    if (!(from > 0 && to > 0)) throw table.error("from", "must be > 0 and to as well, in s; it is {}", text_of(from));
    if (are_cells && !(from < to && tolerance_from < tolerance_to))
        throw table.error("to", "must be above from, and tolerance_to above tolerance_from, for the cells of a map");
    constexpr double max_steps = 1e8;
    const double finest = static_cast<double>(from < to ? from : to), duration = pair.duration_s.value();
    if (duration / finest > max_steps || from > duration || to > duration)
        throw table.error("from", "and to must leave 1 to {} steps in {} s; they are {} and {}", max_steps, duration,
                          text_of(from), text_of(to));
    spacing = Spacing::logarithmic;
    keeps_method = false;
    is_of_method = true;
    settle(pair);
}

void GridAxis::settle(const Preset& pair) {
    if (!is_setting()) return;
    auto all = *this;  // so that even_value() applies to them
    const auto* method = find_method(pair.a.integrator);
    is_adaptive_ = method && method->adaptive;
    if (is_adaptive_) {
        all.from = tolerance_from, all.to = tolerance_to;
        if (tolerance_points) all.points = tolerance_points;
    }
    all.count = static_cast<std::size_t>(*all.points);
    label = is_adaptive_ ? "tolerance" : "step, s";
    numbers_.clear();
    steps_.clear();
    const double minimum = pair.a.precision == Precision::in_double ? 5e-15 : 0;
    const double samples = pair.duration_s.value() * pair.sample_hz.value();
    for (std::size_t i = 0; i < all.count; ++i) {
        const auto number = all.even_value(i);
        if (is_adaptive_ && number < minimum && !numbers_.empty()) continue;
        numbers_.push_back(number);
        if (is_adaptive_) continue;
        // whole steps per sample, whole samples in the duration
        const double steps = pair.duration_s.value() / static_cast<double>(number);
        constexpr double slack = 1e-9;  // for rounding of decimals
        const long each = std::max(1L, static_cast<long>(std::ceil(steps / samples - slack)));
        const auto rate = quotient({std::max(1L, std::lround(steps / static_cast<double>(each))), 1}, pair.duration_s);
        steps_.emplace_back(*rate, *quotient({1, each}, *rate));
        numbers_.back() = steps_.back().second.as<Quad>();
    }
    count = numbers_.size();
}

void GridAxis::find_texts(FigureReader& reader, const TomlReader& table) {
    const bool is_all = key == "system";  // each value is a table with some of the keys
    if (!is_all && key.find('.') == std::string::npos) throw table.error("values", "must be numbers, as {} is", key);
    if (!is_all && !key.starts_with("system.") && !key.starts_with("a.") && !key.starts_with("b."))
        throw table.error("key", "must begin with \"system.\", \"a.\" or \"b.\"; it is \"{}\"", key);
    if (!is_all) require_last_word(reader, table, key);
    label = is_all ? key : caption_of({.key = std::string_view(key).substr(key.find('.') + 1)});
    keeps_method = false;
    count = values->texts.size();
    const auto origin = fmt::format("{}: {} values", table.place_of("values").first, key);
    for (const auto& text : values->texts) {
        table.require_drawable("values", text);
        auto keys = fmt::format("{} = {}\n", key, text);
        if (is_all && !text.starts_with('{'))
            throw table.error("values", "must be tables of keys of [system], {{ integrator = \"rk4\" }}; one is {}",
                              text);
        if (is_all)
            keys = fmt::format("a = {0}\nb = {0}\n", text);
        else if (const auto slash = text.find('/'); key == "system.integrator" && slash != std::string::npos)
            keys = fmt::format("a.integrator = {0}{2}\nb.integrator = {2}{1}\n", text.substr(0, slash),
                               text.substr(slash + 1), text[0]);
        else if (key.starts_with("system."))  // the sides override [system]
            keys = fmt::format("a.{0} = {1}\nb.{0} = {1}\n", key.substr(7), text);
        levels.push_back(parse_document({"", origin, keys, ""}, {}));
    }
}

void GridAxis::find_number(FigureReader& reader, const TomlReader& table, const Preset& pair) {
    release_ = std::ranges::find_if(releases, [&](const auto& release) { return release.name == key; });
    if (release_ == releases.end()) {
        release_ = nullptr;
        const auto& number = number_.emplace(table, "key", key == "links" ? "system.links" : key, pair);
        table.require_drawable("key", number.label);  // the name of an entry may contain letters that cannot be drawn
        if (!number.element && number.inside.find('.') == std::string::npos)
            require_last_word(reader, table, number.path);
        label = number.label;
        bounds_ = number.bounds;
        is_of_method = !number.keeps_method && !number.is_whole;
        keeps_method = number.keeps_method;
        is_of_one_side = number.sides != NumericKey::Sides::both || number.is_step;
        if (number.inside == "angle_deg") angle = number.element;
        return;
    }
    require_in(table, "key", pair);
    constexpr double max_degrees = 1e6;  // as for [system] angle_deg
    label = release_->label;
    bounds_ = release_->is_ratio ? positive : from_to(-max_degrees, max_degrees);
    is_of_one_side = false;
    if (!release_->is_ratio) angle = release_->links - 1;
}

void GridAxis::require_in(const TomlReader& table, std::string_view of, const Preset& pair) const {
    if (number_) NumericKey(table, of, number_->path, pair);
    if (!release_) return;
    for (const auto* side : {&pair.a, &pair.b})
        if (side->links() < release_->links || !side->particles.empty())
            throw table.error(of, "\"{}\" takes a chain of {} links", key, release_->links);
}

void GridAxis::find_values(const TomlReader& table, const Preset& pair) {
    if (values) {
        for (const auto& text : values->texts) require(table, "values", numbers_.emplace_back(*number_in(text)));
        count = numbers_.size();
    } else {
        find_even_values(table);
    }
    if (number_)
        for (auto& number : numbers_) number = number_->taken(number, pair);
    if (are_cells && are_centers()) find_spacing(table, values ? "values" : "points");
}

void GridAxis::find_even_values(const TomlReader& table) {
    if (are_cells ? !(from < to) : to < from)
        throw table.error("to", "must {} from ({}); it is {}", are_cells ? "be above" : "not be below", text_of(from),
                          text_of(to));
    const bool are_edges = are_cells && !are_centers();
    const bool is_logarithmic = spacing == Spacing::logarithmic;
    if (is_logarithmic && !points) throw table.error("spacing", "\"logarithmic\" takes points, the number of values");
    if (is_logarithmic && !(from > 0))
        throw table.error("from", "must be > 0 for equal ratios; it is {}", text_of(from));
    count = points ? static_cast<std::size_t>(*points) : even_steps(table) + (are_edges ? 0 : 1);
    require(table, "from", are_edges ? even_value(0) : from);
    require(table, "to", are_edges ? even_value(count - 1) : to);
    for (std::size_t i = 0; i < count; ++i) numbers_.push_back(even_value(i));
}

void GridAxis::find_spacing(const TomlReader& table, std::string_view of) {
    constexpr double slack = 1e-9;  // of decimals
    const auto number = [&](std::size_t i) { return static_cast<double>(numbers_[i]); };
    const auto is_even = [&](Spacing by) {
        const auto at = [&](std::size_t i) { return by == Spacing::linear ? number(i) : std::log(number(i)); };
        const double step = (at(count - 1) - at(0)) / static_cast<double>(count - 1);
        for (std::size_t i = 0; i < count; ++i)
            if (!(std::abs(at(i) - at(0) - step * static_cast<double>(i)) <= slack * step)) return false;
        return true;
    };
    if (values && count > 1) {  // two values are both; then no edge is out of the key's range
        const bool fits = !bounds_.has_low() || number(0) - (number(1) - number(0)) / 2 >= bounds_.low;
        const bool is_linear = is_even(Spacing::linear) && (fits || !is_even(Spacing::logarithmic));
        spacing = is_linear ? Spacing::linear : Spacing::logarithmic;
    }
    if (count < 2 || !is_even(spacing))
        throw table.error(of, "must increase by equal steps or by equal ratios, as centres of the cells of a map");
}

std::size_t GridAxis::even_steps(const TomlReader& table) const {
    constexpr int max_steps = 10'000'000;
    const Quad steps = (to - from) / step;
    if (!(steps < max_steps))
        throw table.error("to", "must be at most {} steps from \"from\"; it is {}", max_steps, text_of(to));
    const long whole = std::lround(static_cast<double>(steps));
    constexpr double slack = 1e-12;  // a decimal may miss a whole number of steps only by rounding
    if (std::abs(static_cast<double>(steps - Quad(static_cast<double>(whole)))) > slack)
        throw table.error("step", "must divide the way from {} to {}; it is {}", text_of(from), text_of(to),
                          text_of(step));
    if (is_whole() && step != round(step))
        throw table.error("step", "must be a whole number, as {} is; it is {}", key, text_of(step));
    return static_cast<std::size_t>(whole);
}

Quad GridAxis::even_value(std::size_t i) const {
    const Quad number(static_cast<double>(i));
    if (are_cells && !are_centers()) return Quad(middle_of_cell(i));
    if (!points) return from + step * number;
    if (i + 1 == count) return to;
    const Quad share = number / Quad(static_cast<double>(count - 1));
    if (spacing == Spacing::linear) return from + (to - from) * share;
    return from * Quad(std::pow(static_cast<double>(Quad(to / from)), static_cast<double>(share)));
}

/// If the ends are opposite numbers, mirror images have exactly opposite centres.
double GridAxis::middle_of_cell(std::size_t i) const {
    const auto low = static_cast<double>(from), high = static_cast<double>(to), halves = 2 * static_cast<double>(count);
    const double before = 2 * static_cast<double>(i) + 1, after = halves - before;  // in half cells
    if (spacing == Spacing::logarithmic) return low * std::pow(high / low, before / halves);
    return (low * after + high * before) / halves;
}

std::string GridAxis::words(std::size_t i) const {
    if (!labels.empty()) return labels[i];
    if (!levels.empty()) return unquoted(values->texts[i]);
    auto [what, unit] = name_and_unit(label);
    // the symbol stands for the words before it: "θ₁" for "release angle θ₁"
    const auto last = what.substr(what.rfind(' ') + 1);
    if (std::ranges::any_of(last, [](char c) { return static_cast<unsigned char>(c) >= 0x80; })) what = last;
    return fmt::format("{} = {:.6g}{}{}", what, static_cast<double>(value(i)), unit.empty() || unit == "°" ? "" : " ",
                       unit);
}

void GridAxis::put(Preset& pair, std::size_t i, const Quad& difference) const {
    if (number_) number_->set(pair, value(i), difference);
    for (auto* side : {&pair.a, &pair.b}) {
        if (!is_setting()) break;
        side->step_s.reset(), side->tolerance.reset(), side->accuracy.reset();
        if (is_adaptive_)
            side->tolerance = value(i);
        else
            std::tie(pair.sample_hz, side->step_s) = steps_[i];
    }
    if (!release_) return;
    release_->set(pair.a, value(i));
    release_->set(pair.b, value(i) + difference);
}

int GridAxis::rank() const {
    const bool is_ratio = release_ && release_->is_ratio;
    return is_whole() ? 0 : is_ratio || (number_ && number_->sides != NumericKey::Sides::both) ? 2 : 1;
}

void GridAxis::put_both(Preset& pair) const {
    auto of_both = *this;
    if (number_) of_both.number_->sides = NumericKey::Sides::both;
    of_both.put(pair, 0);
}

PlotAxis GridAxis::plot_axis() const {
    PlotAxis axis{.label = label, .logarithmic = spacing == Spacing::logarithmic};
    const auto [minimum, maximum] = std::minmax_element(numbers_.begin(), numbers_.end());
    axis.low = static_cast<double>(values ? *minimum : is_adaptive_ ? tolerance_from : from);
    axis.high = static_cast<double>(values ? *maximum : is_adaptive_ ? tolerance_to : to);
    constexpr double turn = 360;  // degrees
    if (angle) axis.every = *axis.high - *axis.low < turn ? 30 : 45;
    if (is_whole()) axis.every = 1;
    for (std::size_t i = 0; values && i < count; ++i) {
        auto& tick = axis.ticks.emplace_back(tick_at(static_cast<double>(numbers_[i])));
        if (!labels.empty()) tick.text = labels[i];
    }
    std::ranges::sort(axis.ticks, {}, &Tick::value);
    if (!are_cells || !are_centers()) return axis;
    const double cells = static_cast<double>(count - 1);
    const double half = (*axis.high - *axis.low) / (2 * cells), ratio = std::pow(*axis.high / *axis.low, 0.5 / cells);
    axis.low = axis.logarithmic ? *axis.low / ratio : *axis.low - half;
    axis.high = axis.logarithmic ? *axis.high * ratio : *axis.high + half;
    return axis;
}

std::string GridAxis::difference_words(const Quad& difference) const {
    if (difference == 0) return "";
    const auto far = text_of(difference < 0 ? Quad(-difference) : difference);
    if (angle) return fmt::format("pair {}° apart", far);
    auto [what, unit] = name_and_unit(label);
    if (!unit.empty()) return fmt::format("{} apart by {} {}", what, far, unit);
    if (const auto ratio = what.find(" ratio"); ratio != std::string::npos) what.insert(ratio + 6, "s");
    return fmt::format("{} apart by {}", what, far);
}

void GridAxis::require(const TomlReader& table, std::string_view of, const Quad& number) const {
    if (is_whole() && number != round(number))
        throw table.error(of, "must be a whole number, as {} is; it is {}", key, text_of(number));
    const auto range = missed_range(bounds_, number);
    if (!range) return;
    if (of == "difference") throw table.error(of, "must keep {} {}; one would be {}", key, *range, text_of(number));
    throw table.error(of, "must be {}, as {} is; it is {}", *range, key, text_of(number));
}

}  // namespace doppel
