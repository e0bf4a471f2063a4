#include "fit/segment.hpp"

#include "fit/flow.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace doppel {
namespace {

constexpr int others = static_cast<int>(parameter_count - dynamic_count) + 1;  // an even number

/// Whether there is any, or some to be found.
bool has_friction(const ModelSpec& model, const Parameters& parameters) {
    return std::any_of(model.fitted.begin(), model.fitted.end(), is_friction) ||
           std::any_of(parameters.begin() + index_of(FitParameter::viscous_1), parameters.begin() + dynamic_count,
                       [](double value) { return value != 0; });
}

/// N = 4 starts and room for the fitted parameters of the motion.
template <int N>
Arms<Dual<double, N>> dual_arms(const ModelSpec& model, const Parameters& parameters) {
    Arms<Dual<double, N>> arms{.p = {}, .drag = model.drag, .has_friction = has_friction(model, parameters)};
    for (std::size_t k = 0; k < dynamic_count; ++k) arms.p[k] = parameters[k];
    Eigen::Index direction = 4;
    for (const auto parameter : model.fitted)
        if (is_dynamic(parameter))
            arms.p[index_of(parameter)] = Dual<double, N>::variable(parameters[index_of(parameter)], direction++);
    if (model.point_masses)
        arms.p[index_of(FitParameter::gravity_1)] = arms.p[index_of(FitParameter::inertia)] *
                                                    arms.p[index_of(FitParameter::gravity_2)] /
                                                    arms.p[index_of(FitParameter::coupling)];
    return arms;
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

template <int N>
class Evaluation {
public:
    using Number = Dual<double, N>;
    static constexpr int most = N + others;
    using Row = Eigen::Matrix<double, most, 1>;

    Evaluation(const Track& track, const ModelSpec& model, const FitRules& rules, const Parameters& parameters,
               const TrackSegment& segment, std::size_t number, const SegmentExtras& extras)
        : piece_(track.pieces[segment.piece]),
          model_(model),
          rules_(rules),
          parameters_(parameters),
          segment_(segment),
          number_(number),
          extras_(extras),
          reading_(model) {
        if (extras_.residuals) extras_.residuals->reserve(2 * segment.size());
        matrix_.setZero();
        slope_.setZero();
    }

    SegmentSums run(const ArmState<double>& start) {
        ArmState<Number> state;
        for (std::size_t q = 0; q < 4; ++q) state[q] = Number::variable(start[q], static_cast<Eigen::Index>(q));
        Flow<Number> flow(dual_arms<N>(model_, parameters_), state, rules_.step_s);
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
                add(flow, sample, arm, *weights);
            }
        }
        if (!std::isfinite(sums_.cost)) return failed();
        return finished();
    }

private:
    double lag() const { return parameters_[index_of(FitParameter::lag)]; }

    void add(const Flow<Number>& flow, std::size_t sample, std::size_t arm, const AngleWeights& weights) {
        const double offset = parameters_[index_of(FitParameter::offset_1) + arm];
        const double scale = parameters_[index_of(FitParameter::scale_1) + arm];
        double angle = 0, rate = 0;
        Row row = Row::Zero();
        const auto nodes = flow.nodes(arm);
        auto head = row.template head<N>();
        for (std::size_t k = 0; k < 6; ++k) {
            angle += weights.angle[k] * nodes[k]->value;
            rate += weights.rate[k] * nodes[k]->value;
            head += (scale * weights.angle[k]) * nodes[k]->tangent;
        }
        reading_.set(row, arm, angle, scale * rate);
        const double measured = piece_.angle[arm][sample], residual = measured - (offset + scale * angle);
        weigh(row, residual, arm);
        if (extras_.residuals) extras_.residuals->push_back({number_, sample, arm, measured, residual});
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
        matrix_.template selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
        slope_ += (weight * residual) * row;
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
        const Eigen::Matrix<double, most, most> full = matrix_.template selfadjointView<Eigen::Lower>();
        sums_.starts = full.template topLeftCorner<4, 4>();
        sums_.mixed = full.block(0, 4, 4, count);
        sums_.shared = full.block(4, 4, count, count);
        sums_.start_slope = slope_.template head<4>();
        sums_.shared_slope = slope_.segment(4, count);
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
    Eigen::Matrix<double, most, most> matrix_;
    Row slope_;
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
    Arms<double> arms{.p = {}, .drag = model.drag, .has_friction = has_friction(model, all)};
    std::copy_n(all.begin(), dynamic_count, arms.p.begin());
    return arms;
}

SegmentSums evaluate_segment(const Track& track, const ModelSpec& model, const FitRules& rules,
                             const Parameters& parameters, const ArmState<double>& start, const TrackSegment& segment,
                             std::size_t number, const SegmentExtras& extras) {
    const auto evaluate = [&]<int N>() {
        return Evaluation<N>(track, model, rules, parameters, segment, number, extras).run(start);
    };
    const auto dynamic = std::count_if(model.fitted.begin(), model.fitted.end(), is_dynamic);
    if (dynamic == 0) return evaluate.template operator()<4>();
    if (dynamic <= 4) return evaluate.template operator()<8>();
    if (dynamic <= 6) return evaluate.template operator()<10>();
    if (dynamic <= 8) return evaluate.template operator()<12>();
    return evaluate.template operator()<14>();
}

}  // namespace doppel
