#pragma once

#include "output/csv.hpp"
#include "picture/plot.hpp"

#include <atomic>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace doppel {

/// The numbers that one trial of a figure comes to, at least one; NaN where one could not be had.
using TrialNumbers = std::vector<double>;

/// What a figure has to say about itself beside its table: a key of the manifest.
struct Finding {
    std::string key;
    std::variant<double, std::string, bool> value;
};

/// What a figure computes: trials that know nothing of each other, and what becomes of their numbers. They may be
/// computed in any order, by any thread, in several runs on several machines; the numbers are the same to the bit.
class FigureWork {
public:
    virtual ~FigureWork() = default;

    virtual std::size_t trials() const = 0;
    /// How many trials in a row one call of compute() takes best. Changes no result.
    virtual std::size_t together() const { return 1; }
    /// Whether its trials measure time, and so are computed one after the other, by themselves.
    virtual bool measures_time() const { return false; }
    /// What a person would count, "pairs", and how many of them a trial is; 0 for what other trials rest on.
    virtual std::string unit() const { return "trials"; }
    virtual double units(std::size_t /*trial*/) const { return 1; }

    /// Trials first, first + 1 … one for each of `numbers`. Throws Error: exit 3 where a method breaks down and nothing
    /// is left to show, exit 130 soon after `stop` is set.
    virtual void compute(std::size_t first, std::span<TrialNumbers> numbers, const std::atomic<bool>& stop) const = 0;

    /// The table: its columns, and its rows from the numbers of all trials.
    virtual std::vector<std::string> columns() const = 0;
    virtual void write_rows(std::span<const TrialNumbers> numbers, Csv& table) const = 0;

    /// The panels (or the page), and captions that hold numbers just found. Titles are there already.
    virtual void draw(std::span<const TrialNumbers> numbers, Figure& figure) const = 0;
    virtual std::vector<Finding> findings(std::span<const TrialNumbers> numbers) const = 0;

    /// Everything that the numbers depend on, as the preset's tables would say it (TOML).
    virtual std::string resolved() const = 0;
    /// The keys of [chart] among it.
    virtual std::string resolved_chart() const { return {}; }
};

}  // namespace doppel
