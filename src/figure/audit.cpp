#include "figure/claims.hpp"
#include "figure/kinds.hpp"

namespace doppel {
namespace {

std::string words(Verdict verdict) {
    constexpr const char* all[] = {"holds", "does not hold", "misprinted"};
    return all[static_cast<int>(verdict)];
}

/// The study's claims, one by one, put to the test: a page.
class Audit final : public FigureWork {
public:
    std::size_t trials() const override { return claims().size(); }
    std::string unit() const override { return "claims"; }

    void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = claims()[first + i].measure(stop);
    }

    bool fits(std::size_t trial, std::span<const double> numbers) const override {
        return numbers.size() == claims()[trial].numbers && all_finite(numbers);
    }

    std::vector<std::string> columns() const override { return {"claim", "measured", "verdict"}; }

    void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const override {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto& claim = claims()[i];
            table.add(claim.words);
            table.add(claim.found(numbers[i]));
            table.add(words(claim.verdict(numbers[i])));
            table.end_row();
        }
    }

    void draw(std::span<const TrialNumbers> numbers, Figure& figure) const override {
        using Tone = PlotTable::Tone;
        constexpr Tone tones[] = {Tone::good, Tone::bad, Tone::open};
        PlotTable page{.columns = {{"the study", 0.33f}, {"measured", 0.54f}, {"verdict", 0.13f}}, .rows = {}};
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto& claim = claims()[i];
            const auto verdict = claim.verdict(numbers[i]);
            page.rows.push_back({{std::string(claim.words)},
                                 {claim.found(numbers[i])},
                                 {words(verdict), tones[static_cast<int>(verdict)]}});
        }
        figure.table = std::move(page);
    }

    std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const override {
        std::vector<Finding> all;
        for (std::size_t i = 0; i < numbers.size(); ++i)
            all.push_back({std::string(claims()[i].key), words(claims()[i].verdict(numbers[i]))});
        return all;
    }

    std::string resolved() const override { return ""; }
};

}  // namespace

std::shared_ptr<const FigureWork> read_audit(FigureReader&) {
    return std::make_shared<Audit>();
}

}  // namespace doppel
