#include "analysis/spectrum.hpp"

#include "figure/kinds.hpp"
#include "scene/scene.hpp"
#include "scene/resolved.hpp"
#include "scene/captions.hpp"

#include <cmath>
#include <numeric>

namespace doppel {
namespace {

/// All Lyapunov exponents of one motion, as their estimates settle.
class Spectrum final : public FigureWork {
public:
    explicit Spectrum(FigureReader& reader) : release_(reader.release()) {
        auto table = reader.table("spectrum");
        constexpr std::size_t most_links = 4;
        if (release_.links() > most_links)
            throw table.fault("duration_s", "is for 1 to {} links; there are {}", most_links, release_.links());
        table.read_positive("duration_s", spec_.duration_s);
        table.read_whole("samples", spec_.samples, 2, 100'000);
        table.read_positive("tolerance", spec_.tolerance);
        constexpr double finest = 1e-14, coarsest = 1e-2;
        if (spec_.tolerance < finest || spec_.tolerance > coarsest)
            throw table.fault("tolerance", "must be from {} to {}; it is {}", finest, coarsest, spec_.tolerance);
        table.finish();
    }

    std::size_t trials() const override { return 1; }
    std::string unit() const override { return "spectra"; }

    void compute(std::size_t, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (const auto& sample : lyapunov_spectrum(chain_of(release_).cast<double>(), spec_, stop)) {
            numbers[0].push_back(sample.time_s);
            numbers[0].insert(numbers[0].end(), sample.exponents.begin(), sample.exponents.end());
        }
    }

    bool fits(std::size_t /*trial*/, std::span<const double> numbers) const override {
        return numbers.size() == samples() * (exponents() + 1) && all_finite(numbers);
    }

    std::vector<std::string> columns() const override {
        std::vector<std::string> names{"time_s"};
        for (std::size_t i = 1; i <= exponents(); ++i) names.push_back(fmt::format("exponent{}_per_s", i));
        names.emplace_back("sum_per_s");
        return names;
    }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t n = 0; n < samples(); ++n) {
            for (std::size_t i = 0; i <= exponents(); ++i) table.add(entry(numbers, n, i));
            table.add(sum(numbers, n));
            table.end_row();
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        Plot plot;
        plot.x = {.label = "time, s", .logarithmic = true};
        plot.y = {.label = "exponents so far, 1/s"};
        constexpr const char* subscripts[] = {"₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈"};
        for (std::size_t i = 1; i <= exponents(); ++i) {
            Curve curve{.label = fmt::format("λ{}", subscripts[i - 1]), .hue = static_cast<int>(i) - 1};
            for (std::size_t n = 0; n < samples(); ++n) {
                curve.x.push_back(entry(numbers, n, 0));
                curve.y.push_back(entry(numbers, n, i));
            }
            plot.curves.push_back(std::move(curve));
        }
        plot.rules.push_back({Rule::Way::horizontal, 0, ""});
        figure.panels.push_back(std::move(plot));
        std::string words;
        for (std::size_t i = 1; i <= exponents(); ++i)
            words += fmt::format("{}{}{:.4f}", i == 1 ? "" : ", ", entry(numbers, samples() - 1, i) < 0 ? "−" : "+",
                                 std::abs(entry(numbers, samples() - 1, i)));
        figure.captions.push_back(fmt::format(
            "After {} s: {} 1/s. Their sum is 0 within {}, and the pairs are ± within {} 1/s.", spec_.duration_s, words,
            scientific(std::abs(sum(numbers, samples() - 1))), scientific(mismatch(numbers))));
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t i = 1; i <= exponents(); ++i)
            all.push_back({fmt::format("exponent{}_per_s", i), entry(numbers, samples() - 1, i)});
        all.push_back({"sum_per_s", sum(numbers, samples() - 1)});
        all.push_back({"pair_mismatch_per_s", mismatch(numbers)});
        return all;
    }

    std::string resolved() const override {
        return resolved_release(release_) + fmt::format("\n[spectrum]\nduration_s = {}\nsamples = {}\ntolerance = {}\n",
                                                        spec_.duration_s, spec_.samples, spec_.tolerance);
    }

private:
    std::size_t exponents() const { return 2 * release_.links(); }
    std::size_t samples() const { return static_cast<std::size_t>(spec_.samples); }
    /// Entry 0 of a sample is its time, the others are the exponents.
    double entry(std::span<const TrialNumbers> numbers, std::size_t sample, std::size_t i) const {
        return numbers[0][sample * (exponents() + 1) + i];
    }
    double sum(std::span<const TrialNumbers> numbers, std::size_t sample) const {
        double total = 0;
        for (std::size_t i = 1; i <= exponents(); ++i) total += entry(numbers, sample, i);
        return total;
    }
    double mismatch(std::span<const TrialNumbers> numbers) const {
        SpectrumSample last{entry(numbers, samples() - 1, 0), {}};
        for (std::size_t i = 1; i <= exponents(); ++i) last.exponents.push_back(entry(numbers, samples() - 1, i));
        return pair_mismatch(last);
    }

    SideSpec release_;
    SpectrumSpec spec_;
};

}  // namespace

std::shared_ptr<const FigureWork> read_spectrum(FigureReader& reader) {
    return std::make_shared<Spectrum>(reader);
}

}  // namespace doppel
