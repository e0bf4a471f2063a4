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
    SeriesKeys();

    SeriesQuantity quantity = SeriesQuantity::distance;
    bool logarithmic = false;
    std::optional<std::string> film_column;
    std::optional<Quad> check_tolerance;
    double duration_s = 500;
    int samples = 500, points_per_decade = 10;
    double tolerance = SpectrumSpec{}.tolerance, evaluations_per_s = 500;
    std::vector<std::string> methods, projected;

    bool is_of_pairs() const { return quantity <= SeriesQuantity::log_ratio; }

    template <class Visit>
    void fields(Visit& visit) {
        visit({"quantity",
               "the distance of pairs in state space, or ln(d/d₀); all Lyapunov exponents of one motion, as their "
               "estimates settle; or the errors of its energy and rods by each method at the same cost"},
              quantity);

        visit({.key = "film_column",
               .help = "in place of `quantity`: a column of the table that a film of the pair has",
               .only = {is_of_pairs(), "is only for pairs"},
               .is_drawn = true},
              film_column);
        const Condition of_pairs{is_of_pairs(), "is only for pairs"};
        const Condition of_exponents{quantity == SeriesQuantity::exponents, "is only for exponents"};
        const Condition of_errors{quantity == SeriesQuantity::errors, "is only for errors"};
        const Bounds of_motions = of_errors.applies ? Bounds{.low = 10, .high = 1e8, .is_positive = true} : positive;
        constexpr Bounds tolerances{.low = 1e-14, .high = 1e-2, .is_positive = true},
            costs{.low = 10, .high = 1e6, .is_positive = true};
        visit({"logarithmic", "the axis", "", {}, "", of_pairs}, logarithmic);
        visit({"check_tolerance", "runs every pair again at this tolerance, to see how long both agree", "", positive,
               "", of_pairs},
              check_tolerance);
        visit({"duration_s", "of the motion", "s", of_motions, "",
               Condition{!is_of_pairs(), "is for one motion; pairs use that of [scene]"}},
              duration_s);
        visit({"samples", "of the exponents, equally spaced, the last at the end", "", from_to(2, 100'000), "",
               of_exponents},
              samples);
        visit({"tolerance", "relative error of a step of dop853, of the motion and of its tangents", "", tolerances, "",
               of_exponents},
              tolerance);
        visit({"points_per_decade", "of the curves, from 1 s on", "", from_to(1, 100), "", of_errors},
              points_per_decade);
        visit({"evaluations_per_s", "evaluations of the right-hand side a second of motion, the same for all methods",
               "", costs, "", of_errors},
              evaluations_per_s);
        visit({.key = "methods",
               .help = "names of methods",
               .absent = "all that step chains",
               .only = of_errors,
               .known = names_of_methods()},
              methods);
        visit({.key = "projected",
               .help = "methods that are also shown with projection onto the constraints",
               .only = of_errors,
               .known = names_of_methods()},
              projected);
    }
};

// For one motion. `resolved` = [series] with all its keys.
std::shared_ptr<const Experiment> make_spectrum(FigureReader& reader, const TomlReader& table, const SeriesKeys& keys,
                                                const std::string& resolved);
std::shared_ptr<const Experiment> make_drift(FigureReader& reader, const TomlReader& table, const SeriesKeys& keys,
                                             const std::string& resolved);

}  // namespace doppel
