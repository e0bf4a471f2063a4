#pragma once

#include "figure/kinds.hpp"
#include "scene/numeric_key.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// The spacing of a parameter's values: equal differences, or equal ratios.
enum class Spacing { linear, logarithmic };
template <>
inline constexpr auto names_of<Spacing> = std::to_array<std::string_view>({"linear", "logarithmic"});

/// An axis of a grid: [grid.x], [grid.y], [grid.color] or [grid.panel]. Without a key the axis does not exist; its
/// single value changes nothing.
struct GridAxis {
    static constexpr std::string_view key_help =
        "key that is varied: a key (system.gravity_m_per_s2, b.mass_kg[1], system.force.NAME.stiffness_N_per_m), or "
        "theta1_deg, theta2_deg, mass_ratio, length_ratio, links; or setting: the step, or the tolerance of an "
        "adaptive method";
    GridAxis(std::string_view of_role, std::string_view of_help, std::string_view of_key = "")
        : role(of_role), help(of_help), key(of_key) {}

    std::string_view role, help;       // the name of its table, and what the key of it does
    std::string key;                   // varied along this axis
    std::optional<TomlValues> values;  // listed values; otherwise a range, as follows
    std::vector<std::string> labels;   // for the values, in their order
    Quad from = 0, to = 180, step = 1;
    Quad tolerance_from = parse_quad("1e-13"), tolerance_to = 1;  // for key "setting" and adaptive methods
    std::optional<int> tolerance_points;
    Spacing spacing = Spacing::linear;
    std::optional<int> points;

    // derived from the keys above
    std::size_t count = 1;
    std::string label;                 // of the chart's axis, including the unit
    bool are_cells = false;            // each value is the centre of a cell of a map
    bool is_of_method = false;         // a step size, a tolerance or an accuracy
    bool keeps_method = true;          // all values have the same method and number of links
    bool is_of_one_side = true;        // the sides of a pair cannot differ in it
    std::optional<std::size_t> angle;  // if the key is a release angle: its link, from 0
    std::vector<TomlDocument> levels;  // for textual values: the tables that each puts on top of the preset

    bool exists() const { return !key.empty(); }
    /// The accuracy setting of the method: its step size, or the tolerance of an adaptive method.
    bool is_setting() const { return key == "setting"; }
    /// Whether the key takes whole numbers only, as `links` does.
    bool is_whole() const { return number_ && number_->is_whole; }
    /// Values of lower rank are set first: numbers of links, keys of both sides, and those of one side or ratios.
    int rank() const;
    void fields(KeyVisitor& visit);

    /// `table` = that of the axis. Throws Error (exit 2) if the pair has no such key, or cannot take a value.
    void find(FigureReader& reader, const TomlReader& table, const Preset& pair);

    /// For key "setting": step sizes that divide the pair's duration, or tolerances within its precision.
    void settle(const Preset& pair);

    const Quad& value(std::size_t i) const { return numbers_[i]; }
    /// Calls add(name, value) for each column of value i; NaN for an empty cell.
    template <class Add>
    void visit(std::size_t i, const Add& add) const {
        if (is_setting()) {
            const auto number = static_cast<double>(value(i));
            add("step_s", is_adaptive_ ? NAN : number);
            add("tolerance", is_adaptive_ ? number : NAN);
        } else if (!levels.empty()) {
            const bool is_method = key == "system.integrator", is_precision = key == "system.precision";
            add(is_method ? "method" : is_precision ? "precision" : std::string_view(key), std::string_view(words(i)));
        } else if (exists()) {
            add(key, static_cast<double>(value(i)));
        }
    }
    /// "θ₁ = 30°", "rk4"
    std::string words(std::size_t i) const;
    /// Sets value i; side b gets `difference` more. Nothing happens for textual values.
    void put(Preset& pair, std::size_t i, const Quad& difference = 0) const;
    /// The same for both sides, whichever the key belongs to.
    void put_both(Preset& pair) const;
    PlotAxis plot_axis() const;
    /// The text for a pair with this difference: "pair 0.003° apart"; empty for 0.
    std::string difference_words(const Quad& difference) const;
    /// Throws Error (exit 2) at the table's key `of` if a pair has no such key.
    void require_in(const TomlReader& table, std::string_view of, const Preset& pair) const;
    /// The same if the number is out of range.
    void require(const TomlReader& table, std::string_view of, const Quad& number) const;

private:
    void find_texts(FigureReader& reader, const TomlReader& table);
    void find_number(FigureReader& reader, const TomlReader& table, const Preset& pair);
    void find_values(const TomlReader& table, const Preset& pair);
    void find_even_values(const TomlReader& table);
    void find_settings(const TomlReader& table, const Preset& pair);
    Quad even_value(std::size_t i) const;
    /// Of a map: whether its values are the centres of its cells. Otherwise `from` and `to` are its edges.
    bool are_centers() const { return values || is_whole(); }
    /// Throws Error (exit 2) at the table's key `of` unless the values of a map increase by equal steps or ratios.
    void find_spacing(const TomlReader& table, std::string_view of);
    double middle_of_cell(std::size_t i) const;
    std::size_t even_steps(const TomlReader& table) const;

    /// A release parameter that curves and maps can vary.
    struct ReleaseParameter {
        std::string_view name, label;
        std::size_t links;  // least number of links
        void (*set)(SideSpec&, const Quad&);
        bool is_ratio;  // > 0
    };
    static const std::array<ReleaseParameter, 4> releases;
    const ReleaseParameter* release_ = nullptr;
    std::optional<NumericKey> number_;
    std::vector<Quad> numbers_;  // all values, if they are numbers
    Bounds bounds_;
    bool is_adaptive_ = false;                          // for key "setting"
    std::vector<std::pair<Rational, Rational>> steps_;  // for key "setting": samples per second, and the step size, s
};

}  // namespace doppel
