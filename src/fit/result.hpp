#pragma once

#include "film/run.hpp"
#include "fit/horizon.hpp"
#include "fit/model_hierarchy.hpp"

namespace doppel {

/// What to fit, what is known besides, and where results go.
struct FitOptions {
    Bodies bodies = Bodies::automatic;
    Convention convention;
    std::optional<double> every_s;      // between the beginnings of pieces; found where not given
    std::filesystem::path out = "out";  // the files go to OUT/NAME/
    std::string name;                   // of the result; that of the first file where it is empty
    int jobs = 0;                       // threads that compute; 0 = one a core
    bool force = false;                 // as Replacing has it
};

/// Pieces that follow one another at even intervals on a clock that each begins anew.
struct Period {
    double seconds = 0, standard_error = 0;
};

/// All that "doppel fit" finds out of a track.
struct FitResult {
    Track track;
    ModelHierarchy hierarchy;
    Uncertainty uncertainty;       // of the chosen model
    std::optional<Period> period;  // of the pieces, where it was found and not given
    std::optional<Horizon>
        horizon;              // nothing where it is not known how pieces follow one another, or they are too short
    FittedPendulum pendulum;  // of the preset's model
    double models_cpu_s = 0, cpu_s = 0;  // of the hierarchy; of all

    const FittedModel& chosen() const { return hierarchy.candidates[hierarchy.chosen]; }
};

/// Fits all models, chooses one, and measures it. `report` hears how many models are done. Throws Error: exit 3 where no
/// model describes the track or the swing gains energy, 130.
FitResult answer(Track track, const FitOptions& options, const std::atomic<bool>& stop,
                 const std::function<void(const Progress&)>& report);

// run.cpp

/// What came of a run, and sentences for the person.
struct FitRun {
    RunResult run;
    std::vector<std::string> sentences;
};

/// Reads the tracks, fits, and writes NAME.toml, NAME.residuals.csv, NAME.png and NAME.fit.json, all or none. Table and
/// preset are the same to the byte for any number of threads. Throws Error: exit 2, 3, 4 or, soon after `stop` is set,
/// 130.
FitRun run_fit(const std::vector<std::filesystem::path>& files, const FitOptions& options,
               const std::atomic<bool>& stop, const std::function<void(const Progress&)>& report);

/// Of the results of files. Throws Error (exit 2) where it can be no folder's.
std::string fit_name(const std::vector<std::filesystem::path>& files, const FitOptions& options);

}  // namespace doppel
