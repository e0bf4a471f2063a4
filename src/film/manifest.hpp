#pragma once

#include "film/parting.hpp"
#include "scene/manifest_json.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

/// A side's largest errors, and its cost.
struct SideRecord {
    double energy_error = 0;  // relative
    double length_error = 0;  // m
    Effort effort;
};

/// What the manifest says of a run besides the scene.
struct RunRecord {
    long first_sample = 0, last_sample = 0;  // in the table, both included
    long frames = 0;
    std::string gl, libav;                                       // empty where no pictures were made
    double simulate_cpu_s = 0, draw_cpu_s = 0, write_cpu_s = 0;  // by the threads' clocks; write = convert, hand over
    double encode_cpu_s = 0;  // the rest of the process: encoder or compressor threads
    double wall_s = 0, cpu_s = 0;
    SideRecord a, b;
    double largest_distance = 0;
    Parting parting;
    std::string failure;  // what ended the run, where something did
};

/// Writes the manifest `name`; hashes the files that are finished. Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, const Scene& scene, const RunRecord& record);

}  // namespace doppel
