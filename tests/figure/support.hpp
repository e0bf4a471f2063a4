#pragma once

#include "base/threads.hpp"
#include "figure/run.hpp"
#include "output/files.hpp"
#include "output/fixtures.hpp"
#include "scene/support.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <mutex>
#include <sstream>

namespace doppel {

inline FigurePreset figure_of(const std::string& preset, const std::vector<std::string>& arguments = {}) {
    return read_figure(find_preset(preset), sets(arguments));
}

inline FigurePreset figure_from(const std::string& text, const std::vector<std::string>& arguments = {}) {
    return read_figure({"x", "presets/x.toml", text}, sets(arguments));
}

inline KnownTrials computed(const FigurePreset& figure, int jobs = 2) {
    const std::atomic<bool> never = false;
    Computation computation(figure, header_of(figure), std::nullopt, {});
    const auto& trials = computation.unknown();
    parallel_for(trials.size(), jobs, [&](std::size_t i) { computation.compute(trials[i], never); });
    return computation.take_all();
}

/// Its panels and captions.
inline Figure page_of(const FigurePreset& figure) {
    Figure page;
    figure.experiment->draw(computed(figure), page);
    return page;
}

/// Expects an error of the input whose message contains `words`.
template <class Action>
void expect_refused(const std::vector<std::string>& words, const Action& action) {
    test::expect_error(ExitCode::bad_input, words, action);
}

/// The number of its pairs, orbits …
inline double units_of(const FigurePreset& figure) {
    double all = 0;
    for (std::size_t i = 0; i < figure.experiment->trials(); ++i) all += figure.experiment->units(i);
    return all;
}

/// A preset with changes, as a parameter of tests.
struct PresetCase {
    const char* name;
    std::vector<std::string> sets;
};
inline void PrintTo(const PresetCase& c, std::ostream* out) {
    *out << c.name;
}
/// As names of tests may be.
inline std::string underscored(std::string name) {
    std::ranges::replace(name, '-', '_');
    return name;
}
inline std::string name_of_case(const PresetCase& c, std::size_t index) {
    return underscored(fmt::format("{}_{}", c.name, index));
}

/// The text of the table's file.
inline std::string table_text(const FigurePreset& figure, const KnownTrials& trials) {
    const auto path = std::filesystem::path(DOPPEL_TEST_OUTPUT) / fmt::format("table-{}.csv", getpid());
    std::filesystem::create_directories(path.parent_path());
    Csv table(path, figure.experiment->columns());
    figure.experiment->write_rows(trials, table);
    table.finish();
    auto text = test::bytes_of(path);
    std::filesystem::remove(path);
    return text;
}

/// A table read back; empty cells and words are NaN.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<double>> rows;
    std::vector<std::vector<std::string>> words;  // the same cells as text

    explicit Table(const std::string& text) {
        std::istringstream lines(text);
        std::string line;
        std::getline(lines, line);
        columns = cells(line);
        while (std::getline(lines, line)) {
            auto& row = rows.emplace_back();
            for (const auto& cell : words.emplace_back(cells(line))) {
                row.push_back(std::numeric_limits<double>::quiet_NaN());
                std::from_chars(cell.data(), cell.data() + cell.size(), row.back());
            }
        }
    }

    /// The column `value` where the first column is `key`.
    double at(double key, std::size_t value) const {
        for (const auto& row : rows)
            if (row[0] == key) return row[value];
        ADD_FAILURE() << "the table has no row " << key;
        return std::numeric_limits<double>::quiet_NaN();
    }

private:
    static std::vector<std::string> cells(std::string line) {
        if (line.ends_with('\r')) line.pop_back();
        std::vector<std::string> all(1);
        for (const char c : line)
            if (c == ',')
                all.emplace_back();
            else
                all.back() += c;
        return all;
    }
};

inline Table table_of(const FigurePreset& figure) {
    return Table(table_text(figure, computed(figure)));
}

inline std::string header_line(const FigurePreset& figure) {
    std::string line;
    for (const auto& column : figure.experiment->columns()) line += (line.empty() ? "" : ",") + column;
    return line;
}

/// Ten pairs for half a second.
inline const std::vector<std::string> small_chart{"grid.x.to=9", "scene.duration_s=0.5", "chart.size=[320, 180]"};
/// Each a trial of its own, because this method is not computed in lanes.
inline FigurePreset small_sweep(std::vector<std::string> more = {}) {
    more.insert(more.begin(), "system.integrator=\"dop853\"");
    more.insert(more.end(), small_chart.begin(), small_chart.end());
    return figure_of("fig2-right", more);
}

/// Collects the reports of figures.
struct Said {
    std::vector<std::string> notes;
    std::vector<FigureProgress> progress;
    std::vector<RunResult> results;
    std::mutex mutex;

    /// Figures may report at the same time.
    FigureReport run_report() {
        const auto add = [this](auto& list, const auto& what) {
            const std::lock_guard hold(mutex);
            list.push_back(what);
        };
        return {[this, add](std::size_t, const FigureProgress& p) { add(progress, p); },
                [this, add](std::size_t, const std::string& sentence) { add(notes, sentence); },
                [this, add](std::size_t, const RunResult& result) { add(results, result); }};
    }
    bool has(std::string_view words) const {
        for (const auto& note : notes)
            if (note.find(words) != std::string::npos) return true;
        return false;
    }
};

/// Writes one figure's files.
inline RunResult run_figure(const FigurePreset& figure, const FigureOptions& options, Said& said) {
    const std::atomic<bool> never = false;
    run_figures({figure}, options, never, said.run_report());
    return said.results.back();
}

inline RunResult run_figure(const FigurePreset& figure, const FigureOptions& options) {
    Said said;
    return run_figure(figure, options, said);
}

}  // namespace doppel
