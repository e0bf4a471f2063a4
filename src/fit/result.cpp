#include "fit/result.hpp"

#include "base/clock.hpp"
#include "base/error.hpp"
#include "fit/energy.hpp"
#include "numeric/portable_math.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace doppel {
namespace {

/// How far the angles are spread about their mean, rms of both arms, rad.
double spread_of(const Track& track) {
    double squares = 0, count = 0;
    for (std::size_t arm = 0; arm < 2; ++arm)
        for (const auto& piece : track.pieces) {
            double sum = 0;
            for (const double angle : piece.angle[arm]) sum += angle;
            const double mean = sum / static_cast<double>(piece.size());
            for (const double angle : piece.angle[arm]) squares += (angle - mean) * (angle - mean);
            count += static_cast<double>(piece.size());
        }
    return std::sqrt(squares / count);
}

/// How much a model may leave, rms, rad.
double most_left(const Track& track) {
    constexpr double most_share = 0.05, noises = 3;
    return std::max(most_share * spread_of(track), noises * std::max(track.noise[0], track.noise[1]));
}

/// Throws where the swing gains energy. Only where friction that must not be negative is held at 0 need one look.
void demand_loss(const Track& track, const ModelLadder& ladder, int jobs, const std::atomic<bool>& stop) {
    constexpr double sure = 5;  // standard errors
    const auto is_viscous = [](const FittedModel& rung) {
        const auto& fitted = rung.model.fitted;
        const auto has = [&](FitParameter parameter) {
            return std::count(fitted.begin(), fitted.end(), parameter) > 0;
        };
        return has(FitParameter::viscous_1) && !has(FitParameter::coulomb_1);
    };
    const auto viscous = std::find_if(ladder.rungs.rbegin(), ladder.rungs.rend(), is_viscous);
    if (viscous == ladder.rungs.rend() || viscous->fit.at_bound.empty()) return;
    EnergyLoss loss;
    try {
        loss = energy_loss(track, ladder.division.segments, viscous->fit, jobs, stop);
    } catch (const Error& error) {  // no such fit, so no such gain
        if (error.code() != ExitCode::method_failed) throw;
        return;
    }
    const bool is_sure = loss.share < -sure * loss.standard_error;  // not where the error is not a number
    if (!is_sure || loss.rms > most_left(track)) return;
    throw method_failed(
        "{}: the swing gains energy, {:.2g} ± {:.1g} % of its energy of motion a second, and a pendulum that swings "
        "freely loses it: time_s must grow as time did, and nothing may drive the pendulum",
        track.pieces.front().name, -100 * loss.share, 100 * loss.standard_error);
}

/// Throws where even the best model leaves too much for its numbers to mean anything.
void demand_description(const Track& track, const ModelLadder& ladder) {
    const auto& best = ladder.rungs[ladder.best];
    if (best.left_out_rms <= most_left(track)) return;
    throw method_failed(
        "{}: no model describes this track: the best ({}) errs by {:.2g} rad on stretches left out, of angles "
        "spread by {:.2g} rad; is it a double pendulum that swings freely, and are the columns right?",
        track.pieces.front().name, best.name, best.left_out_rms, spread_of(track));
}

/// Exchanged, the arms obey the same equations, but for friction. No body, however, hangs by its own weight the wrong
/// way: D1 − C D2/B is the first arm's own moment, m1 a1 g and more, where B/(m2 a2) ≥ a2.
void demand_order(const Track& track, const ModelLadder& ladder) {
    constexpr double least = 1.01;
    const auto& p = ladder.rungs[ladder.best].fit.parameters;
    const auto of = [&](FitParameter parameter) { return p[index_of(parameter)]; };
    const double moment = of(FitParameter::gravity_1) / (of(FitParameter::coupling) * of(FitParameter::gravity_2));
    if (moment >= least) return;
    throw bad_input(
        "{}: theta1_rad and theta2_rad seem to be swapped: as they are, the first arm has no weight of its own "
        "(D1 B/(C D2) is {:.3f}, and more than 1 of any two bodies in order); theta1 is the arm at the pivot",
        track.pieces.front().name, moment);
}

void put_on_one_clock(FitResult& result, const FitQuestion& question, const std::atomic<bool>& stop) {
    auto& track = result.track;
    if (!track.start_s.empty() && !question.every_s) return;
    auto every = question.every_s;
    if (!every) {
        result.period = find_period(track, result.ladder.division, result.chosen().fit, stop);
        if (!result.period) return;
        every = result.period->seconds;
    }
    track.start_s.clear();
    for (std::size_t k = 0; k < track.pieces.size(); ++k) {
        track.start_s.push_back(static_cast<double>(k) * *every);
        if (k + 1 < track.pieces.size() && track.pieces[k].duration() > *every)
            throw bad_input("--every {}: {} lasts {:.4g} s, and the next piece cannot begin before its end", *every,
                            track.pieces[k].name, track.pieces[k].duration());
    }
}

}  // namespace

FitResult answer(Track track, const FitQuestion& question, int jobs, const std::atomic<bool>& stop,
                 const std::function<void(std::size_t done, std::size_t of)>& report) {
    const double start = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    FitResult result{.track = std::move(track)};
    auto& ladder = result.ladder = climb(result.track, question.bodies, jobs, stop, report);
    result.models_cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    demand_order(result.track, ladder);
    demand_loss(result.track, ladder, jobs, stop);
    demand_description(result.track, ladder);
    const auto& segments = ladder.division.segments;
    constexpr double of_errors = 0.2;  // of a model's own: there, steps need not be finer
    const auto finish = [&](FittedModel& rung) {
        rung.fit = fit_model(result.track, segments, rung.fit, {.step_share = of_errors, .jobs = jobs}, stop);
        auto uncertainty = uncertainty_of(result.track, segments, rung.fit, jobs, stop);
        if (!uncertainty.is_white) return uncertainty;
        rung.fit = fit_model(result.track, segments, rung.fit, {.jobs = jobs}, stop);
        rung.fit = of_better_law(result.track, segments, rung.fit, {.jobs = jobs}, stop);
        rung.model = rung.fit.model;
        return uncertainty_of(result.track, segments, rung.fit, jobs, stop);
    };
    result.uncertainty = finish(ladder.rungs[ladder.chosen]);
    put_on_one_clock(result, question, stop);
    if (!result.track.start_s.empty()) {
        auto horizon =
            measure_horizon(result.track, ladder.division, result.chosen().fit, result.uncertainty, jobs, stop);
        if (!horizon.predictions.empty()) result.horizon = std::move(horizon);
    }
    const auto& stated = result.chosen();
    result.pendulum = fitted_pendulum(stated.fit.parameters, stated.model.point_masses, question.convention);
    result.cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start;
    return result;
}

std::string residual_sentence(const FitResult& result) {
    const auto& u = result.uncertainty;
    const double rms = result.chosen().fit.rms;
    if (u.is_white)
        return fmt::format(
            "Residuals look like noise of {:.2g} rad: neighbours are not correlated ({:.2f} and {:.2f}).", rms,
            u.neighbour[0], u.neighbour[1]);
    const double noise = std::max(result.track.noise[0], result.track.noise[1]);
    const auto why = rms > 2 * noise ? fmt::format(
                                           "from sample to sample the angles scatter by {:.1g} rad only, so it is "
                                           "the model that errs",
                                           noise)
                                     : std::string("the measurement's own noise may be so");
    return fmt::format(
        "Residuals of {:.2g} rad are not noise: they keep their sign for some {:.2g} s; {}. Standard errors allow "
        "for it ({:.2g} times those of white noise).",
        rms, std::max(u.memory_s[0], u.memory_s[1]), why, u.inflation);
}

std::string horizon_sentence(const FitResult& result) {
    if (!result.horizon)
        return result.track.start_s.empty()
                   ? "No horizon: it is not known when each piece began; --every SECONDS tells."
                   : "No horizon: stretches are too short to predict from.";
    const auto& h = *result.horizon;
    const auto left = h.left_by[0] + h.left_by[1] + h.left_by[2];
    const auto span = [&](auto member) {
        const auto [least, most] =
            std::minmax_element(h.predictions.begin(), h.predictions.end(),
                                [&](const Prediction& a, const Prediction& b) { return a.*member < b.*member; });
        const auto from = fmt::format("{:.1f}", (*least).*member), to = fmt::format("{:.1f}", (*most).*member);
        return from == to ? from : from + " to " + to;
    };
    auto sentence =
        fmt::format("Predictions from {} s of data stay within {:.2g} rad ", span(&Prediction::data_s), h.limit);
    if (left == 0) {
        // of those seen for the median time or longer: (1 − p)ⁿ = 5 %
        std::vector<double> seen;
        for (const auto& p : h.predictions) seen.push_back(p.within_s);
        std::sort(seen.begin(), seen.end());
        const auto count = seen.size() - seen.size() / 2;
        return sentence + fmt::format(
                              "as long as the track shows them, {} s; of the {} seen for {:.1f} s or more none "
                              "left by then: at 95 % confidence at most {:.0f} % would.",
                              span(&Prediction::within_s), count, seen[seen.size() / 2],
                              100 * (1 - portable_pow(0.05, 1 / static_cast<double>(count))));
    }
    sentence += h.median_s ? fmt::format("for {:.1f} s (median)", *h.median_s)
                           : fmt::format("for longer than the track shows, {:.1f} s", h.longest_s);
    constexpr std::array<const char*, 3> names{"the model", "the start", "the parameters"};
    std::string because;
    for (std::size_t k = 0; k < names.size(); ++k)
        if (h.left_by[k] > 0) because += fmt::format("{}{} {}", because.empty() ? "" : ", ", names[k], h.left_by[k]);
    return sentence + fmt::format("; of {} predictions {} left, limited by: {}.", h.predictions.size(), left, because);
}

}  // namespace doppel
