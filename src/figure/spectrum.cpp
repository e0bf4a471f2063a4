#include "figure/series.hpp"
#include "figure/system_words.hpp"
#include "scene/captions.hpp"

#include <cmath>
#include <numeric>

namespace doppel {
namespace {

/// Convergence of the estimates of all Lyapunov exponents of one motion.
class Spectrum final : public Experiment {
public:
    Spectrum(FigureReader& reader, const TomlReader& table, SeriesKeys& keys)
        : release_(reader.release(true)), spec_{keys.duration_s, keys.samples, keys.tolerance} {
        if (reader.only_keys) return;
        if (release_.physical.has_coulomb())
            throw reader.document.table(reader.top, "system")
                .error("joint_coulomb_N_m",
                       "is not for Lyapunov exponents, which need a smooth motion: these joints stick and slip");
        constexpr std::size_t max_links = 4;
        if (release_.links() > max_links)
            throw table.error("quantity", "= \"exponents\" is for 1 to {} links; there are {}", max_links,
                              release_.links());
        settings_ = resolved_release(release_) + settings_text(keys);
        unit_ = "spectra";
        columns_ = {"time_s"};
        for (std::size_t i = 1; i <= exponents(); ++i) columns_.push_back(fmt::format("exponent{}_per_s", i));
        columns_.emplace_back("sum_per_s");
        const auto physical = physical_words(release_.physical);
        subtitle_ =
            fmt::format("a {}{} {}, {}; tangent equations in canonical variables, dop853",
                        chain_words(release_.links()), physical.empty() ? "" : fmt::format(" with {},", physical),
                        released_words(release_), links_words(release_));
    }

    std::size_t trials() const override { return 1; }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return numbers.size() == static_cast<std::size_t>(spec_.samples) * (exponents() + 1) && all_finite(numbers);
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (const auto& sample : samples_of(numbers)) {
            table.add(sample.time_s);
            for (const double exponent : sample.exponents) table.add(exponent);
            add_row(table, sum(sample));
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "time, s", .logarithmic = true};
        plot.y = {.label = "running estimates of the exponents, 1/s"};
        const auto samples = samples_of(numbers);
        for (std::size_t i = 0; i < exponents(); ++i) {
            Curve curve{.label = "λ" + subscript(i + 1), .hue = static_cast<int>(i)};
            for (const auto& sample : samples) add_point(curve, sample.time_s, sample.exponents[i]);
            plot.curves.push_back(std::move(curve));
        }
        plot.rules.push_back({Rule::Orientation::horizontal, 0, ""});
        figure.panels.push_back(std::move(plot));
        std::string words;
        const auto& last = samples.back();
        for (const double exponent : last.exponents)
            words += fmt::format("{}{}{:.4f}", words.empty() ? "" : ", ", exponent < 0 ? "−" : "+", std::abs(exponent));
        const auto of_them =
            preserves_volume()
                ? fmt::format("Their sum is 0 within {}, and the pairs are ± within {} 1/s.",
                              scientific(std::abs(sum(last))), scientific(pair_mismatch(last)))
                : fmt::format("Their sum is −{:.4f} 1/s, the mean rate at which friction contracts phase-space volume.",
                              std::abs(sum(last)));
        figure.captions.push_back(fmt::format("After {} s: {} 1/s. {}", spec_.duration_s, words, of_them));
    }

    Json findings(std::span<const TrialNumbers> numbers) const override {
        Json all;
        const auto last = samples_of(numbers).back();
        for (std::size_t i = 0; i < exponents(); ++i) all[fmt::format("exponent{}_per_s", i + 1)] = last.exponents[i];
        all["sum_per_s"] = sum(last);
        if (preserves_volume()) all["pair_mismatch_per_s"] = pair_mismatch(last);
        return all;
    }

private:
    std::size_t exponents() const { return 2 * release_.links(); }

    bool preserves_volume() const { return physical_of(release_).friction.is_none(); }

    TrialNumbers compute_trial(std::size_t, const std::atomic<bool>& stop) const override {
        TrialNumbers numbers;
        const auto samples = lyapunov_spectrum(physical_of(release_).cast<double>(), spec_, stop);
        for (const auto& sample : samples) {
            numbers.push_back(sample.time_s);
            numbers.insert(numbers.end(), sample.exponents.begin(), sample.exponents.end());
        }
        return numbers;
    }
    /// The numbers of each sample: its time, then the exponents.
    std::vector<SpectrumSample> samples_of(std::span<const TrialNumbers> numbers) const {
        std::vector<SpectrumSample> samples;
        const auto each = static_cast<std::ptrdiff_t>(exponents()) + 1;
        for (auto at = numbers[0].begin(); at != numbers[0].end(); at += each)
            samples.push_back({*at, {at + 1, at + each}});
        return samples;
    }
    static double sum(const SpectrumSample& sample) {
        return std::accumulate(sample.exponents.begin(), sample.exponents.end(), 0.0);
    }

    SideSpec release_;
    SpectrumSpec spec_;
};

}  // namespace

std::shared_ptr<const Experiment> make_spectrum(FigureReader& reader, const TomlReader& table, SeriesKeys& keys) {
    return std::make_shared<Spectrum>(reader, table, keys);
}

}  // namespace doppel
