#include "analysis/section.hpp"

#include "analysis/exponent.hpp"
#include "figure/kinds.hpp"
#include "image/color.hpp"
#include "scene/captions.hpp"

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// The first numbers of an orbit: its largest exponent, 1/s, and the number of crossings that follow.
struct OrbitRow {
    double exponent, uncertainty, crossings;

    bool regular() const { return is_regular({exponent, uncertainty}); }
};
OrbitRow orbit_of(const TrialNumbers& orbit) {
    return row_of<OrbitRow>(orbit);
}
std::vector<SectionPoint> crossings_of(const TrialNumbers& orbit) {
    return rows_of<SectionPoint>(std::span(orbit).subspan(numbers_in<OrbitRow>));
}

/// Poincaré sections of a double pendulum at θ1 = 0, one panel for each energy. Orbits whose largest exponent cannot be
/// distinguished from 0 are regular.
class Section final : public Experiment {
public:
    static constexpr std::string_view table_key = "section";
    Section() = default;
    explicit Section(FigureReader& reader) : release_(reader.release()) {
        const auto table = reader.settings(*this);
        if (reader.only_keys) return;
        auto system = reader.top.inner("system");
        for (const char* key : {"angle_deg", "omega_deg_per_s"})
            if (system.has(key))
                throw system.error(key, "is not for a section, whose orbits start at all states of an energy");
        if (release_.links() != 2) throw table.error("energy_J", "is for two links; there are {}", release_.links());
        settings_ = resolved_chain(release_) + settings_text(*this);
        unit_ = "orbits";
        columns_ = {"energy_J", "orbit", "exponent_per_s", "regular", "time_s", "theta2_rad", "p2_N_m_s"};
        subtitle_ =
            fmt::format("Poincaré sections θ₁ = 0, ω₁ > 0 of a double pendulum, {}; energies above hanging at rest",
                        links_words(release_));
        const auto pendulum = chain_of(release_).cast<double>();
        for (const double energy : energies_) releases_.push_back(releases_of_energy(pendulum, energy, orbits_));
    }

    void fields(KeyVisitor& visit) {
        visit({.key = "energy_J",
               .help = "of each panel's orbits, above hanging at rest",
               .unit = "J",
               .bounds = positive,
               .maximum = 6},
              energies_);
        visit({"orbits", "of each energy", "", from_to(1, 10'000)}, orbits_);
        visit({"crossings", "of each orbit", "", from_to(1, 1'000'000)}, spec_.crossings);
        visit({"tolerance", "of taylor: relative error of a step", "", positive}, spec_.tolerance);
        visit({"exponent_duration_s",
               "duration of the motion whose largest exponent decides between regular and chaotic", "s", positive},
              exponent_duration_s_);
    }

    std::size_t trials() const override { return energies_.size() * orbits(); }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        if (numbers.size() < numbers_in<OrbitRow> || !all_finite(numbers)) return false;
        const double crossings = row_of<OrbitRow>(numbers).crossings;
        return is_count(crossings) && crossings <= spec_.crossings &&
               numbers.size() == numbers_in<OrbitRow> + numbers_in<SectionPoint> * static_cast<std::size_t>(crossings);
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto orbit = orbit_of(numbers[i]);
            for (const auto& crossing : crossings_of(numbers[i]))
                add_row(table, energies_[i / orbits()], i % orbits(), orbit.exponent, orbit.regular(), crossing.time_s,
                        crossing.theta2, crossing.p2);
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        long maximum = 0;
        for (std::size_t panel = 0; panel < energies_.size(); ++panel) {
            const auto own = numbers.subspan(panel * orbits(), orbits());
            figure.panels.push_back(plot_of(panel, own));
            maximum = std::max(maximum, regular_ones(own));
        }
        figure.captions.push_back(
            fmt::format("In colour, regular orbits ({}): the largest Lyapunov exponent of {} s of their motion is at "
                        "most 1.5 times its uncertainty. In grey, chaotic ones.",
                        maximum > static_cast<long>(themes.front().palette.size()) ? "colours repeat" : "a colour each",
                        grouped(std::lround(exponent_duration_s_))));
    }

    std::optional<std::string> nothing_to_draw(std::span<const TrialNumbers> numbers) const override {
        for (const auto& orbit : numbers)
            if (orbit_of(orbit).crossings > 0) return std::nullopt;
        return fmt::format("no orbit comes back to θ₁ = 0 within {:g} s; take a higher energy_J", spec_.longest_s);
    }

private:
    TrialNumbers compute(std::size_t trial, const std::atomic<bool>& stop) const override {
        const auto& release = releases_[trial / orbits()][trial % orbits()];
        const auto points = poincare_section(release, spec_, stop);
        const auto exponent = largest_exponent(release, {.duration_s = exponent_duration_s_}, stop);
        TrialNumbers numbers{exponent.value, exponent.uncertainty, static_cast<double>(points.size())};
        for (const auto& point : points) append(numbers, point);
        return numbers;
    }

    Plot plot_of(std::size_t panel, std::span<const TrialNumbers> orbits_of_panel) const {
        Plot plot{.title = fmt::format("E = {:.4g} J", energies_[panel])};
        plot.note = fmt::format("{} of {} regular", regular_ones(orbits_of_panel), orbits());
        plot.x = {.label = "θ₂, rad"};
        plot.y = {.label = "p₂, N m s"};
        plot.square = true;
        int hue = 0;
        for (const auto& numbers : orbits_of_panel) {
            Curve curve{.mark = Mark::points};
            if (orbit_of(numbers).regular())
                curve.hue = hue++;
            else
                curve.quiet = true;
            for (const auto& crossing : crossings_of(numbers)) add_point(curve, crossing.theta2, crossing.p2);
            plot.curves.push_back(std::move(curve));
        }
        return plot;
    }
    static long regular_ones(std::span<const TrialNumbers> orbits) {
        return std::ranges::count_if(orbits, [](const auto& orbit) { return orbit_of(orbit).regular(); });
    }

    std::size_t orbits() const { return static_cast<std::size_t>(orbits_); }

    SideSpec release_;
    SectionSpec spec_;
    double exponent_duration_s_ = 10000;
    std::vector<double> energies_{9.8, 49, 98};  // above the hanging equilibrium, J
    int orbits_ = 24;
    std::vector<std::vector<Pendulum<double>>> releases_;  // for each energy
};

}  // namespace

const FigureKind section_kind = kind_of<Section>("section");

}  // namespace doppel
