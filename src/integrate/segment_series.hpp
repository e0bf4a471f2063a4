#pragma once

#include "physics/pendulum.hpp"

#include <array>
#include <cstddef>
#include <memory>

namespace doppel {

/// AngleSeries for chains of double of any length, cut into eight segments that are computed side by side: link
/// i = b + blocks · lane stands in lane `lane` of block b, and blocks follow each other along each segment. So even what
/// goes from link to link, the elimination of the tensions, is done for eight links at once. Bit for bit the same
/// whatever number of doubles a register holds.
///
/// Elimination of the segments  all but the last link of each in lanes, then the eight last links by the inverse of the
/// 8×8 matrix that is left of theirs.
/// Source  Wang 1981, A parallel method for tridiagonal equations, ACM Trans. Math. Software 7:170.
class SegmentSeries {
public:
    static constexpr int lanes = 8;

    /// `width` doubles to a register; 0: the widest that this processor has.
    SegmentSeries(const Pendulum<double>& p, int order, int width = 0);

    template <class State>
    void expand(const State& y) {
        expand_about(y.data());
    }
    template <class State>
    void move(double h, State& change) const {
        move_by(h, change.data());
    }
    double size(int k) const { return amount_ == 0 ? 0 : greatest_[static_cast<std::size_t>(k)] / amount_; }
    double longest_step() const { return longest_step_; }

    struct alignas(64) Row {
        double of[lanes];
    };
    /// Of the links of a block, during a step.
    struct Rod {
        Row between, both;      // 1/m_i, 0 for the last link; 1/m_{i−1} + 1/m_i
        Row length, by_length;  // m, 1/m
        Row s, c;               // sin and cos of the angle to the next rod, over m_i, 1/kg
        Row share, inverse;     // of the row above that is taken away; 1 over the pivot
        Row inverse_spike;      // what the last link of the segment above adds, over the pivot
    };
    /// Coefficients of one order in a block, in the frame of the rods at the start of the step: across and along.
    struct Term {
        Row x, y;           // r / l
        Row rate;           // ω, rad/s
        Row across, along;  // F, N
    };
    /// Sums of products for one order of a group, of what was known before the group.
    struct Sums {
        Row x, y, across;
    };
    /// Of the order that is being computed.
    struct Work {
        Row x;       // R
        Row across;  // F, as in the term
        Row along;   // what is left of the equation for it, then F
        Row sin, cos;
    };
    static constexpr int group = 4;  // orders whose sums are formed together: each coefficient is read once for all
    /// All of a series as the recurrence needs it (integrate/segment_series_width.cpp).
    struct View {
        int links, blocks, order;
        double gravity;
        Rod* rods;
        Term* terms;  // block by block, in each order by order; before them one of zeros
        std::array<Sums, group>* sums;
        Work* work;
        const double* inverse;  // 1/k
        double* greatest;       // |ω_k|

        Term* term(int block) const { return terms + static_cast<std::ptrdiff_t>(block) * (order + 3) + 1; }
    };
    struct Kernel {
        void (*expand)(const View&, const double* y);
        void (*move)(const View&, double h, double* change);
    };

private:
    void expand_about(const double* y);
    void move_by(double h, double* change) const;
    View view() const;

    int links_, blocks_, order_;
    double gravity_, longest_step_;  // m/s², s
    // what view() shows
    std::unique_ptr<Rod[]> rods_;
    std::unique_ptr<Term[]> terms_;
    std::unique_ptr<std::array<Sums, group>[]> sums_;
    std::unique_ptr<Work[]> work_;
    std::unique_ptr<double[]> inverse_, greatest_;
    Kernel kernel_;
    double amount_ = 0;  // of the rates, rad/s
};

/// In the code for registers of `width` doubles (cmake/widths.cmake).
template <int width>
SegmentSeries::Kernel segment_kernel();
template <>
SegmentSeries::Kernel segment_kernel<2>();
template <>
SegmentSeries::Kernel segment_kernel<4>();
template <>
SegmentSeries::Kernel segment_kernel<8>();

}  // namespace doppel
