#include "figure/audit.hpp"

#include "figure/kinds.hpp"

namespace doppel {
namespace {

std::string words(Verdict verdict) {
    constexpr const char* all[] = {"holds", "does not hold", "misprinted"};
    return all[static_cast<int>(verdict)];
}

/// The study's claims, measured one by one: a table.
class Audit final : public Experiment {
public:
    explicit Audit(FigureReader&) {}

    std::size_t trials() const override { return claims().size(); }
    std::string unit() const override { return "claims"; }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        return numbers.size() == claims()[trial].numbers && all_finite(numbers);
    }

    std::vector<std::string> columns() const override { return {"claim", "measured", "verdict"}; }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto judgement = claims()[i].judge(numbers[i]);
            add_row(table, claims()[i].words, judgement.found, words(judgement.verdict));
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        using Tone = PlotTable::Tone;
        constexpr Tone tones[] = {Tone::good, Tone::bad, Tone::open};
        PlotTable page{.columns = {{"the study", 0.33f}, {"measured", 0.54f}, {"verdict", 0.13f}}, .rows = {}};
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto [verdict, found] = claims()[i].judge(numbers[i]);
            page.rows.push_back(
                {{std::string(claims()[i].words)}, {found}, {words(verdict), tones[static_cast<int>(verdict)]}});
        }
        figure.table = std::move(page);
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t i = 0; i < numbers.size(); ++i)
            all.push_back({std::string(claims()[i].key), words(claims()[i].judge(numbers[i]).verdict)});
        return all;
    }

private:
    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        return claims()[trial].measure(stop);
    }
};

}  // namespace

SideSpec side(std::vector<Quad> angle_deg, ModelChoice model) {
    SideSpec spec;
    spec.set_links(angle_deg.size());  // unit masses and lengths, at rest
    spec.angle_deg = std::move(angle_deg);
    spec.model = model;
    return spec;
}

SideSpec exactly(SideSpec spec) {
    spec.integrator = "taylor";
    spec.precision = Precision::in_quad;
    spec.tolerance = parse_quad("1e-26");
    return spec;
}

std::vector<double> distances(const SideSpec& a, const SideSpec& b, long count, const std::atomic<bool>& stop) {
    const auto scene = make_scene({.name = "audit", .duration_s = *reduced(count, 120), .a = a, .b = b});
    PairRun run(scene);
    std::vector<double> all;
    for (long n = 0; n <= count; ++n) all.push_back(run.next(stop).distance);
    return all;
}

std::vector<double> averages(const std::vector<SideTwins>& sides, const MotionSpec& method,
                             const std::atomic<bool>& stop) {
    std::vector<Twins> twins;
    for (const auto& [a, b] : sides) twins.push_back({chain_of(a).cast<double>(), chain_of(b).cast<double>()});
    std::vector<AverageLogRatio> means(twins.size());
    const auto watch = [&](std::size_t pair, long, const Bobs<double>& a, const Bobs<double>& b) {
        means[pair].add(state_space_distance(a, b));
    };
    step_twins(twins, {.a = method, .b = method, .samples = 3000}, watch, stop);
    std::vector<double> found;
    for (const auto& mean : means) found.push_back(mean.value());
    return found;
}

SideTwins angle_twins(int theta1_deg, int theta2_deg) {
    return {side({theta1_deg, theta2_deg}), side({theta1_deg + parse_quad("0.003"), theta2_deg})};
}

SideTwins mass_twins(int theta1_deg, int theta2_deg, double ratio) {
    auto twins = std::pair{side({theta1_deg, theta2_deg}), side({theta1_deg, theta2_deg})};
    twins.first.mass_kg[0] = ratio;
    twins.second.mass_kg[0] = ratio + 0.01;
    return twins;
}

SideSpec with_droplet(SideSpec spec, bool droplet) {
    spec.model = ModelChoice::mechanism;
    if (droplet)
        spec.forces.push_back({.name = {},
                               .part = DropletSpec{.position_m = QuadPair{1609, 0},
                                                   .mass_kg = parse_quad("0.000034"),
                                                   .constant_m3_per_kg_s2 = parse_quad("6.674e-11")}});
    return spec;
}

const FigureKind audit_kind = kind_of<Audit>("audit", FigureKind::System::none);

}  // namespace doppel
