#include "analysis/stability.hpp"
#include "figure/grid_axis.hpp"
#include "figure/overlay.hpp"
#include "figure/quantity.hpp"
#include "figure/system_words.hpp"
#include "scene/captions.hpp"
#include "scene/method_choice.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

constexpr std::string_view key_help =
    "key that is varied: a key (system.gravity_m_per_s2, b.mass_kg[1], system.force.NAME.stiffness_N_per_m), or "
    "theta1_deg, theta2_deg, mass_ratio, length_ratio, links; or setting: the step, or the tolerance of an adaptive "
    "method";

/// Whether some of the line lies inside the axes of the map.
bool shows(const Plot& plot, const Curve& line) {
    for (std::size_t i = 0; i < line.x.size(); ++i)
        if (line.x[i] > *plot.x.low && line.x[i] < *plot.x.high && line.y[i] > *plot.y.low && line.y[i] < *plot.y.high)
            return true;
    return false;
}

/// A quantity of pairs over the values of one to four keys: curves over x, of several colours; maps over x and y; panels of
/// either. A trial is a value of x of a curve, or some cells side by side in a row of a map, from below; of a mirrored map in
/// the lower half of them.
class Grid final : public Experiment {
public:
    static constexpr std::string_view table_key = "grid";
    Grid() { x_.key = "theta1_deg"; }
    explicit Grid(FigureReader& reader) : Grid() {
        pair_ = reader.pair();
        auto table = reader.settings(*this);
        find_axes(reader);
        settings_ = resolved_pair(pair_) + table.finish();
        check(table);
        for (std::size_t p = 0; p < panel_.count; ++p)
            for (std::size_t c = 0; c < color_.count; ++c) add_group(reader, table, p, c);
        for (const auto& measurement : measurements()) cell_numbers_ += measurement.numbers();
        if (is_map()) make_map(table);
        std::size_t first = 0;
        for (auto& group : groups_) group.first = std::exchange(first, first + rows_computed() * trials_of_row(group));
        make_subtitle();
    }

    template <class Visit>
    void fields(Visit& visit) {
        visit({"quantity", quantity_help}, quantity_);
        visit({.key = "right",
               .help = "a second quantity of curves, on an axis at the right",
               .names = names_of<Quantity>},
              right_);
        visit({"difference", "difference difference of the key of x between the two of a pair"}, difference_);
        const auto has = [&](Quantity quantity) { return quantity_ == quantity || right_ == name_of(quantity); };
        visit({"exponent_duration_s",
               "duration of the motion from which an exponent is computed",
               "s",
               positive,
               "",
               {.holds = has(Quantity::exponent), .hides = true}},
              options_.exponent_duration_s);
        const Only of_flips{has(Quantity::flip_time), "is of flip_time"};
        visit({"flip_tolerance",
               "tolerance of the Taylor series for flips of two links: size of the last terms of a step",
               "rad/s",
               {.low = 1e-15, .is_positive = true},
               "1e-8 up to 20 s, for longer times less",
               of_flips},
              options_.flip_tolerance);
        const Only strobed{.holds = quantity_ == Quantity::stroboscopic, .hides = true};
        auto& strobe = options_.stroboscope;
        visit({"link", "whose rate is shown", "", from_to(1, 10'000), "", strobed}, strobe.link);
        visit({"transient_periods", "transient, in periods of the drive", "", from_to(0, 1'000'000), "", strobed},
              strobe.transient_periods);
        visit({"periods", "periods of the drive that are shown", "", from_to(1, 100'000), "", strobed}, strobe.periods);
        visit({"overlay",
               "lines of theory on a map: where a vibrating pivot keeps one link upright, where two links released at "
               "rest have the energy to flip, or the linear stability limit of a method"},
              overlay_);
        visit({"mark_step_s",
               "a step marked by a line",
               "s",
               positive,
               "",
               {.holds = quantity_ == Quantity::convergence, .hides = true}},
              mark_step_);
        visit({"color_range", "range range of the colours of a map, [lowest, highest]", "", {}, "that of the numbers"},
              color_range_);
        visit.table("x", [&](auto& table) { x_.fields(table, key_help); });
        visit.table("y", [&](auto& table) { y_.fields(table, "the same upwards: a map, of cells"); });
        visit.table("color", [&](auto& table) { color_.fields(table, "a curve for each value"); });
        visit.table("panel", [&](auto& table) { panel_.fields(table, "a panel for each value"); });
    }

    std::size_t trials() const override {
        return groups_.back().first + rows_computed() * trials_of_row(groups_.back());
    }
    std::size_t together() const override {
        const bool is_shared = difference_ == x_.step && !x_.points && !x_.values;
        return is_map() ? 1 : measurements().front().together(is_shared);
    }
    std::string unit() const override { return "pairs"; }
    double units(std::size_t trial) const override {
        const auto row = place_of(trial).row;
        return static_cast<double>(cells_of(trial) * (is_mirrored_ && row != y_.count - 1 - row ? 2 : 1));
    }
    std::string subtitle() const override { return subtitle_; }
    std::optional<MapCells> map() const override {
        if (!is_map()) return std::nullopt;
        return MapCells{static_cast<int>(groups_[0].x.count), static_cast<int>(y_.count), groups_.size(),
                        cell_numbers_};
    }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (std::size_t done = 1; !numbers.empty(); first += done, numbers = numbers.subspan(done)) {
            done = 1;
            if (is_map()) {
                std::vector<TrialNumbers> cells(cells_of(first));
                find_cells(place_of(first), cells, stop);
                for (const auto& cell : cells) numbers[0].insert(numbers[0].end(), cell.begin(), cell.end());
            } else {
                const auto place = place_of(first);
                done = std::min(numbers.size(), groups_[place.group].x.count - place.column);
                find_cells(place, numbers.first(done), stop);
            }
        }
    }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        if (numbers.size() != cell_numbers_ * cells_of(trial)) return false;
        while (!numbers.empty())
            for (const auto& measurement : measurements()) {
                if (!measurement.fits(numbers.first(measurement.numbers()))) return false;
                numbers = numbers.subspan(measurement.numbers());
            }
        return true;
    }

    std::vector<std::string> columns() const override {
        std::vector<std::string> names, last;
        for (const auto* axis : {&color_, &panel_, &x_, &y_})
            if (axis != &x_ || words().drawn == 0)
                for (const auto& name : axis->columns()) names.push_back(name);
        if (!words().counted.empty()) names.push_back(words().counted);
        for (const auto& measurement : measurements()) {
            const auto& of = measurement.words();
            names.insert(names.end(), of.columns.begin(), of.columns.end());
            if (!of.last_column.empty()) last.push_back(of.last_column);
        }
        names.insert(names.end(), last.begin(), last.end());
        return names;
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for_each_cell([&](const Cell& cell) {
            for (std::size_t row = 0; row < words().rows; ++row) {
                color_.write(cell.group % color_.count, table);
                panel_.write(cell.group / color_.count, table);
                if (words().drawn == 0) groups_[cell.group].x.write(cell.column, table);
                y_.write(cell.row, table);
                if (!words().counted.empty()) table.add(words().first_row + static_cast<long>(row));
                std::vector<double> last;
                auto rest = at(numbers, cell);
                for (const auto& measurement : measurements()) {
                    const auto in_row = measurement.words().columns.size();
                    for (const double number : rest.subspan(row * in_row, in_row))
                        table.add_or_empty(std::isfinite(number) ? number : NAN);
                    if (!measurement.words().last_column.empty()) last.push_back(rest[in_row]);
                    rest = rest.subspan(measurement.numbers());
                }
                for (const double number : last) table.add(number);
                table.end_row();
            }
        });
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        figure.shares_axes = panel_.is_there() && is_map();
        for (std::size_t p = 0; p < panel_.count; ++p) {
            auto& plot = figure.panels.emplace_back(Plot{.x = groups_[p * color_.count].x.plot_axis()});
            if (panel_.is_there()) plot.title = panel_.words(p);
            if (is_map()) {
                plot.y = y_.plot_axis();
                plot.square = x_.angle && y_.angle;
                plot.map = heat_map(numbers, p);
                plot.curves = overlay_curves(overlay_, groups_[p].pair.a);
                if (overlay_ == Overlay::linear_limit) add_limit(p, plot);
            }
            for (std::size_t c = 0; c < color_.count && !is_map(); ++c)
                draw_curves(numbers, p * color_.count + c, plot, figure);
        }
        if (is_map()) finish_maps(numbers, figure);
        if (quantity_ == Quantity::convergence) finish_convergence(numbers, figure);
        if (quantity_ == Quantity::stroboscopic)
            figure.captions.push_back(fmt::format("{} drive periods each, after a transient of {}.",
                                                  grouped(options_.stroboscope.periods),
                                                  grouped(options_.stroboscope.transient_periods)));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        if (right_) return std::nullopt;
        Drawn drawn;
        for_each_cell([&](const Cell& cell) { drawn.add(value_at(numbers, cell)); });
        if (quantity_ == Quantity::stroboscopic && !drawn.any) return "the run failed at every value";
        const auto pairs = fmt::format("{}{}", x_.count, is_map() ? fmt::format(" × {}", y_.count) : "");
        return nothing_drawn(quantity_, words(), drawn, pairs, seconds_text(pair_));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        if (quantity_ == Quantity::stroboscopic) return period_findings(numbers);
        const auto& column = words().columns[words().drawn];
        double least = NAN, most = NAN, regular = 0, missing = 0, forbidden = 0;
        const bool is_bounded = overlay_ == Overlay::energy_bound;
        double cells = 0;
        auto released = is_bounded ? chain_of(pair_.a).cast<double>() : Pendulum<double>();
        for_each_cell([&](const Cell& cell) {
            const auto of_cell = at(numbers, cell);
            const double value = value_at(numbers, cell);
            if (std::isfinite(value)) least = std::fmin(least, value), most = std::fmax(most, value);
            missing += is_missing(cell, value);
            ++cells;
            if (const auto place = exponent_place()) regular += is_regular({of_cell[*place], of_cell[*place + 1]});
            if (!is_bounded) return;
            released.angle = {radians(static_cast<double>(x_.value(cell.column))),
                              radians(static_cast<double>(y_.value(cell.row)))};
            forbidden += flip_is_forbidden(released);
        });
        std::vector<Finding> all{{"least_" + column, least}, {"greatest_" + column, most}};
        if (is_map()) all.push_back({"share_without", missing / cells});
        if (!is_map() && missing > 0)
            all.push_back({words().none_is_bad ? "trials_broken_down" : "trials_without", missing});
        if (is_bounded) all.push_back({"share_forbidden_by_energy", forbidden / cells});
        if (exponent_place()) all.push_back({"regular_trials", regular});
        for (std::size_t group = 0; group < groups_.size() && quantity_ == Quantity::convergence; ++group)
            all.push_back({"slope_" + joined_words(group, "_"), slope(numbers, group)});
        return all;
    }

private:
    /// The pairs of one panel and colour, which differ along x and y alone.
    struct Group {
        Preset pair;
        GridAxis x;
        std::size_t first = 0;                  // trial
        std::vector<Measurement> measurements;  // of the quantity, and of the one at the right
    };
    struct Cell {
        std::size_t group, row, column;
    };

    void find_axes(FigureReader& reader) {
        x_.are_cells = y_.are_cells = is_map();
        auto table = reader.document.table(reader.top, table_key);
        for (const auto& [role, axis] : {std::pair("x", &x_), {"y", &y_}, {"color", &color_}, {"panel", &panel_}})
            axis->find(reader, table.inner(table.read_table(role), fmt::format("[{}.{}]", table_key, role)), pair_);
    }

    /// What the axes, and other keys beside them, say together.
    void check(const TomlReader& table) const {
        std::vector<std::string_view> names;
        for (const auto* axis : {&x_, &y_, &color_, &panel_}) {
            if (axis->is_there() && std::find(names.begin(), names.end(), axis->key) != names.end())
                throw table.fault("x", "and the other axes must have different keys; \"{}\" is there twice", axis->key);
            names.push_back(axis->key);
        }
        for (const auto& [role, axis] : {std::pair("x", &x_), {"y", &y_}, {"color", &color_}, {"panel", &panel_}}) {
            const bool is_curves = axis == &color_ || axis == &panel_;
            if (!axis->levels.empty() && !is_curves)
                throw table.fault(role, "takes numbers; \"{}\" is for panel or color", axis->key);
            if (axis->is_setting() && axis != &x_)
                throw table.fault(role, "cannot be \"setting\", which is only for x");
        }
        if (x_.is_of_one_side && difference_ != 0)
            throw table.fault("difference", "must be 0 for {}, in which the sides do not differ", x_.key);
        for (const auto& end : {x_.value(0), x_.value(x_.count - 1)})
            x_.demand(table, "difference", Quad(end + difference_));
        if (is_map() && color_.is_there())
            throw table.fault("color", "is of curves; the colours of a map are its numbers");
        if (is_map() && right_) throw table.fault("right", "is of curves; a map has one quantity");
        if (right_ == name_of(quantity_) || right_ == name_of(Quantity::stroboscopic))
            throw table.fault("right", "must be another quantity, of one number a pair; it is \"{}\"", *right_);
        if (quantity_ == Quantity::convergence && (!x_.is_setting() || is_map() || right_))
            throw table.fault("quantity", "\"convergence\" takes [grid.x] key = \"setting\", and no [grid.y] or right");
        if (quantity_ == Quantity::stroboscopic && (is_map() || right_))
            throw table.fault("quantity", "\"stroboscopic\" has many numbers, which are points over x alone");
        if (!is_map() && color_range_) throw table.fault("color_range", "is of maps, which have [grid.y]");
        check_overlay(table);
    }

    void check_overlay(const TomlReader& table) const {
        const auto& a = pair_.a;
        const bool is_shaken = x_.key == "system.pivot.frequency_hz" && y_.key == "system.pivot.amplitude_m" &&
                               a.particles.empty() && a.links() == 1 && a.physical.pivot.direction_deg == 90;
        if (overlay_ == Overlay::energy_bound && !(is_of_releases() && is_zero(a.omega_deg_per_s)))
            throw table.fault("overlay",
                              "\"energy-bound\" is of two ideal links released at rest, theta2_deg over theta1_deg");
        if ((overlay_ == Overlay::kapitza || overlay_ == Overlay::mathieu) && !is_shaken)
            throw table.fault("overlay",
                              "is of one link whose pivot moves up and down, over system.pivot.frequency_hz and "
                              "system.pivot.amplitude_m");
        if (overlay_ == Overlay::linear_limit && !(is_map() && quantity_ == Quantity::stability && x_.is_setting()))
            throw table.fault("overlay", "\"linear-limit\" is of a map of stability over the setting");
    }

    void add_group(FigureReader& reader, const TomlReader& table, std::size_t p, std::size_t c) {
        std::vector<TomlReader> levels;
        for (const auto& [axis, i] : {std::pair(&panel_, p), {&color_, c}})
            if (!axis->levels.empty()) levels.push_back(axis->levels[i].top());
        std::vector<TomlReader*> more;
        for (auto& level : levels) more.push_back(&level);
        auto& group = groups_.emplace_back(Group{levels.empty() ? pair_ : reader.pair(more), x_, 0, {}});
        panel_.demand_in(table, "panel", group.pair);
        panel_.put(group.pair, p);
        color_.demand_in(table, "color", group.pair);
        color_.put(group.pair, c);
        group.x.settle(group.pair);
        x_.demand_in(table, "x", group.pair);
        y_.demand_in(table, "y", group.pair);
        const auto number = groups_.size() - 1;
        if (!x_.is_of_method && !y_.is_of_method) step_all_alike(group.pair, pair_at({number, 0, 0}), reader.stop);
        const auto first = pair_at({number, 0, 0}), last = pair_at({number, y_.count - 1, group.x.count - 1});
        const auto measure = [&](std::string_view key, Quantity quantity) {
            group.measurements.emplace_back(table, key, quantity, first, x_.keeps_method && y_.keeps_method, options_);
            demand_apart(table, quantity, x_.is_of_one_side, difference_, {make_scene(first), make_scene(last)});
            if (quantity == Quantity::stroboscopic) demand_drive(table, key, options_.stroboscope, last.a);
        };
        measure("quantity", quantity_);
        if (right_) measure("right", value_named<Quantity>(*right_));
        const auto spec = group.measurements.front().flips_in_lanes();
        if (options_.flip_tolerance && !spec)
            throw table.fault("flip_tolerance", "is of flips of two ideal links; other flips go by the integrator");
    }

    void make_map(const TomlReader& table) {
        look_ = {.rows = y_.count,
                 .y_low = static_cast<double>(y_.from),
                 .y_high = static_cast<double>(y_.to),
                 .label = words().label,
                 .none_label = words().none,
                 .none_is_bad = words().none_is_bad,
                 .logarithmic = words().logarithmic,
                 .shares_bar = panel_.is_there()};
        if (const auto& range = words().range) look_.low = range->low, look_.high = range->high;
        if (quantity_ == Quantity::flip_time) look_.high = pair_.duration_s.value();
        const auto is_even = [](const GridAxis& axis) {
            return axis.spacing == Spacing::linear && axis.from == -axis.to;
        };
        is_mirrored_ = measurements().front().flips_in_lanes() && is_of_releases() && is_even(x_) && is_even(y_) &&
                       is_zero(pair_.a.omega_deg_per_s);
        constexpr std::size_t most_in_row = 256;  // trials
        piece_ = std::max(measurements().front().together(false), (x_.count + most_in_row - 1) / most_in_row);
        if (!color_range_) return;
        if (words().logarithmic && !(color_range_->low > 0))
            throw table.fault("color_range", "must be > 0 on the logarithmic scale of \"{}\"; it is [{}, {}]",
                              name_of(quantity_), color_range_->low, color_range_->high);
        look_.low = color_range_->low;
        look_.high = color_range_->high;
    }

    /// What moves, how it is stepped and how far twins are apart, of pairs that are alike but for the axes.
    void make_subtitle() {
        Varied varied{.method = words().method};
        auto pair = groups_.front().pair;
        if (words().is_of_side_a) pair.b = pair.a;
        for (const auto* axis : {&x_, &y_, &color_, &panel_}) {
            axis->put_both(pair);  // the difference of all twins is named on its own
            if (axis->angle) varied.angles.push_back(*axis->angle);
            varied.step |= axis->is_of_method;
            if (!axis->levels.empty() || axis->key.ends_with("links")) varied.keys.push_back(axis->key);
        }
        subtitle_ = pair_subtitle(make_scene(pair), varied, words().is_of_side_a ? "" : x_.apart(difference_));
    }

    bool is_map() const { return y_.is_there(); }
    bool is_of_releases() const {
        return x_.key == "theta1_deg" && y_.key == "theta2_deg" && !pair_.a.is_mechanism() &&
               pair_.a.physical.is_none() && pair_.a.links() == 2;
    }
    std::size_t rows_computed() const { return is_mirrored_ ? (y_.count + 1) / 2 : y_.count; }
    std::size_t trials_of_row(const Group& group) const { return (group.x.count + piece_ - 1) / piece_; }
    const std::vector<Measurement>& measurements() const { return groups_.front().measurements; }
    const QuantityWords& words() const { return measurements().front().words(); }
    /// Of an exponent's first number among those of a curve's value.
    std::optional<std::size_t> exponent_place() const {
        if (!is_map() && quantity_ == Quantity::exponent) return 0;
        return right_ == name_of(Quantity::exponent) ? std::optional(measurements().front().numbers()) : std::nullopt;
    }

    Preset pair_at(const Cell& cell) const {
        auto pair = groups_[cell.group].pair;
        y_.put(pair, cell.row);
        groups_[cell.group].x.put(pair, cell.column, difference_);
        return pair;
    }

    /// The first cell of a trial, and how many are its own.
    Cell place_of(std::size_t trial) const {
        const auto next = std::find_if(groups_.begin(), groups_.end(), [&](const Group& g) { return g.first > trial; });
        const auto& group = *std::prev(next);
        const auto row = (trial - group.first) / trials_of_row(group);
        return {static_cast<std::size_t>(&group - groups_.data()), row,
                (trial - group.first) % trials_of_row(group) * piece_};
    }
    std::size_t cells_of(std::size_t trial) const {
        const auto place = place_of(trial);
        return std::min(piece_, groups_[place.group].x.count - place.column);
    }

    /// Of cells side by side.
    void find_cells(Cell first, std::span<TrialNumbers> cells, const std::atomic<bool>& stop) const {
        const auto& group = groups_[first.group];
        const std::size_t most = std::max(together(), group.measurements.front().together(false));
        auto pair = group.pair;
        for (; !cells.empty(); cells = cells.subspan(std::min(most, cells.size())), first.column += most) {
            const auto at = [&](std::size_t i) -> const Preset& {
                pair.a = group.pair.a;
                if (right_ || !words().is_of_side_a) pair.b = group.pair.b;  // else nothing is found of it
                y_.put(pair, first.row);
                group.x.put(pair, first.column + i, difference_);
                return pair;
            };
            for (const auto& measurement : group.measurements)
                measurement.append(at, cells.first(std::min(most, cells.size())), stop);
        }
    }

    /// The numbers of a cell, computed or those of its mirror image.
    std::span<const double> at(std::span<const TrialNumbers> numbers, const Cell& cell) const {
        const bool is_there = cell.row < rows_computed();
        const auto row = is_there ? cell.row : y_.count - 1 - cell.row;
        const auto& group = groups_[cell.group];
        const auto column = is_there ? cell.column : group.x.count - 1 - cell.column;
        const auto trial = group.first + row * trials_of_row(group) + column / piece_;
        return std::span(numbers[trial]).subspan(column % piece_ * cell_numbers_, cell_numbers_);
    }

    /// What is drawn of it.
    double value_at(std::span<const TrialNumbers> numbers, const Cell& cell) const {
        return at(numbers, cell)[words().drawn];
    }

    template <class Visit>
    void for_each_cell(const Visit& visit) const {
        for (std::size_t group = 0; group < groups_.size(); ++group)
            for (std::size_t row = 0; row < y_.count; ++row)
                for (std::size_t column = 0; column < groups_[group].x.count; ++column) visit(Cell{group, row, column});
    }

    /// Of two that are one there is no ratio to their first distance: of a curve it is not missing.
    bool is_missing(const Cell& cell, double number) const {
        if (std::isfinite(number) || is_map() || quantity_ != Quantity::divergence) return !std::isfinite(number);
        const auto pair = pair_at(cell);
        return !released_alike(pair.a, pair.b);
    }

    Curve curve(std::span<const TrialNumbers> numbers, std::size_t group, std::size_t column) const {
        const bool is_one = words().rows == 1;
        const auto in_row = words().columns.size();
        Curve made{.mark = is_one ? Mark::line : Mark::points};
        if (words().drawn > 0) made.mark = Mark::both;
        const auto& x = groups_[group].x;
        for (std::size_t i = 0; i < x.count; ++i) {
            const auto all = at(numbers, {group, 0, i});
            const auto value = words().drawn > 0 ? all[0] : static_cast<double>(x.value(i));
            if (is_one) add_point(made, value, all[column]);
            for (std::size_t n = in_row - 1; !is_one && n < all.size(); n += in_row) add_point(made, value, all[n]);
        }
        return made;
    }

    /// The curves of one panel and colour: of the quantity, and of the one at the right.
    void draw_curves(std::span<const TrialNumbers> numbers, std::size_t group, Plot& plot, Figure& figure) const {
        std::size_t column = words().drawn;
        for (const auto& measurement : groups_[group].measurements) {
            const auto& of = measurement.words();
            const bool is_right = column > words().drawn;
            (is_right ? plot.right.emplace() : plot.y) = {.label = of.label, .logarithmic = of.logarithmic};
            for (std::size_t i = 0; i < std::max<std::size_t>(1, of.curves.size()); ++i) {
                auto drawn = curve(numbers, group, column + i);
                drawn.right = is_right;
                drawn.hue = static_cast<int>(color_.is_there() ? group % color_.count : plot.curves.size());
                drawn.dashed = color_.is_there() && column + i > words().drawn;
                if (color_.is_there())
                    drawn.label = drawn.dashed ? "" : color_.words(group % color_.count);
                else if (!of.curves.empty() || right_)
                    drawn.label = of.curves.empty() ? of.short_label : of.curves[i];
                if (measurement.quantity() == Quantity::exponent) {
                    drawn.uncertainty = curve(numbers, group, column + 1).y;
                    figure.captions.push_back(group_words(group) + exponent_words(drawn,
                                                                                  curve(numbers, group, column + 2).y,
                                                                                  x_.angle ? "°" : ""));
                }
                plot.curves.push_back(std::move(drawn));
            }
            column += measurement.numbers();
        }
    }

    /// "rk4, θ₂ = 30°: "; empty where there is one group.
    std::string group_words(std::size_t group) const {
        const auto said = joined_words(group, ", ");
        return said.empty() ? "" : said + ": ";
    }
    std::string joined_words(std::size_t group, const char* between) const {
        const auto panel = panel_.is_there() ? panel_.words(group / color_.count) : "";
        if (!color_.is_there()) return panel;
        return panel + (panel.empty() ? "" : between) + color_.words(group % color_.count);
    }

    /// The order of convergence: with steps between the two finest, with tolerances over the middle third.
    double slope(std::span<const TrialNumbers> numbers, std::size_t group) const {
        const auto count = groups_[group].x.count;
        const bool is_adaptive = find_method(groups_[group].pair.a.integrator)->adaptive;
        const auto coarse = at(numbers, {group, 0, is_adaptive ? count / 3 : count - 2});
        const auto fine = at(numbers, {group, 0, is_adaptive ? 2 * count / 3 : count - 1});
        return std::log(coarse[1] / fine[1]) / std::log(coarse[0] / fine[0]);
    }

    void finish_convergence(std::span<const TrialNumbers> numbers, Figure& figure) const {
        constexpr double steepest = 15;  // a slope beyond is that of a method without an order of its own
        std::vector<std::string> slopes, least;
        PlotAxis y = figure.panels.front().y;  // one scale for all
        for (std::size_t p = 0; p < panel_.count; ++p) {
            double nearest = NAN;
            for (std::size_t c = 0; c < color_.count; ++c) {
                const auto group = p * color_.count + c;
                for (std::size_t i = 0; i < groups_[group].x.count; ++i) {
                    const double distance = value_at(numbers, {group, 0, i});
                    if (!(distance > 0)) continue;
                    nearest = std::fmin(nearest, distance);
                    y.low = std::fmin(y.low.value_or(NAN), distance / 3);
                    y.high = std::fmax(y.high.value_or(NAN), distance * 3);
                }
                if (const double of = slope(numbers, group); p + 1 == panel_.count && of < steepest)
                    slopes.push_back(fmt::format("{} {:.2f}", color_.is_there() ? color_.words(c) : "", of));
            }
            least.push_back(scientific(nearest) + (panel_.is_there() ? " in " + panel_.words(p) : ""));
        }
        figure.captions.push_back(
            fmt::format("The distance falls with the order of each method; slopes{}: {}. The smallest distance is {}.",
                        panel_.is_there() ? " in " + panel_.words(panel_.count - 1) : "", fmt::join(slopes, ", "),
                        fmt::join(least, " and ")));
        for (auto& plot : figure.panels) {
            plot.x = {.label = "step, s (the mean step of adaptive methods)", .logarithmic = true};
            plot.y = y;
            if (mark_step_)
                plot.rules.push_back(
                    {Rule::Orientation::vertical, mark_step_->value(), fmt::format("{} s", mark_step_->text())});
        }
        figure.shares_axes = true;
    }

    /// The limit of linear theory in the map of panel p.
    void add_limit(std::size_t p, Plot& plot) const {
        std::vector<Preset> pairs;
        std::vector<double> y;
        for (std::size_t row = 0; row < y_.count; ++row) {
            pairs.push_back(pair_at({p, row, 0}));
            y.push_back(static_cast<double>(y_.value(row)));
        }
        draw_linear_limit(pairs, y, plot);
    }

    HeatMap heat_map(std::span<const TrialNumbers> numbers, std::size_t group) const {
        HeatMap map = look_;
        const auto axis = groups_[group].x.plot_axis();
        map.columns = groups_[group].x.count;
        map.x_low = *axis.low;
        map.x_high = *axis.high;
        map.values.reserve(map.columns * map.rows);
        for (std::size_t row = 0; row < map.rows; ++row)
            for (std::size_t column = 0; column < map.columns; ++column) {
                const double number = at(numbers, {group, row, column})[0];
                const double shown = words().range && number < words().range->low ? words().range->low : number;
                map.values.push_back(static_cast<float>(std::isfinite(shown) ? shown : NAN));
            }
        return map;
    }

    /// What all panels have in common: one scale of colours, and words for cells without a number; then the captions.
    void finish_maps(std::span<const TrialNumbers> numbers, Figure& figure) const {
        HeatMap all = look_;
        for (const auto& plot : figure.panels)
            all.values.insert(all.values.end(), plot.map->values.begin(), plot.map->values.end());
        if (std::none_of(all.values.begin(), all.values.end(), [](float cell) { return std::isnan(cell); }))
            all.none_label = "";
        const auto spec = measurements().front().flips_in_lanes();
        long broken = 0;  // flips; where there is none the number is infinite
        if (spec) for_each_cell([&](const Cell& cell) { broken += std::isnan(at(numbers, cell)[0]); });
        if (broken > 0) all.none_label += ", or failed";
        const auto scale = color_range(all);
        for (auto& plot : figure.panels) {
            plot.map->none_label = all.none_label;
            if (figure.panels.size() > 1) plot.map->low = scale[0], plot.map->high = scale[1];
        }
        const auto& plot = figure.panels.front();
        const bool has_outline = overlay_ == Overlay::energy_bound && shows(plot, plot.curves.front());
        if (spec)
            figure.captions.push_back(fmt::format(
                "{} × {} releases{}.{} Taylor series of order 16 in SIMD lanes at tolerance {}.", x_.count, y_.count,
                is_zero(pair_.a.omega_deg_per_s) ? " from rest" : "",
                has_outline ? " Inside the line no rod has the energy to flip." : "", scientific(spec->tolerance)));
        if (broken > 0)
            figure.captions.push_back(
                fmt::format("{} of the releases failed (no step of 10⁻⁹ s met the tolerance): their cells are empty, "
                            "as are those without a flip.",
                            broken));
        if (quantity_ != Quantity::stability) return;
        // as many columns as leave methods of either sort rows of their own
        constexpr std::size_t many = 6, few = 3;
        const auto stepped = std::count_if(groups_.begin(), groups_.end(), [](const Group& group) {
            return group.x.is_setting() && !find_method(group.pair.a.integrator)->adaptive;
        });
        if (groups_.size() > many) figure.columns = stepped % few == 0 ? few : few + 1;
        figure.captions.push_back(
            fmt::format("{}A run has failed if its error exceeds {:g} times the energy released, if it is NaN, or if "
                        "gauss or rattle do not converge.",
                        overlay_ == Overlay::linear_limit
                            ? fmt::format("Dashed: the linear stability limit, where small oscillations gain {:g} "
                                          "times their energy in {} s; Gauss collocation has none. ",
                                          blow_up, seconds_text(pair_))
                            : "",
                        blow_up));
    }

    Preset pair_;
    GridAxis x_, y_, color_, panel_;
    Quantity quantity_ = Quantity::divergence;
    std::optional<std::string> right_;
    Quad difference_ = 0;
    QuantityOptions options_;
    Overlay overlay_ = Overlay::none;
    std::optional<Rational> mark_step_;
    std::optional<Range> color_range_;
    std::vector<Group> groups_;                 // panel by panel, of each its colours
    std::size_t cell_numbers_ = 0, piece_ = 1;  // of a cell; cells of a trial
    HeatMap look_;                              // of maps: all but the numbers
    bool is_mirrored_ = false;                  // the cell at (−x, −y) has the same numbers
    std::string subtitle_;
};

}  // namespace

const FigureKind grid_kind = kind_of<Grid>("grid", FigureKind::System::pair);

}  // namespace doppel
