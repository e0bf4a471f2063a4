#pragma once

#include "integrate/motion.hpp"

#include <string>
#include <vector>

namespace doppel {

/// A model and a method at a setting that gave an accuracy, and what that cost: read off the table that
/// `doppel figure speed-accuracy` measured (src/scene/costs.csv, made anew by tests/update-costs).
struct MeasuredWay {
    Model model;
    std::string method;
    double setting;  // tolerance, or step in units of `time_unit`
    double cost;     // CPU s a `time_unit` of motion, on the machine of the table
};

/// Every model and method that reached `accuracy` (rad) on the released pendulums of the table most like a system of
/// `links`, cheapest first.
std::vector<MeasuredWay> measured_ways(std::size_t links, double accuracy);

}  // namespace doppel
