#pragma once

#include "scene/manifest_json.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace doppel {

struct WorstErrors {
    double energy_a = 0, energy_b = 0;  // relative
    double length_a = 0, length_b = 0;  // m
};

/// What a run has to tell about itself besides the scene.
struct RunRecord {
    long first_sample = 0, last_sample = 0;  // in the table, both included
    long frames = 0;
    std::string gl, libav;                                       // empty where no pictures were made
    double simulate_cpu_s = 0, draw_cpu_s = 0, write_cpu_s = 0;  // by the threads' clocks; write = convert, hand over
    double encode_cpu_s = 0;  // the rest of the process: encoder or compressor threads
    double wall_s = 0, cpu_s = 0;
    WorstErrors worst;
    double largest_distance = 0;
    Effort effort_a, effort_b;
    std::string failure;  // what ended the run, where something did
};

/// Writes the manifest `name`; hashes the files that are finished. Throws Error (exit 4).
void write_manifest(Transaction& parts, const std::string& name, const Scene& scene, const RunRecord& record);

}  // namespace doppel
