#include "figure/grid.hpp"

#include "integrate/flips.hpp"
#include "scene/method_choice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace doppel {
namespace {

bool is_half_turns(const Quad& angle_deg) {
    return angle_deg == round(angle_deg / 180) * 180;
}

}  // namespace

void Grid::fields(KeyVisitor& visit) {
    visit({"quantity", "what is computed for each pair; docs/figures.md explains each"}, quantity_);
    visit({.key = "right", .help = "a second quantity of curves, on an axis at the right", .names = names_of<Quantity>},
          right_);
    visit({"difference", "difference between the two pendulums of a pair in the key of x"}, difference_);
    const auto has = [&](Quantity quantity) { return quantity_ == quantity || right_ == name_of(quantity); };
    const bool is_changed = visit.from_command_line("quantity") || visit.from_command_line("right");
    const Condition of_exponents{has(Quantity::exponent), "is only for exponent", is_changed},
        of_flips{has(Quantity::flip_time), "is only for flip_time"},
        strobed{quantity_ == Quantity::stroboscopic, "is only for stroboscopic", is_changed},
        of_convergence{quantity_ == Quantity::convergence, "is only for convergence", is_changed};
    visit({"exponent_duration_s", "duration of the motion from which an exponent is computed", "s", positive, "",
           of_exponents},
          options_.exponent_duration_s);
    visit({"flip_tolerance", "tolerance of the Taylor series for flips of two links: size of the last terms of a step",
           "rad/s", from_to(1e-15, 1), "1e-8 up to 20 s, for longer times less", of_flips},
          options_.flip_tolerance);
    auto& strobe = options_.stroboscope;
    visit({"link", "link whose rate is shown", "", from_to(1, 10'000), "", strobed}, strobe.link);
    visit({"transient_periods", "length of the transient, drive periods", "", from_to(0, 1'000'000), "", strobed},
          strobe.transient_periods);
    visit({"periods", "number of drive periods shown", "", from_to(1, 100'000), "", strobed}, strobe.periods);
    visit({"overlay",
           "theoretical curves on a map: where a vibrating pivot stabilises one link upright, where two links "
           "released at rest have the energy to flip, or the linear stability limit of a method"},
          overlay_);
    visit({"mark_step_s", "a step marked by a line", "s", positive, "", of_convergence}, mark_step_);
    const Condition of_this{!visit.from_command_line("quantity") || visit.from_command_line("range"),
                            "belongs to the preset's quantity", true};
    visit({.key = "range",
           .help = "of the quantity: its axis, or the colours of a map; [lowest, highest]",
           .absent = "that of the numbers",
           .only = of_this},
          range_);
    visit({"threshold", "of a map: two colours, up to it and above it", "", {}, "colours for all numbers"}, threshold_);
    for (auto* axis : {&x_, &y_, &color_, &panel_})
        visit.table(axis->role, [&](KeyVisitor& table) { axis->fields(table); });
}

Grid::Grid(FigureReader& reader) : Grid() {
    pair_ = reader.pair();
    auto table = reader.settings(*this);
    if (reader.only_keys) return;
    settings_ = resolved_pair(pair_) + settings_text(*this);
    x_.are_cells = y_.are_cells = is_map();
    for (auto* axis : {&x_, &y_, &color_, &panel_}) axis->find(reader, table.inner(axis->role), pair_);
    check(table);
    for (std::size_t p = 0; p < panel_.count; ++p)
        for (std::size_t c = 0; c < color_.count; ++c) add_group(reader, table, p, c);
    const bool has_b = is_of_distance(quantity_) || (right_ && is_of_distance(value_named<Quantity>(*right_)));
    for (const auto* axis : {&x_, &y_, &color_, &panel_})
        if (!has_b && axis->key.starts_with("b."))
            throw table.inner(axis->role)
                .error("key", "\"{}\" has no effect on \"{}\", which is of side a", axis->key, name_of(quantity_));
    for (const auto& measurement : measurements()) cell_numbers_ += measurement.numbers();
    bool is_any_drawn = is_map();
    if (!is_map()) for_each_cell([&](const Cell& cell) { is_any_drawn = is_any_drawn || !leaves_out(cell); });
    if (!is_any_drawn)
        throw table.error(
            "quantity",
            "\"{}\" needs motion, but all pairs rest in equilibrium; release them at other angles, or with rates",
            name_of(quantity_));
    if (range_ && words().logarithmic && !(range_->low > 0))
        throw table.error("range", "must be > 0 on the logarithmic scale of \"{}\"; it is [{}, {}]", name_of(quantity_),
                          range_->low, range_->high);
    const bool is_shared = difference_ == x_.step && !x_.points && !x_.values;
    piece_ = measurements().front().together(is_shared);
    if (is_map()) make_map();
    std::size_t first = 0;
    for (auto& group : groups_) group.first = std::exchange(first, first + trials_of(group));
    make_subtitle();
    visit_columns({0, 0, 0}, 0, TrialNumbers(cell_numbers_),
                  [&](std::string_view name, const auto&) { columns_.emplace_back(name); });
    unit_ = "pairs";
}

/// Checks the axes together with the other keys.
void Grid::check(const TomlReader& table) const {
    std::vector<std::string_view> names;
    for (const auto* axis : {&x_, &y_, &color_, &panel_}) {
        if (axis->exists() && std::ranges::find(names, axis->key) != names.end())
            throw table.error("x", "and the other axes must have different keys; \"{}\" is there twice", axis->key);
        names.push_back(axis->key);
    }
    for (const auto* axis : {&x_, &y_, &color_, &panel_}) {
        const bool is_curves = axis == &color_ || axis == &panel_;
        if (!axis->levels.empty() && !is_curves)
            throw table.error(
                axis->role, "takes numbers, which these are not; \"{}\" by its texts is for panel or color", axis->key);
        if (axis->is_setting() && axis != &x_)
            throw table.error(axis->role, "cannot be \"setting\", which is only for x");
    }
    if (x_.is_of_one_side && difference_ != 0)
        throw table.error("difference", "must be 0 for {}, in which the sides do not differ", x_.key);
    for (const auto& end : {x_.value(0), x_.value(x_.count - 1)})
        x_.require(table, "difference", Quad(end + difference_));
    const auto& a = pair_.a;
    const bool is_shaken = x_.key == "system.pivot.frequency_hz" && y_.key == "system.pivot.amplitude_m" &&
                           a.particles.empty() && !a.is_mechanism() && a.links() == 1 && a.physical.torques.empty() &&
                           physical_of(a).friction.is_none() && is_half_turns(a.physical.pivot.direction_deg - 90);
    const bool is_of_rest = is_of_releases() && is_zero(a.omega_deg_per_s);
    const bool is_of_steps = is_map() && quantity_ == Quantity::stability && x_.is_setting();
    struct Fault {
        bool is_there;
        std::string_view key;
        std::string words;
    };
    for (const auto& fault : {
             Fault{is_map() && color_.exists(), "color", "is only for curves; in a map the colours show the quantity"},
             {is_map() && right_, "right", "is only for curves; a map shows one quantity"},
             {right_ == name_of(quantity_) || right_ == name_of(Quantity::stroboscopic), "right",
              fmt::format("must be another quantity with one number per pair; it is \"{}\"", right_.value_or(""))},
             {quantity_ == Quantity::convergence && (!x_.is_setting() || is_map() || right_), "quantity",
              "\"convergence\" takes [grid.x] key = \"setting\", and no [grid.y] or right"},
             {quantity_ == Quantity::stroboscopic && (is_map() || right_), "quantity",
              "\"stroboscopic\" has many numbers per pair, which are drawn as points over x; leave the other axes out"},
             {compares_methods() && (quantity_ == Quantity::exponent || right_ == name_of(Quantity::exponent)),
              quantity_ == Quantity::exponent ? "quantity" : "right",
              "\"exponent\" is computed by a method of its own; an axis of methods changes nothing"},
             {!is_map() && threshold_, "threshold", "is only for maps, which have [grid.y]"},
             {overlay_ == Overlay::energy_bound && !is_of_rest, "overlay",
              "\"energy-bound\" is for two ideal links released at rest, theta2_deg over theta1_deg"},
             {(overlay_ == Overlay::kapitza || overlay_ == Overlay::mathieu) && !is_shaken, "overlay",
              "is for one link without friction and torque whose pivot moves up and down, over "
              "system.pivot.frequency_hz and system.pivot.amplitude_m"},
             {overlay_ == Overlay::linear_limit && !is_of_steps, "overlay",
              "\"linear-limit\" is for a map of stability over the setting"},
         })
        if (fault.is_there) throw table.error(fault.key, "{}", fault.words);
}

void Grid::add_group(FigureReader& reader, const TomlReader& table, std::size_t p, std::size_t c) {
    std::vector<TomlReader> levels;
    for (const auto& [axis, i] : {std::pair(&panel_, p), {&color_, c}})
        if (!axis->levels.empty()) levels.push_back(axis->levels[i].top());
    std::vector<TomlReader*> more;
    for (auto& level : levels) more.push_back(&level);
    auto& group = groups_.emplace_back(Group{levels.empty() ? pair_ : reader.pair(more), x_, 0, {}});
    panel_.require_in(table, panel_.role, group.pair);
    panel_.put(group.pair, p);
    color_.require_in(table, color_.role, group.pair);
    color_.put(group.pair, c);
    group.x.settle(group.pair);
    for (const auto& [axis, other] : {std::pair(&x_, &y_), {&y_, &x_}}) {
        auto fewest = group.pair;
        if (other->is_whole()) other->put(fewest, 0);
        axis->require_in(table, axis->role, fewest);
    }
    const auto number = groups_.size() - 1;
    if (!x_.is_of_method && !y_.is_of_method) use_common_method(group.pair, pair_at({number, 0, 0}), reader.stop);
    const std::array ends{pair_at({number, 0, 0}), pair_at({number, y_.count - 1, group.x.count - 1})};
    InCommon all{.have_same_method = x_.keeps_method && y_.keeps_method,
                 .are_compared_by_method = compares_methods(),
                 .difference = difference_,
                 .is_of_one_side = x_.is_of_one_side};
    const auto include = [&](const Cell& cell) {  // a friction may be 0 in some of them
        const auto pair = pair_at(cell);
        all.are_ideal = all.are_ideal && pair.a.physical.is_none() && pair.b.physical.is_none();
        all.have_same_links = all.have_same_links && pair.a.links() == ends[0].a.links();
    };
    for (std::size_t i = 0; i < (group.x.angle ? 1 : group.x.count); ++i) include({number, 0, i});
    for (std::size_t i = 0; i < (y_.angle ? 1 : y_.count); ++i) include({number, i, 0});
    group.measurements.emplace_back(table, "quantity", quantity_, ends, all, options_);
    if (right_) group.measurements.emplace_back(table, "right", value_named<Quantity>(*right_), ends, all, options_);
    const auto spec = group.measurements.front().flips_in_lanes();
    if (options_.flip_tolerance && !spec)
        throw table.error("flip_tolerance", "is for flips of two ideal links; other flips use the integrator");
}

void Grid::make_map() {
    map_ = MapCells{static_cast<int>(groups_[0].x.count), static_cast<int>(y_.count), groups_.size(), cell_numbers_};
    map_style_ = {.rows = y_.count,
                  .label = words().label,
                  .none_label = words().none,
                  .none_is_bad = words().none_is_bad,
                  .logarithmic = words().logarithmic,
                  .threshold = threshold_,
                  .shares_bar = panel_.exists()};
    if (const auto& range = words().range) map_style_.low = range->low, map_style_.high = range->high;
    if (quantity_ == Quantity::flip_time) map_style_.high = pair_.duration_s.value();
    const auto is_even = [](const GridAxis& axis) { return axis.spacing == Spacing::linear && axis.from == -axis.to; };
    is_mirrored_ = measurements().front().flips_in_lanes() && is_of_releases() && is_even(x_) && is_even(y_) &&
                   is_zero(pair_.a.omega_deg_per_s);
    are_columns_ = x_.is_setting();
    constexpr std::size_t max_in_line = 256;  // trials
    const auto cells = line_cells(groups_.front());
    piece_ = std::max(piece_, (cells + max_in_line - 1) / max_in_line);
    if (range_) map_style_.low = range_->low, map_style_.high = range_->high;
}

/// The subtitle: system, integrator, and difference of the two pendulums, as far as all pairs share them.
void Grid::make_subtitle() {
    auto swept = swept_keys();
    swept.method = words().method;
    auto pair = groups_.front().pair;
    if (!is_of_distance(quantity_)) pair.b = pair.a;
    for (const auto* axis : {&x_, &y_, &color_, &panel_}) axis->put_both(pair);  // the difference is stated separately
    subtitle_ =
        pair_subtitle(make_scene(pair), swept, is_of_distance(quantity_) ? x_.difference_words(difference_) : "");
}

SweptKeys Grid::swept_keys() const {
    SweptKeys swept;
    for (const auto* axis : {&x_, &y_, &color_, &panel_}) {
        if (axis->angle) swept.angles.push_back(*axis->angle);
        swept.step |= axis->is_of_method;
        swept.keys.push_back(axis->key);
        for (const std::string key :
             {"model", "integrator", "step_s", "tolerance", "accuracy", "precision", "angle_deg"})
            for (const auto& level : axis->levels)
                if (axis->key == "system" && level.top().inner("a").has(key)) swept.keys.push_back("." + key);
    }
    return swept;
}

bool Grid::compares_methods() const {
    constexpr std::array<std::string_view, 6> names{".model",     ".integrator", ".step_s",
                                                    ".tolerance", ".accuracy",   ".precision"};
    const auto swept = swept_keys();
    return swept.step || std::ranges::any_of(swept.keys, [&](const std::string& key) {
               return std::ranges::any_of(names, [&](std::string_view name) { return key.ends_with(name); });
           });
}

double Grid::units(std::size_t trial) const {
    const auto row = place_of(trial).row;
    return static_cast<double>(cells_of(trial) * (is_mirrored_ && row != y_.count - 1 - row ? 2 : 1));
}

std::optional<Experiment::Releases> Grid::releases() const {
    constexpr std::size_t most_links = 3;
    if (pair_.a.is_mechanism() || !pair_.a.physical.is_none() || pair_.a.links() > most_links) return std::nullopt;
    if (groups_.size() > 1) return std::nullopt;  // the page has one system
    Releases releases{{}, pair_at({0, 0, 0})};
    for (const auto* axis : {&x_, &y_}) {
        if (!axis->exists()) continue;
        if (!axis->angle || axis->key.starts_with("a.") || axis->key.starts_with("b.")) return std::nullopt;
        releases.keys.push_back(axis->key.starts_with("theta") ? fmt::format("system.angle_deg[{}]", *axis->angle)
                                                               : axis->key);
    }
    return releases;
}

TrialNumbers Grid::compute(std::size_t trial, const std::atomic<bool>& stop) const {
    const auto first = place_of(trial);
    const auto& group = groups_[first.group];
    auto pair = group.pair;
    const auto pair_of = [&](std::size_t i) -> const Preset& {
        pair.a = group.pair.a;
        if (right_ || is_of_distance(quantity_)) pair.b = group.pair.b;  // otherwise side b is not used
        put({first.group, first.row + (are_columns_ ? i : 0), first.column + (are_columns_ ? 0 : i)}, pair);
        return pair;
    };
    std::vector<TrialNumbers> cells(cells_of(trial));
    for (const auto& measurement : group.measurements) measurement.append(pair_of, cells, stop);
    TrialNumbers numbers;
    for (const auto& cell : cells) numbers.insert(numbers.end(), cell.begin(), cell.end());
    return numbers;
}

bool Grid::fits(std::size_t trial, std::span<const double> numbers) const {
    if (numbers.size() != cell_numbers_ * cells_of(trial)) return false;
    while (!numbers.empty())
        for (const auto& measurement : measurements()) {
            if (!measurement.fits(numbers.first(measurement.numbers()))) return false;
            numbers = numbers.subspan(measurement.numbers());
        }
    return true;
}

/// Calls add(name, value) for each column of a row of a cell with these numbers.
template <class Add>
void Grid::visit_columns(const Cell& cell, std::size_t row, std::span<const double> numbers, const Add& add) const {
    color_.visit(cell.group % color_.count, add);
    panel_.visit(cell.group / color_.count, add);
    if (words().drawn == 0) groups_[cell.group].x.visit(cell.column, add);
    y_.visit(cell.row, add);
    if (quantity_ == Quantity::stroboscopic)
        add("period", options_.stroboscope.transient_periods + 1 + static_cast<long>(row));
    std::vector<std::pair<std::string_view, double>> last;
    for (const auto& measurement : measurements()) {
        const auto& [columns, last_column] = std::tie(measurement.words().columns, measurement.words().last_column);
        for (std::size_t i = 0; i < columns.size(); ++i) add(columns[i], numbers[row * columns.size() + i]);
        if (!last_column.empty()) last.emplace_back(last_column, numbers[columns.size()]);
        numbers = numbers.subspan(measurement.numbers());
    }
    for (const auto& [name, number] : last) add(name, number);
}

void Grid::write_rows(std::span<const TrialNumbers> numbers, Csv& table) const {
    for_each_cell([&](const Cell& cell) {
        for (std::size_t row = 0; row < words().rows; ++row) {
            visit_columns(cell, row, at(numbers, cell), [&](std::string_view, const auto& value) {
                if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
                    table.add_or_empty(std::isfinite(value) ? value : NAN);
                else
                    table.add(value);
            });
            table.end_row();
        }
    });
}

std::optional<std::string> Grid::nothing_to_draw(std::span<const TrialNumbers> numbers) const {
    bool is_any = false, is_any_above_0 = false, is_any_at_right = false;
    for_each_cell([&](const Cell& cell) {
        const double number = leaves_out(cell) ? NAN : value_at(numbers, cell);
        is_any |= std::isfinite(number);
        is_any_above_0 |= std::isfinite(number) && number > 0;
        is_any_at_right |= right_ && std::isfinite(at(numbers, cell)[measurements().front().numbers()]);
    });
    if (is_any_at_right || (words().logarithmic ? is_any_above_0 : is_any)) return std::nullopt;
    if (quantity_ == Quantity::stroboscopic) return "the run failed at every value";
    const auto pairs = fmt::format("{}{}{}", groups_.size() > 1 ? fmt::format("{} × ", groups_.size()) : "", x_.count,
                                   is_map() ? fmt::format(" × {}", y_.count) : "");
    const bool has_vowel = quantity_ == Quantity::exponent || quantity_ == Quantity::energy_error;
    const auto name = fmt::format("{} {}", has_vowel ? "an" : "a", name_of(quantity_));
    if (is_any) return fmt::format("none of the {} pairs has {} above 0, which a logarithmic scale needs", pairs, name);
    if (words().none_is_bad)
        return fmt::format(
            "all of the {} pairs failed within {} s; use a smaller step or tolerance, or a shorter scene.duration_s",
            pairs, seconds_text(pair_));
    return fmt::format("none of the {} pairs has {}: {}{}", pairs, name, words().none,
                       quantity_ == Quantity::parting_time
                           ? ", or never apart for a second without a break, or apart from the start"
                           : "");
}

bool Grid::is_of_releases() const {
    return x_.key == "theta1_deg" && y_.key == "theta2_deg" && !pair_.a.is_mechanism() && pair_.a.physical.is_none() &&
           pair_.a.links() == 2;
}

Preset Grid::pair_at(const Cell& cell) const {
    auto pair = groups_[cell.group].pair;
    put(cell, pair);
    return pair;
}

/// In an order for which neither changes what the other has set: numbers of links, which make equal links; keys of both
/// sides; those of one side, and ratios, which depend on others.
void Grid::put(const Cell& cell, Preset& pair) const {
    const auto& x = groups_[cell.group].x;
    const bool is_x_first = x.rank() < y_.rank();
    if (is_x_first) x.put(pair, cell.column, difference_);
    y_.put(pair, cell.row);
    if (!is_x_first) x.put(pair, cell.column, difference_);
}

/// The first cell of a trial, and the number of its cells.
Grid::Cell Grid::place_of(std::size_t trial) const {
    const auto next = std::ranges::find_if(groups_, [&](const Group& g) { return g.first > trial; });
    const auto& group = *std::prev(next);
    const auto number = static_cast<std::size_t>(&group - groups_.data()), trials = trials_of_line(group);
    const auto line = (trial - group.first) / trials, along = (trial - group.first) % trials * piece_;
    return are_columns_ ? Cell{number, along, line} : Cell{number, line, along};
}

std::size_t Grid::cells_of(std::size_t trial) const {
    const auto place = place_of(trial);
    return std::min(piece_, line_cells(groups_[place.group]) - (are_columns_ ? place.row : place.column));
}

std::span<const double> Grid::at(std::span<const TrialNumbers> numbers, const Cell& cell) const {
    const auto& group = groups_[cell.group];
    auto line = cell.row, along = cell.column;
    if (are_columns_) std::swap(line, along);
    if (line >= lines_computed(group)) line = y_.count - 1 - line, along = group.x.count - 1 - along;
    const auto trial = group.first + line * trials_of_line(group) + along / piece_;
    return std::span(numbers[trial]).subspan(along % piece_ * cell_numbers_, cell_numbers_);
}

std::size_t Grid::lines_computed(const Group& group) const {
    if (are_columns_) return group.x.count;
    return is_mirrored_ ? (y_.count + 1) / 2 : y_.count;
}

bool Grid::leaves_out(const Cell& cell) const {
    if (is_map() || !is_of_distance(quantity_)) return false;
    const auto pair = pair_at(cell);
    const auto rests = [](const SideSpec& side) {
        return side.particles.empty() && !side.is_mechanism() && side.physical.is_none() &&
               is_zero(side.omega_deg_per_s) && std::ranges::all_of(side.angle_deg, is_half_turns);
    };
    return rests(pair.a) && rests(pair.b);
}

/// An identical pair has no ratio to its initial distance; in a curve, that is not counted as missing.
bool Grid::is_missing(const Cell& cell, Quantity quantity, double number) const {
    if (std::isfinite(number) || is_map() || quantity != Quantity::divergence) return !std::isfinite(number);
    const auto pair = pair_at(cell);
    return !have_same_release(pair.a, pair.b);
}

std::string Grid::joined_words(std::size_t group) const {
    const auto panel = panel_.exists() ? panel_.words(group / color_.count) : "";
    if (!color_.exists()) return panel;
    return panel + (panel.empty() ? "" : ", ") + color_.words(group % color_.count);
}

/// The order of convergence: from the two finest step sizes, or from the middle third of the tolerances.
double Grid::slope(std::span<const TrialNumbers> numbers, std::size_t group) const {
    const auto count = groups_[group].x.count;
    const bool is_adaptive = find_method(groups_[group].pair.a.integrator)->adaptive;
    const auto coarse = at(numbers, {group, 0, is_adaptive ? count / 3 : count - 2});
    const auto fine = at(numbers, {group, 0, is_adaptive ? 2 * count / 3 : count - 1});
    return std::log(coarse[1] / fine[1]) / std::log(coarse[0] / fine[0]);
}

const FigureKind grid_kind = kind_of<Grid>("grid");

}  // namespace doppel
