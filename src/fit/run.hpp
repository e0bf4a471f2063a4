#pragma once

#include "film/run.hpp"
#include "fit/result.hpp"
#include "render/renderer.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace doppel {

struct FitOptions {
    FitQuestion question;
    std::filesystem::path out = "out";  // the files go to OUT/NAME/
    std::string name;                   // of the result; that of the first file where it is empty
    int jobs = 0;                       // threads that compute; 0 = one a core
    Gl gl = Gl::automatic;              // what draws
    bool force = false;                 // as Replacing has it
};

/// What came of it, and sentences for the person.
struct FitRun {
    RunResult run;
    std::vector<std::string> sentences;
};

/// Reads the tracks, fits, and writes NAME.toml, NAME.residuals.csv, NAME.png and NAME.fit.json, all or none. Table and preset are the
/// same to the byte for any number of threads. Throws Error: exit 2, 3, 4 or, soon after `stop` is set, 130.
FitRun run_fit(const std::vector<std::filesystem::path>& files, const FitOptions& options,
               const std::atomic<bool>& stop, const std::function<void(const Progress&)>& report);

/// Of the results of a file.
std::string fit_name(const std::filesystem::path& file);

}  // namespace doppel
