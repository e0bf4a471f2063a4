#pragma once

#include "numeric/sin_cos.hpp"
#include "numeric/solvers.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <memory_resource>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace doppel {

/// Σ a b
template <class Scalar>
class SumOfProducts {
public:
    void add(const Scalar& a, const Scalar& b) { sum_ += a * b; }
    const Scalar& value() const { return sum_; }

private:
    Scalar sum_ = Scalar(0);
};

/// The operations that computed a function at one point, in order and without repetitions. They give the Taylor series
/// of its results from those of its arguments, order by order. Comparisons are recorded as well: the recording is valid
/// until the difference of the compared numbers changes its sign.
/// Source  Griewank & Walther, Evaluating Derivatives, §13.2; Jorba & Zou 2005, Experimental Mathematics 14:99, §2.
template <class S>
class Tape {
public:
    using Scalar = S;

    /// For series up to that order.
    explicit Tape(int order) : terms_(static_cast<std::size_t>(order) + 1) {
        for (int k = 0; k <= order; ++k) inverse_.push_back(Scalar(1) / Scalar(std::max(k, 1)));
    }

    void clear() {
        nodes_.clear();
        events_.clear();
        systems_.clear();
    }
    /// Ends the recording and allocates the series.
    void finish() {
        coefficients_.assign(nodes_.size() * terms_, Scalar(0));
        known_.clear();
    }
    bool empty() const { return nodes_.empty(); }

    Scalar& term(int node, int k) {
        return coefficients_[static_cast<std::size_t>(node) * terms_ + static_cast<std::size_t>(k)];
    }
    const Scalar* series(int node) const { return &coefficients_[static_cast<std::size_t>(node) * terms_]; }
    /// A node whose sign was compared in the recording. If it was compared for equality, the function may jump where it
    /// vanishes.
    struct Event {
        int node, sign;
        bool may_jump;
    };
    const std::vector<Event>& events() const { return events_; }
    /// Whether the recording is valid for the arguments of the last compute(0).
    bool is_as_recorded() const {
        return std::all_of(events_.begin(), events_.end(),
                           [&](const Event& event) { return sign_of(*series(event.node)) == event.sign; });
    }

    enum class Operation : unsigned char {
        argument,
        sum,
        difference,
        product,
        ratio,
        root,
        sine,
        cosine,
        size,
        norm,
        unknown
    };
    /// The operands of a node; −1 stands for the constant. For an unknown, its system and row.
    struct Node {
        Operation operation;
        int a = -1, b = -1;
        Scalar constant = Scalar(0);
    };

    const std::vector<Node>& nodes() const { return nodes_; }
    /// Adds the node of an operation, or finds an earlier equal one.
    int add(Operation operation, int a = -1, int b = -1, const Scalar& constant = Scalar(0)) {
        const auto next = static_cast<int>(nodes_.size());
        if (operation == Operation::product && a > b && b >= 0) std::swap(a, b);
        if (operation != Operation::argument) {
            const auto [place, is_new] = known_.try_emplace({operation, a, b, constant}, next);
            if (!is_new) return place->second;
        }
        nodes_.push_back({operation, a, b, constant});
        return next;
    }
    /// A x = b, with unknowns x_k from A_0 x_k = b_k − Σ_{j=1}^k A_j x_{k−j}: the same matrix for all orders.
    struct LinearSystem {
        struct Entry {
            Eigen::Index row, column;
            int node;  // −1 for a constant
            Scalar constant;
        };
        std::vector<Entry> entries;       // of A
        std::vector<Entry> right;         // b, in column 0
        EnvelopeMatrix<Scalar> matrix;    // A_0, factored
        State<Scalar, Eigen::Dynamic> x;  // x_k
        int first = 0;                    // first node of the unknowns, which are consecutive
    };
    LinearSystem& add(LinearSystem system) {
        const auto number = static_cast<int>(systems_.size());
        system.first = static_cast<int>(nodes_.size());
        for (int row = 0; row < system.matrix.rows(); ++row) add(Operation::unknown, number, row);
        return systems_.emplace_back(std::move(system));
    }
    /// `now` is its current value.
    void note_event(int node, const Scalar& now, bool may_jump = false) {
        if (events_.empty() || events_.back().node != node) events_.push_back({node, sign_of(now), may_jump});
    }

    /// Computes coefficient k of every node that is no argument, from those of the arguments up to k and all earlier
    /// ones.
    void compute(int k) {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            if (nodes_[i].operation == Operation::argument) continue;
            const int node = static_cast<int>(i);
            const Scalar value = coefficient(nodes_[i], node, k);
            term(node, k) = value;
        }
    }

private:
    static int sign_of(const Scalar& x) { return x > Scalar(0) ? 1 : x < Scalar(0) ? -1 : 0; }

    Scalar operand(int node, const Scalar& constant, int k) {
        return node >= 0 ? term(node, k) : k == 0 ? constant : Scalar(0);
    }
    /// Σ_{j=first}^{last} a_j b_{k−j}
    Scalar convolution(int a, int b, int k, int first, int last) const {
        const Scalar *x = series(a), *y = series(b);
        SumOfProducts<Scalar> sum;
        for (int j = first; j <= last; ++j) sum.add(x[j], y[k - j]);
        return sum.value();
    }
    /// Σ_{j=first}^{k−first} a_j a_{k−j}
    Scalar square(int a, int k, int first) const {
        const Scalar half = convolution(a, a, k, first, (k + 1) / 2 - 1), sum = half + half;
        return k % 2 == 0 && k >= 2 * first ? Scalar(sum + series(a)[k / 2] * series(a)[k / 2]) : sum;
    }
    /// Σ_{j=1}^k j/k a_j b_{k−j}
    Scalar slope(int a, int b, int k) const {
        const Scalar *x = series(a), *y = series(b);
        Scalar sum(0);
        for (int j = 1; j <= k; ++j) sum += Scalar(j) * x[j] * y[k - j];
        return sum * inverse_[static_cast<std::size_t>(k)];
    }

    Scalar coefficient(const Node& node, int self, int k) {
        const auto& [operation, a, b, constant] = node;
        switch (operation) {
            case Operation::argument:
                break;
            case Operation::sum:
                return operand(a, constant, k) + operand(b, constant, k);
            case Operation::difference:
                return operand(a, constant, k) - operand(b, constant, k);
            case Operation::product:
                if (a < 0) return constant * term(b, k);
                if (b < 0) return term(a, k) * constant;
                return a == b ? square(a, k, 0) : convolution(a, b, k, 0, k);
            case Operation::ratio: {
                if (b < 0) return term(a, k) / constant;
                const Scalar sum = operand(a, constant, k) - convolution(b, self, k, 1, k);
                return sum / term(b, 0);
            }
            case Operation::root: {
                using std::sqrt;
                if (k == 0) return sqrt(term(a, 0));
                const Scalar rest = term(a, k) - square(self, k, 1);
                return rest / (Scalar(2) * term(self, 0));
            }
            case Operation::sine:  // its cosine is the next node
                return k == 0 ? SinCos<Scalar>(term(a, 0)).sin : slope(a, self + 1, k);
            case Operation::cosine:
                return k == 0 ? SinCos<Scalar>(term(a, 0)).cos : Scalar(-slope(a, self - 1, k));
            case Operation::size: {
                const Scalar sign = series(a)[first_term(a, k)] < Scalar(0) ? Scalar(-1) : Scalar(1);
                return sign * term(a, k);
            }
            case Operation::norm:
                return norm(a, b, self, k);
            case Operation::unknown:
                if constexpr (std::numeric_limits<Scalar>::is_specialized)  // balls solve no systems
                    if (b == 0) solve(systems_[static_cast<std::size_t>(a)], k);
                return systems_[static_cast<std::size_t>(a)].x[b];
        }
        return Scalar(0);
    }
    void solve(LinearSystem& system, int k) {
        auto& [entries, right, matrix, x, first] = system;
        if (k == 0) {
            matrix.clear();
            for (const auto& entry : entries) matrix(entry.row, entry.column) = operand(entry.node, entry.constant, 0);
            matrix.factor();
        }
        for (const auto& entry : right) x[entry.row] = operand(entry.node, entry.constant, k);
        if (k > 0)
            for (const auto& entry : entries)
                if (entry.node >= 0)
                    x[entry.row] -= convolution(entry.node, first + static_cast<int>(entry.column), k, 1, k);
        matrix.solve(x);
    }
    /// The first nonzero one of the terms up to k; k if all are zero.
    int first_term(int node, int k) const {
        int first = 0;
        while (first < k && series(node)[first] == Scalar(0)) ++first;
        return first;
    }
    /// c = √(a² + b²). If all terms start from 0, c² starts with t², and c_k still follows from a and b up to k.
    Scalar norm(int a, int b, int self, int k) const {
        using std::sqrt;
        const auto squares = [&](int order) {
            const int first = order > k ? 1 : 0;
            return Scalar(square(a, order, first) + square(b, order, first));
        };
        const Scalar* c = series(self);
        if (k == 0) return sqrt(squares(0));
        if (c[0] != Scalar(0)) return (squares(k) - square(self, k, 1)) / (Scalar(2) * c[0]);
        if (k == 1) return sqrt(squares(2));
        return c[1] == Scalar(0) ? c[1] : (squares(k + 1) - square(self, k + 1, 2)) / (Scalar(2) * c[1]);
    }

    std::size_t terms_;
    std::vector<Node> nodes_;
    std::vector<Event> events_;
    std::vector<LinearSystem> systems_;
    std::pmr::unsynchronized_pool_resource memory_;  // of known_, kept for the next recording
    std::pmr::map<std::tuple<Operation, int, int, Scalar>, int> known_{&memory_};  // during recording
    std::vector<Scalar> coefficients_, inverse_;
};

/// A number whose operations are recorded on a tape. One without a tape is a constant. All bytes 0 represent the
/// constant 0, which Eigen 5 requires.
template <class S>
class Taped {
public:
    using Scalar = S;
    using Operation = typename Tape<Scalar>::Operation;

    Scalar value;

    Taped() : Taped(Scalar(0)) {}
    Taped(const Scalar& constant) : value(constant) {}
    template <class Number>
    requires(std::is_arithmetic_v<Number> && !std::is_same_v<Number, Scalar>) Taped(Number constant)
        : value(Scalar(constant)) {}
    Taped(const Scalar& now, Tape<Scalar>& tape, int node) : value(now), tape_(&tape), next_(node + 1) {}

    static Taped argument(const Scalar& now, Tape<Scalar>& tape) { return {now, tape, tape.add(Operation::argument)}; }

    /// −1 for a constant.
    int node() const { return next_ - 1; }

    friend Taped operator+(const Taped& a, const Taped& b) {
        if (a.is_constant(0)) return b;
        if (b.is_constant(0)) return a;
        return of(Operation::sum, a.value + b.value, a, b);
    }
    friend Taped operator-(const Taped& a, const Taped& b) {
        if (b.is_constant(0)) return a;
        return of(Operation::difference, a.value - b.value, a, b);
    }
    friend Taped operator*(const Taped& a, const Taped& b) {
        if (a.is_constant(1)) return b;
        if (b.is_constant(1)) return a;
        return of(Operation::product, a.value * b.value, a, b);
    }
    friend Taped operator/(const Taped& a, const Taped& b) { return of(Operation::ratio, a.value / b.value, a, b); }
    friend Taped operator+(const Taped& a) { return a; }
    friend Taped operator-(const Taped& a) { return Taped(Scalar(0)) - a; }
    Taped& operator+=(const Taped& b) { return *this = *this + b; }
    Taped& operator-=(const Taped& b) { return *this = *this - b; }
    Taped& operator*=(const Taped& b) { return *this = *this * b; }
    Taped& operator/=(const Taped& b) { return *this = *this / b; }

    friend Taped sqrt(const Taped& a) {
        using std::sqrt;
        const Scalar root = sqrt(a.value);
        return a.tape_ ? Taped(root, *a.tape_, a.tape_->add(Operation::root, a.node())) : Taped(root);
    }
    /// Valid until the sign of a changes.
    friend Taped abs(const Taped& a) {
        using std::abs;
        if (!a.tape_) return Taped(Scalar(abs(a.value)));
        const Taped size(abs(a.value), *a.tape_, a.tape_->add(Operation::size, a.node()));
        a.tape_->note_event(size.node(), size.value);
        return size;
    }
    /// √(a² + b²), valid until it vanishes; a and b must not both be constant.
    friend Taped norm(const Taped& a, const Taped& b) {
        using std::sqrt;
        const Taped size(sqrt(Scalar(a.value * a.value + b.value * b.value)), *a.tape_,
                         a.tape_->add(Operation::norm, a.node(), b.node()));
        a.tape_->note_event(size.node(), size.value);
        return size;
    }

    friend bool operator<(const Taped& a, const Taped& b) { return noted(a, b), a.value < b.value; }
    friend bool operator<=(const Taped& a, const Taped& b) { return noted(a, b), a.value <= b.value; }
    friend bool operator>(const Taped& a, const Taped& b) { return noted(a, b), a.value > b.value; }
    friend bool operator>=(const Taped& a, const Taped& b) { return noted(a, b), a.value >= b.value; }
    friend bool operator==(const Taped& a, const Taped& b) { return noted(a, b, true), a.value == b.value; }

    Tape<Scalar>* tape() const { return tape_; }

private:
    bool is_constant(int number) const { return !tape_ && value == Scalar(number); }
    static Taped of(Operation operation, const Scalar& now, const Taped& a, const Taped& b) {
        auto* tape = a.tape_ ? a.tape_ : b.tape_;
        if (!tape) return Taped(now);
        return {now, *tape, tape->add(operation, a.node(), b.node(), a.tape_ ? b.value : a.value)};
    }
    static void noted(const Taped& a, const Taped& b, bool may_jump = false) {
        if (!a.tape_ && !b.tape_) return;
        const auto difference = a - b;
        difference.tape_->note_event(difference.node(), difference.value, may_jump);
    }

    Tape<Scalar>* tape_ = nullptr;
    int next_ = 0;  // number of its node + 1; 0 for a constant
};

/// Records A x = b as a whole, unless all numbers are constant.
template <class S>
void solve_factored(EnvelopeMatrix<Taped<S>>& a, State<Taped<S>, Eigen::Dynamic>& x) {
    if (a.rows() == 0) return;
    std::vector<Eigen::Index> begin;
    for (Eigen::Index i = 0; i < a.rows(); ++i) begin.push_back(a.begin(i));
    typename Tape<S>::LinearSystem system{{}, {}, EnvelopeMatrix<S>(begin), State<S, Eigen::Dynamic>(a.rows())};
    Tape<S>* tape = nullptr;
    const auto note = [&](auto& list, Eigen::Index row, Eigen::Index column, const Taped<S>& what) {
        list.push_back({row, column, what.node(), what.value});
        if (what.tape()) tape = what.tape();
    };
    const auto note_entry = [&](Eigen::Index row, Eigen::Index column) {
        note(system.entries, row, column, a(row, column));
        system.matrix(row, column) = a(row, column).value;
    };
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        for (Eigen::Index j = a.begin(i); j < i; ++j) {
            note_entry(i, j);
            note_entry(j, i);
        }
        note_entry(i, i);
        note(system.right, i, 0, x[i]);
        system.x[i] = x[i].value;
    }
    system.matrix.factor();
    system.matrix.solve(system.x);
    for (Eigen::Index i = 0; i < a.rows(); ++i) x[i] = Taped<S>(system.x[i]);
    if (!tape) return;
    const auto& noted = tape->add(std::move(system));
    for (Eigen::Index i = 0; i < a.rows(); ++i) x[i] = Taped<S>(noted.x[i], *tape, noted.first + static_cast<int>(i));
}

template <class S>
struct SinCos<Taped<S>> {
    Taped<S> sin, cos;

    explicit SinCos(const Taped<S>& angle) {
        using Operation = typename Tape<S>::Operation;
        const SinCos<S> now(angle.value);
        sin = Taped<S>(now.sin);
        cos = Taped<S>(now.cos);
        if (auto* tape = angle.tape()) {
            const int node = tape->add(Operation::sine, angle.node());
            tape->add(Operation::cosine, angle.node());
            sin = Taped<S>(now.sin, *tape, node);
            cos = Taped<S>(now.cos, *tape, node + 1);
        }
    }
};

}  // namespace doppel

/// Range and precision are those of its value.
template <class S>
struct std::numeric_limits<doppel::Taped<S>> : std::numeric_limits<S> {};

template <class S>
struct Eigen::NumTraits<doppel::Taped<S>> : Eigen::GenericNumTraits<doppel::Taped<S>> {
    enum { ReadCost = 3, AddCost = 20, MulCost = 20 };
};
