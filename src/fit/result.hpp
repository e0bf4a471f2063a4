#pragma once

#include "film/run.hpp"
#include "fit/horizon.hpp"
#include "fit/model_hierarchy.hpp"

namespace doppel {

/// What to fit, what is known in addition, and where results go.
struct FitOptions {
    Bodies bodies = Bodies::automatic;
    Convention convention;
    std::optional<double> every_s;      // between the beginnings of pieces; searched for if not given
    std::filesystem::path out = "out";  // the files go to OUT/NAME/
    std::string name;                   // of the result; that of the first file if empty
    int jobs = 0;                       // threads that compute; 0 = one per core
    bool force = false;                 // as in Replacing
};

/// Pieces at regular intervals, each with a clock of its own.
struct Period {
    double seconds = 0, standard_error = 0;
};

/// All results of "doppel fit" for a track.
struct FitResult {
    Track track;
    ModelHierarchy hierarchy;
    Uncertainty uncertainty;             // of the chosen model
    std::optional<Period> period;        // of the pieces, if it was found and not given
    std::optional<Horizon> horizon;      // nothing if the times between pieces are unknown, or pieces are too short
    FittedPendulum pendulum;             // of the preset's model
    double models_cpu_s = 0, cpu_s = 0;  // of the hierarchy; of all

    const FittedModel& chosen() const { return hierarchy.candidates[hierarchy.chosen]; }
};

/// Fits all models, chooses one, and evaluates it. `report` gets the number of finished models. Throws Error: exit 3 if
/// no model describes the track or the swing gains energy, 130.
FitResult analyse(Track track, const FitOptions& options, const std::atomic<bool>& stop,
                  const std::function<void(const Progress&)>& report);

/// The results of a run, and sentences for the user.
struct FitRun {
    RunResult run;
    std::vector<std::string> sentences;
};

/// Reads the tracks, fits, and writes NAME.toml, NAME.residuals.csv, NAME.png and NAME.fit.json, all or none. Table and
/// preset have the same bytes for any number of threads. Throws Error: exit 2, 3, 4 or, soon after `stop` is set, 130.
FitRun run_fit(const std::vector<std::filesystem::path>& files, const FitOptions& options,
               const std::atomic<bool>& stop, const std::function<void(const Progress&)>& report);

/// The name of the results for these files. Throws Error (exit 2) if it cannot be the name of a folder.
std::string fit_name(const std::vector<std::filesystem::path>& files, const FitOptions& options);

}  // namespace doppel
