#include "bench/kept/performance.hpp"

#include "base/error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

namespace doppel {
namespace {

/// The quantile `part`, from 0 to 1, of sorted numbers, with linear interpolation.
double quantile(const std::vector<double>& sorted, double part) {
    const double at = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const auto above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

template <class Value>
std::vector<double> sorted(const std::vector<Round>& rounds, Value value) {
    std::vector<double> all;
    for (const auto& round : rounds) all.push_back(value(round));
    std::sort(all.begin(), all.end());
    return all;
}

/// Rounds to four digits: more digits are noise, and would change every line in every run.
double rounded(double x) {
    return x == 0 || !std::isfinite(x) ? 0 : std::stod(fmt::format("{:.4g}", x));
}

}  // namespace

Measured summary(const std::vector<Round>& rounds) {
    const auto ns = sorted(rounds, [](const Round& round) { return round.ns; });
    const auto ratios = sorted(rounds, [](const Round& round) { return round.ratio; });
    const double middle = quantile(ns, 0.5);
    return {.ns = middle,
            .spread = (quantile(ns, 0.75) - quantile(ns, 0.25)) / 2 / middle,
            .ratio = quantile(ratios, 0.5),
            .rounds = static_cast<int>(rounds.size()),
            .counters = {}};
}

std::string read_page(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!file) throw io_failed("{} cannot be read", path.string());
    return text;
}

void write_page(const std::filesystem::path& path, const std::string& text) {
    auto part = path;
    part += ".part";
    {
        std::ofstream file(part, std::ios::binary);
        file << text;
        if (!file.flush()) throw io_failed("{} cannot be written", part.string());
    }
    std::filesystem::rename(part, path);
}

Performance read_performance(const std::filesystem::path& path) {
    const auto text = read_page(path);
    try {
        const auto json = nlohmann::json::parse(text);
        Performance all{.machine = json.at("machine"),
                        .system = json.at("system"),
                        .compiler = json.at("compiler"),
                        .date = json.at("date"),
                        .reference_ns = json.at("reference").at("ns"),
                        .reference_spread = json.at("reference").at("spread"),
                        .benchmarks = {}};
        for (const auto& [name, one] : json.at("benchmarks").items())
            all.benchmarks[name] = {.ns = one.at("ns"),
                                    .spread = one.at("spread"),
                                    .ratio = one.at("ratio"),
                                    .rounds = one.at("rounds"),
                                    .counters = one.value("counters", std::map<std::string, double>())};
        return all;
    } catch (const nlohmann::json::exception& error) {
        throw bad_input("{}: {}", path.string(), error.what());
    }
}

void write_performance(const std::filesystem::path& path, const Performance& all) {
    nlohmann::ordered_json json{
        {"machine", all.machine},
        {"system", all.system},
        {"compiler", all.compiler},
        {"date", all.date},
        {"reference", {{"ns", rounded(all.reference_ns)}, {"spread", rounded(all.reference_spread)}}}};
    for (const auto& [name, one] : all.benchmarks) {
        auto& entry = json["benchmarks"][name];
        entry = {{"ns", rounded(one.ns)},
                 {"spread", rounded(one.spread)},
                 {"ratio", rounded(one.ratio)},
                 {"rounds", one.rounds}};
        for (const auto& [counter, value] : one.counters) entry["counters"][counter] = rounded(value);
    }
    write_page(path, json.dump(1) + "\n");
}

std::vector<Fall> falls(const Performance& kept, const Performance& now, double maximum) {
    std::vector<Fall> all;
    for (const auto& [name, one] : now.benchmarks) {
        const auto before = kept.benchmarks.find(name);
        if (before != kept.benchmarks.end() && one.ratio * (1 - maximum) > before->second.ratio)
            all.push_back({name, before->second.ratio, one.ratio});
    }
    return all;
}

}  // namespace doppel
