#pragma once

#include "integrate/adaptive.hpp"

namespace doppel {

/// Dormand & Prince 1980, order 5(4), with the interpolation of order 4 by Shampine.
/// Source  Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I, table II.5.2 and §II.6 (contd5).
struct Dopri5 {
    static constexpr Method method{"dopri5", "Dormand–Prince 5(4)", 5, true, "explicit"};
    static constexpr EmbeddedPair<Fraction, 6, 7, 1, 1> pair{
        .a = {{{},
               {{{1, 5}}},
               {{{3, 40}, {9, 40}}},
               {{{44, 45}, {-56, 15}, {32, 9}}},
               {{{19372, 6561}, {-25360, 2187}, {64448, 6561}, {-212, 729}}},
               {{{9017, 3168}, {-355, 33}, {46732, 5247}, {49, 176}, {-5103, 18656}}},
               {{{35, 384}, {0, 1}, {500, 1113}, {125, 192}, {-2187, 6784}, {11, 84}}}}},
        .error = {{{{{71, 57600}, {0, 1}, {-71, 16695}, {71, 1920}, {-17253, 339200}, {22, 525}, {-1, 40}}}}},
        .dense = {{{{{-12715105075, 11282082432},
                     {0, 1},
                     {87487479700, 32700410799},
                     {-10690763975, 1880347072},
                     {701980252875, 199316789632},
                     {-1453857185, 822651844},
                     {69997945, 29380423}}}}},
        .control = {.exponent = 0.2 - 0.75 * 0.04, .memory = 0.04, .safety = 0.9, .shrink = 0.2, .grow = 10}};
    template <System Model>
    using Stepper = Adaptive<Model, pair, method>;
};

}  // namespace doppel
