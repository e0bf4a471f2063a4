#include "analysis/section.hpp"

#include "figure/kinds.hpp"
#include "image/color.hpp"

#include <cmath>

namespace doppel {
namespace {

/// The legend: a theme may have fewer colours than a section has orbits.
std::string color_words(std::size_t orbits) {
    const auto colors = themes.front().palette.size();
    if (orbits <= colors) return "Every colour is one orbit.";
    return fmt::format(
        "An orbit has one colour throughout; of the {} orbits to an energy, {} share each of {} colours.", orbits,
        orbits % colors == 0 ? fmt::format("{}", orbits / colors) : "several", colors);
}

/// A crossing of θ1 = 0. The numbers of an orbit: how many there are, then these.
struct CrossingRow {
    double theta2, p2, time_s;
};
std::vector<CrossingRow> crossings_of(const TrialNumbers& orbit) {
    return rows_of<CrossingRow>(std::span(orbit).subspan(1));
}

/// Poincaré sections of the double pendulum: where orbits of one energy pierce θ1 = 0, a panel an energy.
class Section final : public Experiment {
public:
    static constexpr std::string_view table_key = "section";
    Section() = default;
    explicit Section(FigureReader& reader) : release_(reader.release()) {
        auto system = reader.document.table(reader.top, "system");
        for (const char* key : {"angle_deg", "omega_deg_per_s"})
            if (system.has(key))
                throw system.fault(key, "is not for a section, whose orbits start all over their energy");
        auto table = reader.settings(*this);
        if (release_.links() != 2) throw table.fault("energy_J", "is for two links; there are {}", release_.links());
        settings_ = resolved_chain(release_) + table.finish();
        const auto pendulum = chain_of(release_).cast<double>();
        for (const double energy : energies_) releases_.push_back(releases_of_energy(pendulum, energy, orbits_));
    }

    template <class Visit>
    void fields(Visit& visit) {
        visit({.key = "energy_J",
               .help = "of each panel's orbits, above hanging at rest",
               .unit = "J",
               .bounds = positive,
               .most = 6},
              energies_);
        visit({"orbits", "of each energy", "", from_to(1, 10'000)}, orbits_);
        visit({"crossings", "of each orbit", "", from_to(1, 1'000'000)}, spec_.crossings);
        visit({"tolerance", "of taylor: relative error of a step", "", positive}, spec_.tolerance);
    }

    std::size_t trials() const override { return energies_.size() * orbits(); }
    std::string unit() const override { return "orbits"; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return !numbers.empty() && is_count(numbers[0]) && numbers[0] <= spec_.crossings &&
               numbers.size() == 1 + numbers_in<CrossingRow> * static_cast<std::size_t>(numbers[0]) &&
               all_finite(numbers);
    }

    std::vector<std::string> columns() const override {
        return {"energy_J", "orbit", "time_s", "theta2_rad", "p2_N_m_s"};
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i)
            for (const auto& crossing : crossings_of(numbers[i]))
                add_row(table, energies_[i / orbits()], i % orbits(), crossing.time_s, crossing.theta2, crossing.p2);
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        for (std::size_t panel = 0; panel < energies_.size(); ++panel) {
            Plot plot;
            plot.title = fmt::format("E = {:.4g} J", energies_[panel]);
            plot.x = {.label = "θ₂, rad"};
            plot.y = {.label = "p₂, N m s"};
            plot.square = true;
            for (std::size_t orbit = 0; orbit < orbits(); ++orbit) {
                Curve curve{.mark = Mark::points, .hue = static_cast<int>(orbit)};
                for (const auto& crossing : crossings_of(numbers[panel * orbits() + orbit]))
                    add_point(curve, crossing.theta2, crossing.p2);
                plot.curves.push_back(std::move(curve));
            }
            figure.panels.push_back(std::move(plot));
        }
        figure.captions.push_back(color_words(orbits()) +
                                  " Closed curves are regular orbits; what fills an area is chaotic.");
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        double points = 0;
        for (const auto& orbit : numbers) points += orbit.front();
        return {{"points", points}};
    }

private:
    TrialNumbers compute_trial(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto points = poincare_section(releases_[trial / orbits()][trial % orbits()], spec_, stop);
        TrialNumbers numbers{static_cast<double>(points.size())};
        for (const auto& point : points) append(numbers, CrossingRow{point.theta2, point.p2, point.time_s});
        return numbers;
    }

    std::size_t orbits() const { return static_cast<std::size_t>(orbits_); }

    SideSpec release_;
    SectionSpec spec_;
    std::vector<double> energies_{9.8, 49, 98};  // above hanging at rest, J
    int orbits_ = 24;
    std::vector<std::vector<Pendulum<double>>> releases_;  // by energy
};

}  // namespace

const FigureKind section_kind = kind_of<Section>("section", FigureKind::System::release);

}  // namespace doppel
