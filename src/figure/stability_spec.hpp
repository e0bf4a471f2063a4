#pragma once

#include "figure/kinds.hpp"
#include "figure/stability_runs.hpp"
#include "integrate/methods.hpp"

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace doppel {

/// What maps of stability go over upwards: its name, how people call it, and what it changes in a release.
struct StabilityParameter {
    std::string_view name, label;
    void (*set)(SideSpec&, const Quad&);
    double from, to, most;  // where nothing is given, and what there is
    bool logarithmic;
    double every;  // between ticks; 0 = as fits
};

/// Cells from `from` to `to`, evenly or in even ratios.
struct Cells {
    double from, to;
    int count;
    bool logarithmic;

    double middle(int cell) const {
        const double part = (cell + 0.5) / count;
        return logarithmic ? from * std::pow(to / from, part) : from + part * (to - from);
    }
};

/// Maps of stability as a preset describes them: complete and checked.
struct StabilitySpec {
    SideSpec release;
    const StabilityParameter* parameter = nullptr;
    std::vector<const MethodEntry*> methods;
    std::string model = "auto";  // angles where a method serves them
    Rational duration{10, 1};    // s
    Cells rows{};
    Cells steps{0.002, 1, 100, true}, tolerances{1e-13, 1, 100, true};  // s; as many columns of either
    std::vector<Pendulum<Quad>> releases;                               // of each row

    const Cells& columns_of(const MethodEntry& method) const { return method.adaptive ? tolerances : steps; }
    Model model_of(const MethodEntry& method) const;
    /// Whether there is a method that goes by a tolerance, or one that does not.
    bool has(bool adaptive) const;
    /// How `method` steps all releases in a column of its map.
    StabilityRun run(const MethodEntry& method, int column) const;
    std::string resolved() const;
};

/// [system] and [stability]. Throws Error (exit 2) as TomlReader does.
StabilitySpec read_stability_spec(FigureReader& reader);

}  // namespace doppel
