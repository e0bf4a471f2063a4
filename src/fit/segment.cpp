#include "fit/segment.hpp"

#include "fit/flow.hpp"
#include "fit/variation.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace doppel {
namespace {

constexpr int offsets = 2, readings = 6;  // room for the parameters of reading: an even number

/// Whether there is any of these kinds of friction, or some to be found.
bool has_any(const ModelSpec& model, const Parameters& parameters, FitParameter first, FitParameter last) {
    const auto is_one = [&](FitParameter parameter) { return parameter >= first && parameter <= last; };
    return std::any_of(model.fitted.begin(), model.fitted.end(), is_one) ||
           std::any_of(parameters.begin() + index_of(first), parameters.begin() + index_of(last) + 1,
                       [](double value) { return value != 0; });
}

/// N = 4 starts and room for the fitted parameters of the motion.
template <int N>
VaryingArms<N> varying_arms(const ModelSpec& model, const Parameters& parameters) {
    VaryingArms<N> varying{.arms = arms_of(model, parameters), .direction = {}, .point_masses = model.point_masses};
    varying.direction.fill(-1);
    Eigen::Index direction = 4;
    for (const auto parameter : model.fitted)
        if (is_dynamic(parameter)) varying.direction[index_of(parameter)] = direction++;
    return varying;
}

/// Where the parameters of reading stand in a row of derivatives, after starts and motion; −1: not fitted.
struct ReadingColumns {
    std::array<Eigen::Index, 2> offset{-1, -1}, scale{-1, -1};
    Eigen::Index lag = -1;

    explicit ReadingColumns(const ModelSpec& model) {
        Eigen::Index column = 4;
        for (const auto parameter : model.fitted) {
            if (parameter == FitParameter::offset_1) offset[0] = column;
            if (parameter == FitParameter::offset_2) offset[1] = column;
            if (parameter == FitParameter::lag) lag = column;
            if (parameter == FitParameter::scale_1) scale[0] = column;
            if (parameter == FitParameter::scale_2) scale[1] = column;
            ++column;
        }
    }

    /// Of what an encoder shows, by them.
    template <class Row>
    void set(Row& row, std::size_t arm, double angle, double shown_rate) const {
        if (offset[arm] >= 0) row[offset[arm]] = 1;
        if (scale[arm] >= 0) row[scale[arm]] = angle;
        if (lag >= 0 && arm == 1) row[lag] = shown_rate;
    }
};

/// Σ w r rᵀ and Σ w ρ r of rows r with residuals ρ: four rows at a time, so that sums are read and written less often.
template <int size>
class NormalSums {
public:
    using Row = Eigen::Matrix<double, size, 1>;

    void add(const Row& row, double weight, double residual) {
        rows_.col(held_) = row;
        weights_[held_] = weight;
        slope_ += (weight * residual) * row;
        if (++held_ == at_once) flush();
    }

    void flush() {
        for (; held_ < at_once; ++held_) {
            rows_.col(held_).setZero();
            weights_[held_] = 0;
        }
        add_blocks(std::make_integer_sequence<int, (size + block_columns - 1) / block_columns>());
        held_ = 0;
    }

    Eigen::Matrix<double, size, size> matrix() const { return matrix_.template selfadjointView<Eigen::Lower>(); }
    const Row& slope() const { return slope_; }

private:
    static constexpr int at_once = 4, block_columns = 4;

    template <int... blocks>
    void add_blocks(std::integer_sequence<int, blocks...>) {
        (add_block<block_columns * blocks>(), ...);
    }

    /// Columns from that on, from the diagonal block down.
    template <int from>
    void add_block() {
        constexpr int length = size - from;
        for (int j = from; j < std::min(from + block_columns, size); ++j) {
            const Eigen::Vector4d by = weights_.cwiseProduct(rows_.row(j).transpose());
            const auto of = [&](int k) { return by[k] * rows_.col(k).template segment<length>(from); };
            matrix_.col(j).template segment<length>(from) += (of(0) + of(1)) + (of(2) + of(3));
        }
    }

    int held_ = 0;
    Eigen::Matrix<double, size, at_once> rows_ = Eigen::Matrix<double, size, at_once>::Zero();
    Eigen::Vector4d weights_ = Eigen::Vector4d::Zero();
    Eigen::Matrix<double, size, size> matrix_ = Eigen::Matrix<double, size, size>::Zero();
    Row slope_ = Row::Zero();
};

template <int N, int others>
class Evaluation {
public:
    using Number = Dual<double, N>;
    using Motion = Flow<Number, VaryingArms<N>>;
    static constexpr int most = N + others;
    using Row = typename NormalSums<most>::Row;

    Evaluation(const Track& track, const ModelSpec& model, const FitRules& rules, const Parameters& parameters,
               const TrackSegment& segment, std::size_t number, const SegmentExtras& extras)
        : piece_(track.pieces[segment.piece]),
          model_(model),
          rules_(rules),
          parameters_(parameters),
          segment_(segment),
          number_(number),
          extras_(extras),
          reading_(model) {}

    SegmentSums run(const ArmState<double>& start) {
        ArmState<Number> state;
        for (std::size_t q = 0; q < 4; ++q) state[q] = Number::variable(start[q], static_cast<Eigen::Index>(q));
        Motion flow(varying_arms<N>(model_, parameters_), state, rules_.step_s);
        const double begin = piece_.time_s[segment_.first];
        for (std::size_t sample = segment_.first; sample < segment_.last; ++sample) {
            const double t = piece_.time_s[sample] - begin;
            next_block(t);
            std::optional<AngleWeights> weights;
            for (std::size_t arm = 0; arm < 2; ++arm) {
                if (piece_.is_outlier[arm][sample]) continue;
                const double at = t + (arm == 1 ? lag() : 0);
                if (!flow.reach(at)) return failed();
                if (!weights || lag() != 0) weights = flow.weights(at);
                add(flow, sample, arm, at, *weights);
            }
        }
        if (!std::isfinite(sums_.cost)) return failed();
        return finished();
    }

private:
    double lag() const { return parameters_[index_of(FitParameter::lag)]; }

    void add(const Motion& flow, std::size_t sample, std::size_t arm, double at, const AngleWeights& weights) {
        const double offset = parameters_[index_of(FitParameter::offset_1) + arm];
        const double scale = parameters_[index_of(FitParameter::scale_1) + arm];
        const auto nodes = flow.nodes(arm);
        const auto& by = weights.angle;
        const double angle = (by[0] * nodes[0]->value + by[1] * nodes[1]->value) +
                             (by[2] * nodes[2]->value + by[3] * nodes[3]->value) +
                             (by[4] * nodes[4]->value + by[5] * nodes[5]->value);
        Row row = Row::Zero();
        const auto part = [&](std::size_t k) { return (scale * by[k]) * nodes[k]->tangent; };
        row.template head<N>() = (part(0) + part(1)) + (part(2) + part(3)) + (part(4) + part(5));
        reading_.set(row, arm, angle, reading_.lag >= 0 ? scale * flow.angle_rate(arm, at) : 0);
        const double measured = piece_.angle[arm][sample], residual = measured - (offset + scale * angle);
        weigh(row, residual, arm);
        if (extras_.residuals) extras_.residuals[sums_.count - 1] = {number_, sample, arm, measured, residual};
    }

    void weigh(const Row& row, double residual, std::size_t arm) {
        const double scale = rules_.scale[arm], z = residual / scale, size = std::abs(z), bend = FitRules::bend;
        const bool beyond = size > bend;
        sums_.cost += beyond ? bend * size - 0.5 * bend * bend : 0.5 * z * z;
        sums_.bounded += beyond ? bend * bend : z * z;
        sums_.squares += residual * residual;
        sums_.arm_squares[arm] += residual * residual;
        ++sums_.count;
        const double weight = (beyond ? bend / size : 1) / (scale * scale);
        normal_.add(row, weight, residual);
        if (extras_.block_s > 0) sums_.blocks.back() += (weight * residual) * row.head(columns());
    }

    int columns() const { return 4 + static_cast<int>(model_.fitted.size()); }

    void next_block(double t) {
        if (extras_.block_s <= 0) return;
        const auto wanted = static_cast<std::size_t>(t / extras_.block_s) + 1;
        while (sums_.blocks.size() < wanted) sums_.blocks.emplace_back(Eigen::VectorXd::Zero(columns()));
    }

    SegmentSums finished() {
        const auto count = static_cast<Eigen::Index>(model_.fitted.size());
        normal_.flush();
        const auto full = normal_.matrix();
        sums_.starts = full.template topLeftCorner<4, 4>();
        sums_.mixed = full.block(0, 4, 4, count);
        sums_.shared = full.block(4, 4, count, count);
        sums_.start_slope = normal_.slope().template head<4>();
        sums_.shared_slope = normal_.slope().segment(4, count);
        return std::move(sums_);
    }

    SegmentSums failed() {
        const auto count = static_cast<Eigen::Index>(model_.fitted.size());
        SegmentSums none;
        none.mixed = Eigen::MatrixXd::Zero(4, count);
        none.shared = Eigen::MatrixXd::Zero(count, count);
        none.shared_slope = Eigen::VectorXd::Zero(count);
        none.cost = none.squares = std::numeric_limits<double>::infinity();
        return none;
    }

    const TrackPiece& piece_;
    const ModelSpec& model_;
    const FitRules& rules_;
    const Parameters& parameters_;
    const TrackSegment& segment_;
    std::size_t number_;
    const SegmentExtras& extras_;
    ReadingColumns reading_;
    SegmentSums sums_;
    NormalSums<most> normal_;
};

}  // namespace

Parameters completed(const ModelSpec& model, Parameters parameters) {
    if (model.point_masses)
        parameters[index_of(FitParameter::gravity_1)] = parameters[index_of(FitParameter::inertia)] *
                                                        parameters[index_of(FitParameter::gravity_2)] /
                                                        parameters[index_of(FitParameter::coupling)];
    return parameters;
}

Arms<double> arms_of(const ModelSpec& model, const Parameters& parameters) {
    const auto all = completed(model, parameters);
    using enum FitParameter;
    Arms<double> arms{.p = {}, .drag = model.drag, .has_friction = has_any(model, all, viscous_1, quadratic_2)};
    if (has_any(model, all, coulomb_1, coulomb_2)) arms.dry = model.dry;
    std::copy_n(all.begin(), dynamic_count, arms.p.begin());
    return arms;
}

std::size_t residual_count(const Track& track, const TrackSegment& segment) {
    std::size_t count = 2 * segment.size();
    for (const auto& is_outlier : track.pieces[segment.piece].is_outlier)
        for (auto i = segment.first; i < segment.last; ++i) count -= is_outlier[i] ? 1 : 0;
    return count;
}

SegmentSums evaluate_segment(const Track& track, const ModelSpec& model, const FitRules& rules,
                             const Parameters& parameters, const ArmState<double>& start, const TrackSegment& segment,
                             std::size_t number, const SegmentExtras& extras) {
    const auto evaluate = [&]<int N, int others>() {
        return Evaluation<N, others>(track, model, rules, parameters, segment, number, extras).run(start);
    };
    const auto dynamic = std::count_if(model.fitted.begin(), model.fitted.end(), is_dynamic);
    const auto read = static_cast<std::ptrdiff_t>(model.fitted.size()) - dynamic;
    if (read > offsets) return evaluate.template operator()<14, readings>();
    if (model.fitted.empty()) return evaluate.template operator()<4, 0>();
    if (dynamic <= 4) return evaluate.template operator()<8, offsets>();
    if (dynamic <= 6) return evaluate.template operator()<10, offsets>();
    if (dynamic <= 8) return evaluate.template operator()<12, offsets>();
    return evaluate.template operator()<14, offsets>();
}

}  // namespace doppel
