// Compiled once for every kind of processor, by the rules of integrate/batch_width.cpp.

#include "integrate/taylor_batch_kernel.hpp"

#include <cmath>

namespace doppel {
namespace {

struct ThisBuild;
using Pack = Lanes<compiled_width, ThisBuild>;

/// sum + lost ← sum + lost + more, all but exactly. Source  Knuth, The Art of Computer Programming 2, §4.2.2.
[[gnu::always_inline]] inline void add(Pack& sum, Pack& lost, const Pack& more) {
    const Pack all = more + lost, total = sum + all, part = total - sum;
    lost = (sum - (total - part)) + (all - part);
    sum = total;
}

/// Steps every member from sample to sample, each by its own steps. As soon as a lane's member has come to the last
/// sample asked for, the next takes its place.
template <int N>
class SteppedLanes final : public TaylorLanes {
public:
    explicit SteppedLanes(const TaylorBatchRequest& request)
        : request_(request), members_(request.members), series_{AngleChain<Pack, N>(numbers_), request.order, {}} {
        for (std::size_t i = 0; i < request.members; ++i) {
            auto& member = members_[i];
            double reach = 0;
            for (int j = 0; j < N; ++j) {
                const std::size_t at = static_cast<std::size_t>(j) * request.members + i;
                member.mass[j] = request.mass[at];
                member.length[j] = request.length[at];
                member.base[j] = request.angle[at];
                member.base[N + j] = request.rate[at];
                reach += request.length[at];
            }
            member.gravity = request.gravity[i];
            member.longest = longest_chain_step(reach, member.gravity);
        }
    }

    void compute(long first, long count, double* states) override {
        first_ = first;
        end_ = static_cast<double>(first + count);
        states_ = states;
        next_ = 0;
        busy_ = 0;
        for (int lane = 0; lane < Pack::width; ++lane) load(lane);
        while (busy_ > 0) step();
    }

private:
    static constexpr std::size_t none = ~std::size_t(0);
    static constexpr double growth = 2, least_step = 1e-12;  // least: s, with less nothing moves on

    /// What is known of a member at the start of a step.
    struct Member {
        double mass[N]{}, length[N]{}, gravity = 0, longest = 0;  // longest: s, of a step
        double base[2 * N]{}, lost[2 * N]{};                      // angles and rates, and what rounding took from them
        double time = 0, time_lost = 0;                           // s
        double before = 0;                                        // the step before, s; 0: none
    };

    [[gnu::always_inline]] void step() {
        using Half = typename LanesOfSeries<Pack, N>::Half;
        Half angle, rate;
        for (int i = 0; i < N; ++i) {
            angle[i] = base_[i];
            rate[i] = base_[N + i];
        }
        series_.expand(angle, rate);
        const Pack limit = select(before_ > Pack(0), before_ * Pack(growth), longest_);
        const Pack h =
            lesser(lesser(longest_, limit), series_.step(request_.tolerance));  // a number even if that is none
        write_samples(h);

        series_.move(h, angle, rate);
        Pack moved[2 * N], lost[2 * N], time = time_, time_lost = time_lost_;
        for (int i = 0; i < 2 * N; ++i) {
            moved[i] = base_[i];
            lost[i] = lost_[i];
            add(moved[i], lost[i], i < N ? angle[i] : rate[i - N]);
        }
        add(time, time_lost, h);
        // where the motion has broken down, it goes on as no number
        const auto breaks = h <= Pack(least_step);
        for (auto& number : moved) number = select(breaks, Pack(NAN), number);
        const Pack on = select(breaks, longest_, h);
        const auto is_done = Pack(end_) <= sample_;
        for (int i = 0; i < 2 * N; ++i) {
            base_[i] = select(is_done, base_[i], moved[i]);
            lost_[i] = select(is_done, lost_[i], lost[i]);
        }
        time_ = select(is_done, time_, time);
        time_lost_ = select(is_done, time_lost_, time_lost);
        before_ = select(is_done, before_, on);
        for (int lane = 0; lane < Pack::width; ++lane)
            if (sample_[lane] >= end_) {
                save(lane);
                load(lane);
            }
    }

    /// Those that lie on the step of length h.
    [[gnu::always_inline]] void write_samples(const Pack& h) {
        constexpr double never = std::numeric_limits<double>::infinity();
        for (;;) {
            const Pack since = (sample_ * Pack(request_.interval) - time_) - time_lost_;
            const Pack t = select(sample_ < Pack(end_), since, Pack(never));
            if (all_of(h < t)) return;
            const auto is_on_step = t <= h;
            typename LanesOfSeries<Pack, N>::Half angle, rate;
            series_.move(select(is_on_step, t, h), angle, rate);
            for (int i = 0; i < N; ++i) {
                angle[i] = base_[i] + (angle[i] + lost_[i]);
                rate[i] = base_[N + i] + (rate[i] + lost_[N + i]);
            }
            for (int lane = 0; lane < Pack::width; ++lane) {
                if (!(t[lane] <= h[lane])) continue;
                const auto row = static_cast<std::size_t>(static_cast<long>(sample_[lane]) - first_);
                double* to = states_ + (row * request_.members + trial_[lane]) * 2 * N;
                for (int i = 0; i < N; ++i) {
                    to[i] = angle[i][lane];
                    to[N + i] = rate[i][lane];
                }
            }
            sample_ += select(is_on_step, Pack(1), Pack(0));
        }
    }

    void save(int lane) {
        if (trial_[lane] == none) return;
        --busy_;
        auto& member = members_[trial_[lane]];
        for (int i = 0; i < 2 * N; ++i) {
            member.base[i] = base_[i][lane];
            member.lost[i] = lost_[i][lane];
        }
        member.time = time_[lane];
        member.time_lost = time_lost_[lane];
        member.before = before_[lane];
        trial_[lane] = none;
    }

    /// The next member; where there is none, the lane computes the last one again, for nothing.
    void load(int lane) {
        const bool is_left = next_ < request_.members;
        const auto& member = members_[is_left ? next_ : request_.members - 1];
        trial_[lane] = is_left ? next_ : none;
        next_ += is_left;
        busy_ += is_left;
        sample_.set(lane, is_left ? static_cast<double>(first_) : end_);
        for (int j = 0; j < N; ++j) {
            numbers_.mass[static_cast<std::size_t>(j)].set(lane, member.mass[j]);
            numbers_.length[static_cast<std::size_t>(j)].set(lane, member.length[j]);
        }
        numbers_.gravity.set(lane, member.gravity);
        series_.chain = AngleChain<Pack, N>(numbers_);
        longest_.set(lane, member.longest);
        for (int i = 0; i < 2 * N; ++i) {
            base_[i].set(lane, member.base[i]);
            lost_[i].set(lane, member.lost[i]);
        }
        time_.set(lane, member.time);
        time_lost_.set(lane, member.time_lost);
        before_.set(lane, member.before);
    }

    static Pendulum<Pack> one_each() {
        Pendulum<Pack> all;
        for (auto* numbers : {&all.mass, &all.length, &all.angle, &all.rate}) numbers->assign(N, Pack(1));
        all.gravity = Pack(1);
        return all;
    }

    TaylorBatchRequest request_;
    std::vector<Member> members_;
    Pendulum<Pack> numbers_ = one_each();
    LanesOfSeries<Pack, N> series_;
    // of the members in the lanes, as in Member
    Pack base_[2 * N], lost_[2 * N], time_, time_lost_, before_, longest_;
    Pack sample_;  // the next to be written
    std::size_t trial_[Pack::width];
    // of one compute()
    double* states_ = nullptr;
    long first_ = 0;
    double end_ = 0;
    std::size_t next_ = 0;
    int busy_ = 0;
};

}  // namespace

template <>
TaylorLanes* make_taylor_lanes<compiled_width>(const TaylorBatchRequest& request) {
    if (request.links == 2) return new SteppedLanes<2>(request);
    return new SteppedLanes<3>(request);
}

}  // namespace doppel
