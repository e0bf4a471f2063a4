#include "scene/cost_table.hpp"

#include "base/error.hpp"
#include "embedded/scene.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace doppel {
namespace {

/// One row: the cheapest setting of a method that came within `error` on one of the table's pendulums.
struct Row {
    std::size_t links;
    std::string problem, model, method;
    double error, setting, cost;  // rad; tolerance, or step in time units; CPU s a time unit
};

std::string_view next_field(std::string_view& line) {
    const auto comma = std::min(line.find(','), line.size());
    const auto field = line.substr(0, comma);
    line.remove_prefix(std::min(comma + 1, line.size()));
    return field;
}

double number(std::string_view field) {
    double value = 0;
    std::from_chars(field.data(), field.data() + field.size(), value);
    return value;
}

std::vector<Row> rows() {
    constexpr std::string_view name = "scene/costs.csv";
    const auto files = scene_files();
    const auto file = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.name == name; });
    if (file == files.end()) throw Error(ExitCode::io_failed, "the table of costs is missing from this program");
    std::vector<Row> all;
    std::string_view text(file->contents);
    for (bool heading = true; !text.empty(); heading = false) {
        auto line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        if (heading || line.empty()) continue;
        Row row{};
        row.problem = next_field(line);
        row.links = static_cast<std::size_t>(number(next_field(line)));
        row.model = next_field(line);
        row.method = next_field(line);
        row.error = number(next_field(line));
        row.setting = number(next_field(line));
        row.cost = number(next_field(line));
        all.push_back(std::move(row));
    }
    return all;
}

Model model_named(const std::string& name) {
    return name == "angles" ? Model::angles : name == "constraints" ? Model::constraints : Model::mechanism;
}

}  // namespace

std::vector<MeasuredWay> measured_ways(std::size_t links, double accuracy) {
    const auto table = rows();
    std::size_t measured_links = table.front().links;  // two for short ones, three for all longer ones
    for (const auto& row : table)
        if (row.links <= std::max<std::size_t>(links, 2)) measured_links = std::max(measured_links, row.links);

    std::map<std::string, int> problems;
    std::map<std::pair<std::string, std::string>, std::map<std::string, Row>> best;
    for (const auto& row : table) {
        if (row.links != measured_links) continue;
        problems[row.problem] = 1;
        if (row.error > accuracy) continue;
        auto& ways = best[{row.model, row.method}];
        const auto [place, fresh] = ways.emplace(row.problem, row);
        if (!fresh && row.cost < place->second.cost) place->second = row;
    }
    std::vector<MeasuredWay> all;
    for (const auto& [names, ways] : best) {
        if (ways.size() < problems.size()) continue;  // not reached on one of them
        MeasuredWay way{model_named(names.first), names.second, ways.begin()->second.setting, 0};
        for (const auto& [problem, row] : ways) {
            way.setting = std::min(way.setting, row.setting);
            way.cost += row.cost / static_cast<double>(ways.size());
        }
        all.push_back(way);
    }
    std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.cost < y.cost; });
    return all;
}

}  // namespace doppel
