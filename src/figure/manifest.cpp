#include "figure/manifest.hpp"

#include "integrate/ensemble.hpp"

#include <cmath>

namespace doppel {

void write_figure_manifest(Transaction& parts, const FigurePreset& figure, const KnownTrials& trials,
                           const FigureRecord& record) {
    Json findings = Json::object();
    for (const auto& finding : figure.work->findings(trials))
        std::visit([&](const auto& value) { findings[finding.key] = value; }, finding.value);  // not a number: null

    Json manifest = {
        {"doppel", program_json()},
        {"figure", figure.name},
        {"kind", figure.kind},
        {"title", figure.title},
        {"captions", figure.captions},
        {"erratum", figure.erratum},
        {"findings", findings},
        {"resolved_preset", json_of_toml(figure.resolved())},
        {"trials", trials.size()},
        {"threads", record.jobs},
        {"register_width", Ensemble::widths().back()},
        {"libraries", {{"gl", record.gl}, {"compiler", __VERSION__}}},
        {"time",
         {{"compute_wall_s", record.compute_wall_s},
          {"compute_cpu_s", record.compute_cpu_s},
          {"draw_cpu_s", record.draw_cpu_s}}},
    };
    write_manifest(parts, figure.name + ".json", std::move(manifest));
}

}  // namespace doppel
