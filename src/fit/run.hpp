#pragma once

#include "fit/result.hpp"

namespace doppel {

/// What came of it, and sentences for the person.
struct FitRun {
    RunResult run;
    std::vector<std::string> sentences;
};

/// Reads the tracks, fits, and writes NAME.toml, NAME.residuals.csv, NAME.png and NAME.fit.json, all or none. Table and preset are the
/// same to the byte for any number of threads. Throws Error: exit 2, 3, 4 or, soon after `stop` is set, 130.
FitRun run_fit(const std::vector<std::filesystem::path>& files, const FitOptions& options,
               const std::atomic<bool>& stop, const std::function<void(const Progress&)>& report);

/// Of the results of files.
std::string fit_name(const std::vector<std::filesystem::path>& files, const FitOptions& options);

}  // namespace doppel
