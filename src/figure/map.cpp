#include "figure/kinds.hpp"
#include "figure/map_figure.hpp"
#include "figure/parameter.hpp"
#include "figure/quantity.hpp"
#include "scene/method_choice.hpp"

#include <array>
#include <cmath>

namespace doppel {
namespace {

enum class Edge { none, kapitza, mathieu };

}  // namespace
template <>
inline constexpr auto names_of<Edge> = std::to_array<std::string_view>({"none", "kapitza", "mathieu"});
namespace {

/// Where a pivot that moves up and down begins to hold one link upright, and where it shakes it over: lines of the
/// amplitude a over the frequency. With l = J/(m c) the length of the ideal pendulum that swings alike, and ν = 2π f,
///     Kapitza    a² ν² = 2 g l ,    for a much less than l
///     Mathieu    −4 g / (l ν²) = a₀(q) and b₁(q) ,   q = 2 a / l ,
/// from the power series of the characteristic values, good to 1e-3 for q ≤ 1.2.
/// Source  Landau & Lifshitz, Mechanics, §30; Abramowitz & Stegun, 20.2.25.
std::vector<Curve> edges_of(Edge edge, const PhysicalPendulum<double>& p) {
    const double mass = p.chain.mass[0], center = p.center[0], gravity = p.chain.gravity;
    const double length = (p.inertia[0] + mass * center * center) / (mass * center);
    std::vector<Curve> curves;
    const auto add = [&](const char* label, double first, double last, const auto& characteristic) {
        Curve curve{.label = label, .hue = 1};
        constexpr int parts = 400;
        for (int i = 0; i <= parts; ++i) {
            const double q = first * std::pow(last / first, static_cast<double>(i) / parts);
            const double below = -characteristic(q);  // 4 g / (l ν²)
            if (!(below > 0)) continue;
            curve.x.push_back(std::sqrt(4 * gravity / (length * below)) / (2 * pi));
            curve.y.push_back(q * length / 2);
        }
        curves.push_back(std::move(curve));
    };
    if (edge == Edge::kapitza) add("Kapitza", 1e-3, 2, [](double q) { return -q * q / 2; });
    if (edge != Edge::mathieu) return curves;
    add("Mathieu", 1e-3, 1.2, [](double q) {
        const double s = q * q;
        return s * (-1.0 / 2 + s * (7.0 / 128 + s * (-29.0 / 2304 + s * 68687 / 18874368)));
    });
    add("", 0.9, 1.2,
        [](double q) { return 1 - q * (1 + q * (1.0 / 8 - q * (1.0 / 64 - q * (1.0 / 1536 + q * (11.0 / 36864))))); });
    return curves;
}

/// A quantity of pairs over two parameters.
class Map final : public MapFigure {
public:
    static constexpr std::string_view table_key = "map";
    Map() { frame_.x = frame_.y = {-180, 180}; }
    explicit Map(FigureReader& reader) : Map() {
        pair_ = reader.pair();
        auto table = reader.settings(*this);
        x_ = parameter_of(reader, table, "x_parameter", x_name_, pair_);
        y_ = parameter_of(reader, table, "y_parameter", y_name_, pair_);
        if (x_name_ == y_name_) throw table.fault("y_parameter", "must be another than x_parameter, \"{}\"", x_name_);
        check_range(table, "x", x_, frame_.x);
        check_range(table, "y", y_, frame_.y);
        if (x_.is_of_one_side && difference_ != 0)
            throw table.fault("difference", "must be 0 for {}, in which the two of a pair cannot differ", x_.name);
        settings_ = resolved_pair(pair_) + table.finish();
        if (!x_.is_of_method && !y_.is_of_method) step_all_alike(pair_, twins(0, 0), reader.stop);
        measurement_.emplace(table, "quantity", quantity_, twins(0, 0), x_.keeps_method && y_.keeps_method,
                             exponent_duration_s_);
        demand_apart(table, quantity_, x_, difference_,
                     {make_scene(twins(0, 0)), make_scene(twins(frame_.y.count - 1, frame_.x.count - 1))});
        make_frame(table);
        const bool is_shaken = x_name_ == "system.pivot.frequency_hz" && y_name_ == "system.pivot.amplitude_m" &&
                               pair_.a.particles.empty() && pair_.a.links() == 1 &&
                               pair_.a.physical.pivot.direction_deg == 90;
        if (edge_ != Edge::none && !is_shaken)
            throw table.fault("edge",
                              "is of one link whose pivot moves up and down, over system.pivot.frequency_hz and "
                              "system.pivot.amplitude_m");
        const Parameter* const parameters[] = {&x_, &y_};
        subtitle_ = varied_subtitle(pair_, parameters, std::array{Quad(frame_.x.middle(0)), Quad(frame_.y.middle(0))},
                                    difference_, measurement_->words());
    }

    template <class Visit>
    void fields(Visit& visit) {
        constexpr auto cells = from_to(2, most_cells_across);
        visit(parameter_field("x_parameter", parameter_help), x_name_);
        visit({"x_from", "its value at the left edge"}, frame_.x.from);
        visit({"x_to", "its value at the right edge"}, frame_.x.to);
        visit({"x_spacing", spacing_help}, frame_.x.spacing);
        visit({"columns", "cells across, each at its middle", "", cells}, frame_.x.count);
        visit(parameter_field("y_parameter", "what the pairs differ in upwards, as x_parameter"), y_name_);
        visit({"y_from", "its value at the lower edge"}, frame_.y.from);
        visit({"y_to", "its value at the upper edge"}, frame_.y.to);
        visit({"y_spacing", spacing_help}, frame_.y.spacing);
        visit({"rows", "cells upwards", "", cells}, frame_.y.count);
        visit({"difference", "of x_parameter between the two of a pair"}, difference_);
        visit({"quantity", quantity_help}, quantity_);
        visit({"edge", "lines where such a pivot holds one link upright, by theory"}, edge_);
        visit({"color_range", "of the colours, [lowest, highest]", "", {}, "that of the numbers"}, color_range_);
        visit({"exponent_duration_s",
               "of the motion that an exponent is found by",
               "s",
               positive,
               "",
               {.holds = quantity_ == Quantity::exponent, .hides = true}},
              exponent_duration_s_);
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        MapFigure::draw(numbers, figure);
        if (edge_ == Edge::none) return;
        for (auto& curve : edges_of(edge_, physical_of(pair_.a).cast<double>()))
            figure.panels.back().curves.push_back(std::move(curve));
    }

    std::string unit() const override { return "pairs"; }
    std::string subtitle() const override { return subtitle_; }

    void find(int row, int column, std::span<TrialNumbers> cells, const std::atomic<bool>& stop) const override {
        const std::size_t most = measurement_->together(false);
        for (std::size_t done = 0; done < cells.size(); done += most) {
            const auto some = cells.subspan(done, std::min(most, cells.size() - done));
            std::vector<Preset> pairs;
            for (std::size_t i = 0; i < some.size(); ++i)
                pairs.push_back(twins(row, column + static_cast<int>(done + i)));
            measurement_->append(pairs, some, stop);
        }
    }
    bool fits_cell(std::span<const double> numbers) const override { return measurement_->fits(numbers); }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        Drawn drawn;
        for (int row = 0; row < frame_.y.count; ++row)
            for (int column = 0; column < frame_.x.count; ++column) drawn.add(at(numbers, row, column));
        return nothing_drawn(quantity_, measurement_->words(), drawn,
                             fmt::format("{} × {}", frame_.x.count, frame_.y.count), pair_.duration_s.text());
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        double least = NAN, most = NAN, missing = 0;
        for (int row = 0; row < frame_.y.count; ++row)
            for (int column = 0; column < frame_.x.count; ++column) {
                const double number = at(numbers, row, column);
                least = std::fmin(least, number);
                most = std::fmax(most, number);
                missing += std::isnan(number);
            }
        const auto& column = frame_.columns[2];
        return {{"least_" + column, least},
                {"greatest_" + column, most},
                {"share_without", missing / frame_.x.count / frame_.y.count}};
    }

private:
    static void check_range(const TomlReader& table, const std::string& axis, const Parameter& parameter,
                            const CellRange& cells) {
        const auto from = axis + "_from", to = axis + "_to";
        if (!(cells.from < cells.to))
            throw table.fault(to, "must be above {} ({}); it is {}", from, cells.from, cells.to);
        if (parameter.is_whole)
            throw table.fault(axis + "_parameter", "{} takes whole numbers alone; vary it in a sweep", parameter.name);
        if (cells.is_logarithmic() && !(cells.from > 0))
            throw table.fault(from, "must be > 0 for equal ratios; it is {}", cells.from);
        parameter.demand(table, from, Quad(cells.middle(0)));
        parameter.demand(table, to, Quad(cells.middle(cells.count - 1)));
    }

    void make_frame(const TomlReader& table) {
        const auto& words = measurement_->words();
        frame_.x_axis = {.label = x_.label};
        frame_.y_axis = {.label = y_.label};
        if (x_.every > 0) frame_.x_axis.every = x_.every;
        if (y_.every > 0) frame_.y_axis.every = y_.every;
        frame_.columns = {x_.name, y_.name};
        frame_.columns.insert(frame_.columns.end(), words.columns.begin(), words.columns.end());
        frame_.look = {.label = words.label,
                       .none_label = words.none,
                       .none_is_bad = words.none_is_bad,
                       .logarithmic = words.logarithmic};
        if (!color_range_) return;
        if (words.logarithmic && !(color_range_->low > 0))
            throw table.fault("color_range", "must be > 0 on the logarithmic scale of \"{}\"; it is [{}, {}]",
                              name_of(quantity_), color_range_->low, color_range_->high);
        frame_.look.low = color_range_->low;
        frame_.look.high = color_range_->high;
    }

    Preset twins(int row, int column) const {
        auto pair = pair_;
        y_.set(pair, Quad(frame_.y.middle(row)), 0);
        x_.set(pair, Quad(frame_.x.middle(column)), difference_);
        return pair;
    }

    Preset pair_;
    std::string x_name_ = "theta1_deg", y_name_ = "theta2_deg";
    Parameter x_, y_;
    Quad difference_ = 0;
    Quantity quantity_ = Quantity::flip_time;
    Edge edge_ = Edge::none;
    std::optional<Range> color_range_;
    double exponent_duration_s_ = ExponentSpec{}.duration_s;
    std::optional<Measurement> measurement_;
    std::string subtitle_;
};

}  // namespace

const FigureKind map_kind = kind_of<Map>("map", FigureKind::System::pair);

}  // namespace doppel
