#pragma once

#include "analysis/spectrum.hpp"
#include "figure/kinds.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// The quantities of a series: the distance of pairs, as such or as ln(d/d0); all exponents of one motion; the errors
/// of one motion by each method.
enum class SeriesQuantity { distance, log_ratio, exponents, errors };
template <>
inline constexpr auto names_of<SeriesQuantity> = std::to_array<std::string_view>({"distance", "log_ratio", "exponents",
                                                                                  "errors"});

struct SeriesKeys {
    static constexpr std::string_view table_key = "series";
    SeriesQuantity quantity = SeriesQuantity::distance;
    bool logarithmic = false;
    std::optional<std::string> film_column;
    std::optional<Quad> check_tolerance;
    double duration_s = 500;
    int samples = 500, points_per_decade = 10;
    double tolerance = SpectrumSpec{}.tolerance, evaluations_per_s = 500;
    std::vector<std::string> methods{names_of_methods().begin(), names_of_methods().end()}, projected;

    bool is_of_pairs() const { return quantity <= SeriesQuantity::log_ratio; }

    void fields(KeyVisitor& visit);
};

/// For the errors of one motion by each method. `table` has read [series].
std::shared_ptr<const Experiment> make_drift(FigureReader& reader, const TomlReader& table, SeriesKeys& keys);

}  // namespace doppel
