#include "integrate/ensemble.hpp"

#include "base/error.hpp"
#include "integrate/ensemble_block.hpp"
#include "physics/angle_chain.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <array>

namespace doppel {

EnsembleBlock::~EnsembleBlock() = default;

namespace {

constexpr std::size_t ensemble_methods = std::tuple_size_v<EnsembleMethods>;

constexpr auto method_names = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{std::tuple_element_t<I, EnsembleMethods>::method.name...};
}
(std::make_index_sequence<ensemble_methods>());

/// The number of a method in EnsembleMethods; ensemble_methods where it is none of them.
std::size_t method_number(std::string_view name) {
    return static_cast<std::size_t>(std::find(method_names.begin(), method_names.end(), name) - method_names.begin());
}

/// The trials' numbers, by quantity, as the blocks are made from them.
struct Table {
    std::vector<double> mass, length, angle, rate, gravity;

    explicit Table(std::span<const Pendulum<double>> trials) {
        const std::size_t links = trials.front().links();
        const auto gather = [&](std::vector<double>& to, const std::vector<double> Pendulum<double>::*quantity) {
            for (std::size_t j = 0; j < links; ++j)
                for (const auto& trial : trials) to.push_back((trial.*quantity)[j]);
        };
        gather(mass, &Pendulum<double>::mass);
        gather(length, &Pendulum<double>::length);
        gather(angle, &Pendulum<double>::angle);
        gather(rate, &Pendulum<double>::rate);
        for (const auto& trial : trials) gravity.push_back(trial.gravity);
    }
};

/// A long chain on its own.
EnsembleBlock* make_lone_block(const EnsembleRequest& request, std::size_t trial) {
    const auto pendulum = pendulum_of<double>(request, trial);
    return request.constraints ? with_method<RodChain<double, Eigen::Dynamic>>(request, pendulum)
                               : with_method<AngleChain<double, Eigen::Dynamic>>(request, pendulum);
}

auto maker_of(int width) {
    switch (width) {
#ifdef DOPPEL_WIDE_ENSEMBLES
        case 4:
            return make_ensemble_block<4>;
        case 8:
            return make_ensemble_block<8>;
#endif
        case 2:
            return make_ensemble_block<2>;
        default:
            return make_lone_block;
    }
}

}  // namespace

bool Ensemble::serves(std::string_view method) {
    return method_number(method) < ensemble_methods;
}

std::vector<int> Ensemble::widths() {
    std::vector<int> widths{2};
#ifdef DOPPEL_WIDE_ENSEMBLES
    if (__builtin_cpu_supports("avx2")) widths.push_back(4);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) widths.push_back(8);
#endif
    return widths;
}

int Ensemble::chosen_width(int asked) {
    const auto all = widths();
    if (asked == 0) return all.back();
    if (std::find(all.begin(), all.end(), asked) == all.end())
        throw bad_input("this processor has no registers of {} doubles; the widest have {}", asked, all.back());
    return asked;
}

Ensemble::Ensemble(std::span<const Pendulum<double>> trials, EnsembleModel model, std::string_view method, double step,
                   int width)
    : trials_(trials.size()), block_(1), width_(1) {
    if (trials.empty()) throw bad_input("an ensemble needs at least one trial");
    const std::size_t links = trials.front().links();
    for (const auto& trial : trials)
        if (trial.links() != links)
            throw bad_input("the trials of an ensemble have as many links each: not {} and {}", links, trial.links());
    if (links <= ensemble_links) {
        width_ = chosen_width(width);
        block_ = static_cast<std::size_t>(ensemble_block(width_));
    }

    if (!serves(method))
        throw bad_input("\"{}\" does not step many trials side by side; these do: {}", method,
                        fmt::join(method_names, ", "));
    const Table table(trials);
    const EnsembleRequest request{.trials = trials_,
                                  .links = links,
                                  .mass = table.mass.data(),
                                  .length = table.length.data(),
                                  .angle = table.angle.data(),
                                  .rate = table.rate.data(),
                                  .gravity = table.gravity.data(),
                                  .step = step,
                                  .constraints = model == EnsembleModel::constraints,
                                  .method = method_number(method)};
    const auto make = maker_of(width_);
    for (std::size_t first = 0; first < trials_; first += block_) blocks_.emplace_back(make(request, first));
}

void Ensemble::advance(long steps) {
    for (auto& block : blocks_) block->advance(steps);
}

State<double, Eigen::Dynamic> Ensemble::state(std::size_t trial) const {
    State<double, Eigen::Dynamic> y;
    read(trial, y);
    return y;
}

void Ensemble::read(std::size_t trial, State<double, Eigen::Dynamic>& y) const {
    const auto& block = *blocks_[trial / block_];
    y.resize(static_cast<Eigen::Index>(block.dimensions()));
    block.read(trial % block_, y.data());
}

}  // namespace doppel
