#include "analysis/stability.hpp"
#include "figure/grid.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// Where a vertically oscillating pivot stabilises one link upright, and destabilises it: its amplitude a, m, over the
/// frequency, Hz. With l = J/(m c) the length of the equivalent simple pendulum, and ν = 2π f:
///     Kapitza    a² ν² = 2 g l ,    for a much less than l
///     Mathieu    −4 g / (l ν²) = a₀(q) and b₁(q) ,   q = 2 a / l ,
/// from the power series of the characteristic values. The error of a₀ is 1e-3 at q = 1 and 5e-3 at q = 1.2; that of b₁
/// is below 1e-3.  Source  Landau & Lifshitz, Mechanics, §30; Abramowitz & Stegun, 20.2.25.
std::vector<Curve> stability_curves(Overlay overlay, const PhysicalPendulum<double>& p) {
    const double mass = p.chain.mass[0], center = p.center[0], gravity = p.chain.gravity;
    const double length = (p.inertia[0] + mass * center * center) / (mass * center);
    std::vector<Curve> curves;
    const auto add = [&](const char* label, double first, double last, const auto& characteristic) {
        Curve curve{.label = label, .hue = 1};
        constexpr int parts = 400;
        for (int i = 0; i <= parts; ++i) {
            const double q = first * std::pow(last / first, static_cast<double>(i) / parts);
            const double below = -characteristic(q);  // 4 g / (l ν²)
            if (below > 0) add_point(curve, std::sqrt(4 * gravity / (length * below)) / (2 * pi), q * length / 2);
        }
        curves.push_back(std::move(curve));
    };
    if (overlay == Overlay::kapitza) {
        add("Kapitza: stable above", 1e-3, 2, [](double q) { return -q * q / 2; });
        return curves;
    }
    add("a₀ of Mathieu: stable above", 1e-3, 1.2, [](double q) {
        const double s = q * q;
        return s * (-1.0 / 2 + s * (7.0 / 128 + s * (-29.0 / 2304 + s * 68687 / 18874368)));
    });
    add("b₁ of Mathieu: unstable above", 0.9, 1.2,
        [](double q) { return 1 - q * (1 + q * (1.0 / 8 - q * (1.0 / 64 - q * (1.0 / 1536 + q * (11.0 / 36864))))); });
    return curves;
}

/// Where a double pendulum released at rest has just enough energy for a flip: θ2 over θ1, degrees, with
///     Σ W_i cosθ_i = Σ W_i − 2 min W_i    (integrate/flips.hpp).
Curve energy_bound(const Pendulum<double>& p) {
    const double w1 = p.gravity * p.length[0] * (p.mass[0] + p.mass[1]), w2 = p.gravity * p.length[1] * p.mass[1];
    const double bound = w1 + w2 - 2 * std::min(w1, w2);
    Curve outline;  // θ2 ≥ 0 first
    constexpr int points = 2000;
    for (int i = -points; i <= points; ++i) {
        const double theta1 = 180.0 * i / points, cosine = (bound - w1 * std::cos(radians(theta1))) / w2;
        if (std::abs(cosine) <= 1) add_point(outline, theta1, std::acos(cosine) / radians(1.0));
    }
    for (auto i = outline.x.size(); i-- > 0;) add_point(outline, outline.x[i], -outline.y[i]);
    if (!outline.x.empty()) add_point(outline, outline.x.front(), outline.y.front());
    return outline;
}

std::vector<Curve> overlay_curves(Overlay overlay, const SideSpec& side) {
    if (overlay == Overlay::none || overlay == Overlay::linear_limit) return {};
    if (overlay == Overlay::energy_bound) return {energy_bound(chain_of(side).cast<double>())};
    return stability_curves(overlay, physical_of(side).cast<double>());
}

/// Whether any part of the line lies inside the axes of the map.
bool shows(const Plot& plot, const Curve& line) {
    for (std::size_t i = 0; i < line.x.size(); ++i)
        if (line.x[i] > *plot.x.low && line.x[i] < *plot.x.high && line.y[i] > *plot.y.low && line.y[i] < *plot.y.high)
            return true;
    return false;
}

/// Counts the regular releases of a curve, and removes equilibria: their exponent is not that of a motion. `rates` are
/// the natural rates of the releases, 1/s: where the interval that contains 0 reaches a tenth of it, the run is too short
/// to call a release regular.
std::string exponent_words(Curve& exponents, const std::vector<double>& unsettled, const std::vector<double>& rates,
                           std::string_view unit) {
    constexpr double resolution = 0.1;
    long regular = 0, unknown = 0, changing = 0;
    std::string equilibria;
    const auto count = exponents.x.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double exponent = exponents.y[i], uncertainty = exponents.uncertainty[i];
        if (!is_regular({exponent, uncertainty}))
            changing += unsettled[i] != 0;
        else
            ++(exponent + 1.5 * uncertainty > resolution * rates[i] ? unknown : regular);
        if (exponent == 0 || uncertainty != 0) continue;
        equilibria += fmt::format(" At {:g}{}, {} equilibrium, it is {:.2f} 1/s.", exponents.x[i], unit,
                                  exponent > 0 ? "an unstable" : "a stable", exponent);
        exponents.y[i] = NAN;
    }
    auto words = regular > 0
                     ? fmt::format("{} of {} releases are regular: their exponent is not above 0", regular, count)
                 : unknown == 0 ? fmt::format("None of {} releases is regular", count)
                                : "";
    if (unknown > 0)
        words += fmt::format("{} cannot be told from 0 in a run this short",
                             regular > 0 ? fmt::format("; that of {} more", unknown)
                                         : fmt::format("The exponent of {} of {} releases", unknown, count));
    words += ". The band is the 68 % interval of the exponent";
    if (changing > 0)
        words += fmt::format(
            "; it is too narrow for {} of the {} releases, where parts of the run differ by more than chance "
            "(transients, sticky orbits)",
            changing, count);
    return fmt::format("{}.{}", words, equilibria);
}

}  // namespace

void Grid::draw(std::span<const TrialNumbers> numbers, Figure& figure) const {
    figure.shares_axes = panel_.exists();
    for (std::size_t p = 0; p < panel_.count; ++p) {
        auto& plot = figure.panels.emplace_back(Plot{.x = groups_[p * color_.count].x.plot_axis()});
        if (panel_.exists()) plot.title = panel_.words(p);
        if (is_map()) {
            plot.y = y_.plot_axis();
            plot.square = x_.angle && y_.angle;
            plot.map = heat_map(numbers, p);
            plot.curves = overlay_curves(overlay_, groups_[p].pair.a);
            if (overlay_ == Overlay::linear_limit) draw_linear_limit(p, plot);
        }
        for (std::size_t c = 0; c < color_.count && !is_map(); ++c)
            draw_curves(numbers, p * color_.count + c, plot, figure);
    }
    if (is_map()) finish_maps(numbers, figure);
    if (quantity_ == Quantity::convergence) finish_convergence(numbers, figure);
    if (const auto rest = rest_words(); !rest.empty()) figure.captions.push_back(rest);
    if (quantity_ == Quantity::stroboscopic)
        figure.captions.push_back(fmt::format("{} drive periods each, after a transient of {}.",
                                              grouped(options_.stroboscope.periods),
                                              grouped(options_.stroboscope.transient_periods)));
}

/// The curves of one panel and colour: of the quantity, and of that on the right axis.
void Grid::draw_curves(std::span<const TrialNumbers> numbers, std::size_t group, Plot& plot, Figure& figure) const {
    const auto say_once = [&](const std::string& sentence) {
        if (std::ranges::count(figure.captions, sentence) == 0) figure.captions.push_back(sentence);
    };
    std::size_t column = words().drawn;
    for (const auto& measurement : groups_[group].measurements) {
        const auto& of = measurement.words();
        const bool is_right = column > words().drawn;
        (is_right ? plot.right.emplace() : plot.y) = {.label = of.label, .logarithmic = of.logarithmic};
        if (range_ && !is_right) plot.y.low = range_->low, plot.y.high = range_->high;
        for (std::size_t i = 0; i < std::max<std::size_t>(1, of.curves.size()); ++i) {
            auto drawn = curve(numbers, group, column + i);
            drawn.right = is_right;
            drawn.hue = static_cast<int>(color_.exists() ? group % color_.count : plot.curves.size());
            drawn.dashed = color_.exists() && column + i > words().drawn;
            if (color_.exists())
                drawn.label = drawn.dashed ? "" : color_.words(group % color_.count);
            else if (!of.curves.empty() || right_)
                drawn.label = of.curves.empty() ? of.short_label : of.curves[i];
            if (measurement.quantity() == Quantity::exponent) {
                drawn.uncertainty = curve(numbers, group, column + 1).y;
                const auto unsettled = curve(numbers, group, column + 2).y;
                std::vector<double> rates;
                for (std::size_t x = 0; x < drawn.x.size(); ++x)
                    rates.push_back(1 / NaturalUnits(physical_of(pair_at({group, 0, x}).a).cast<double>()).time);
                const auto said = joined_words(group);
                figure.captions.push_back((said.empty() ? "" : said + ": ") +
                                          exponent_words(drawn, unsettled, rates, x_.angle ? "°" : ""));
            }
            if (drawn.dashed) say_once("Dashed: " + (of.curves.empty() ? of.short_label : of.curves[i]) + ".");
            for (std::size_t x = 0; x < groups_[group].x.count; ++x)
                if (const Cell cell{group, 0, x};
                    is_missing(cell, measurement.quantity(), at(numbers, cell)[column + i]))
                    say_once(fmt::format("Not drawn: {}.", of.none));
            plot.curves.push_back(std::move(drawn));
        }
        column += measurement.numbers();
    }
}

Curve Grid::curve(std::span<const TrialNumbers> numbers, std::size_t group, std::size_t column) const {
    const bool is_one = words().rows == 1;
    const auto in_row = words().columns.size();
    Curve made{.mark = is_one ? Mark::line : Mark::density};
    if (words().drawn > 0) made.mark = Mark::both;
    const auto& x = groups_[group].x;
    for (std::size_t i = 0; i < x.count; ++i) {
        const auto all = at(numbers, {group, 0, i});
        const auto value = words().drawn > 0 ? all[0] : static_cast<double>(x.value(i));
        if (is_one) add_point(made, value, leaves_out({group, 0, i}) ? NAN : all[column]);
        for (std::size_t n = in_row - 1; !is_one && n < all.size(); n += in_row) add_point(made, value, all[n]);
    }
    return made;
}

/// States where a curve has no point because both pendulums rest.
std::string Grid::rest_words() const {
    if (right_ || words().drawn > 0) return "";
    std::vector<std::string> places;
    for (std::size_t i = 0; i < groups_[0].x.count; ++i)
        if (leaves_out({0, 0, i})) places.push_back(groups_[0].x.words(i));
    if (places.empty()) return "";
    if (const auto count = places.size(); count > 2)
        places = {fmt::format("{} values from {} to {}", count, places.front(), places.back())};
    return fmt::format("Not drawn: {}, where both pendulums rest in equilibrium.", fmt::join(places, " and "));
}

void Grid::finish_convergence(std::span<const TrialNumbers> numbers, Figure& figure) const {
    constexpr double steepest = 15;  // a larger slope belongs to a method without a fixed order
    std::vector<std::string> slopes, minimum;
    for (std::size_t p = 0; p < panel_.count; ++p) {
        double nearest = NAN;
        for (std::size_t c = 0; c < color_.count; ++c) {
            const auto group = p * color_.count + c;
            for (std::size_t i = 0; i < groups_[group].x.count; ++i) {
                const double distance = value_at(numbers, {group, 0, i});
                if (distance > 0) nearest = std::fmin(nearest, distance);
            }
            if (const double of = slope(numbers, group); p + 1 == panel_.count && of < steepest)
                slopes.push_back(fmt::format("{} {:.2f}", color_.exists() ? color_.words(c) : "", of));
        }
        minimum.push_back(scientific(nearest) + (panel_.exists() ? " in " + panel_.words(p) : ""));
    }
    // of the same system, whose distance is the error of the methods
    const auto keys = paired(keys_of(groups_[0].pair.a), keys_of(groups_[0].pair.b));
    const bool is_error = std::ranges::all_of(keys, [](const auto& k) { return k.any().is_setting || !k.differs(); });
    figure.captions.push_back(fmt::format(
        "{}{}: {}. The smallest distance is {}.",
        is_error ? "The distance falls with the order of each method; slopes" : "Slopes of the distance over the step",
        panel_.exists() ? " in " + panel_.words(panel_.count - 1) : "", fmt::join(slopes, ", "),
        fmt::join(minimum, " and ")));
    for (auto& plot : figure.panels) {
        plot.x = {.label = "step, s (the mean step of adaptive methods)", .logarithmic = true};
        if (mark_step_)
            plot.rules.push_back({Rule::Orientation::vertical, mark_step_->value(), step_text(*mark_step_)});
    }
}

/// Draws the step size limit, s, over y in the map of panel p, if the method has one. If all are equal, it is a rule.
void Grid::draw_linear_limit(std::size_t p, Plot& plot) const {
    const auto* method = find_method(groups_[p].pair.a.integrator);
    if (!method || method->adaptive) return;
    Curve curve{.dashed = true, .quiet = true};
    for (std::size_t row = 0; row < y_.count; ++row) {
        const auto pair = pair_at({p, row, 0});
        const auto modes = small_oscillations(chain_of(pair.a).cast<double>());
        const auto limit = step_limit(method->name, modes, pair.duration_s.value(), failure_error);
        add_point(curve, limit.value_or(NAN), static_cast<double>(y_.value(row)));
    }
    const auto [minimum, maximum] = std::minmax_element(curve.x.begin(), curve.x.end());
    constexpr double tolerance = 1e-4;
    if (std::isnan(*minimum)) return;
    if (*maximum < *minimum * (1 + tolerance)) {
        plot.rules.push_back({Rule::Orientation::vertical, *minimum, ""});
        plot.note = fmt::format("limit {:.3g} s", *minimum);
        return;
    }
    curve.y.front() = *plot.y.low;
    curve.y.back() = *plot.y.high;
    plot.curves.push_back(std::move(curve));
}

HeatMap Grid::heat_map(std::span<const TrialNumbers> numbers, std::size_t group) const {
    HeatMap map = map_style_;
    map.columns = groups_[group].x.count;
    map.values.reserve(map.columns * map.rows);
    for (std::size_t row = 0; row < map.rows; ++row)
        for (std::size_t column = 0; column < map.columns; ++column) {
            const double number = at(numbers, {group, row, column})[0];
            const double shown = words().range && number < words().range->low ? words().range->low : number;
            map.values.push_back(static_cast<float>(std::isfinite(shown) ? shown : NAN));
        }
    return map;
}

/// Sets the common parts of all panels: one colour scale, and the label of cells without a number; then the captions.
void Grid::finish_maps(std::span<const TrialNumbers> numbers, Figure& figure) const {
    HeatMap all = map_style_;
    for (const auto& plot : figure.panels)
        all.values.insert(all.values.end(), plot.map->values.begin(), plot.map->values.end());
    if (std::ranges::none_of(all.values, [](float cell) { return std::isnan(cell); })) all.none_label = "";
    const auto spec = measurements().front().flips_in_lanes();
    long broken = 0;  // flips: infinite if there is none
    if (spec) for_each_cell([&](const Cell& cell) { broken += std::isnan(at(numbers, cell)[0]); });
    if (broken > 0) all.none_label += ", or failed";
    const auto scale = MapScale(all).axis;
    for (auto& plot : figure.panels) {
        plot.map->none_label = all.none_label;
        if (figure.panels.size() > 1) plot.map->low = scale.low, plot.map->high = scale.high;
    }
    const auto& plot = figure.panels.front();
    const bool has_outline = overlay_ == Overlay::energy_bound && shows(plot, plot.curves.front());
    const std::string outline = has_outline ? "Inside the line no rod has the energy to flip." : "";
    if (spec)
        figure.captions.push_back(
            fmt::format("{} × {} releases{}.{}{} Taylor series of order 16 in SIMD lanes at tolerance {}.", x_.count,
                        y_.count, is_zero(pair_.a.omega_deg_per_s) ? " from rest" : "", has_outline ? " " : "", outline,
                        scientific(spec->tolerance)));
    else if (has_outline)
        figure.captions.push_back(outline);
    if (broken > 0)
        figure.captions.push_back(
            fmt::format("{} of the releases failed (no step of 10⁻⁹ s met the tolerance): their cells are empty, as "
                        "are those without a flip.",
                        broken));
    if (quantity_ != Quantity::stability) return;
    // a number of columns that gives each type of method its own rows
    constexpr std::size_t many = 6, few = 3;
    const auto stepped = std::ranges::count_if(groups_, [](const Group& group) {
        return group.x.is_setting() && !find_method(group.pair.a.integrator)->adaptive;
    });
    if (groups_.size() > many) figure.columns = stepped % few == 0 ? few : few + 1;
    figure.captions.push_back(
        fmt::format("{}A run has failed if its error exceeds {:g} times the energy released, if it is NaN, or if gauss "
                    "or rattle do not converge.",
                    overlay_ == Overlay::linear_limit
                        ? fmt::format("Dashed: the linear stability limit, where small oscillations gain {:g} times "
                                      "their energy in {} s; Gauss collocation has none. ",
                                      failure_error, seconds_text(pair_))
                        : "",
                    failure_error));
}

}  // namespace doppel
