#include "scene/distance_check.hpp"

#include <cmath>

namespace doppel {

void check_distance(const Scene& scene, const Moment& moment) {
    if (std::isfinite(moment.distance)) return;
    struct Number {
        std::string what;
        double a = 0, b = 0;
    } worst;
    for (std::size_t i = 0; i < moment.a.bobs.size(); ++i) {
        const auto &a = moment.a.bobs[i], &b = moment.b.bobs[i];
        const auto look = [&](const char* what, double of_a, double of_b) {
            if (std::abs(of_a - of_b) > std::abs(worst.a - worst.b))
                worst = {fmt::format("{} of mass {}", what, i + 1), of_a, of_b};
        };
        look("the mass, kg,", a.mass, b.mass);
        look("the place in x, m,", a.x, b.x);
        look("the place in y, m,", a.y, b.y);
        look("the velocity in x, m/s,", a.vx, b.vx);
        look("the velocity in y, m/s,", a.vy, b.vy);
    }
    const bool of_b = std::abs(worst.b) > std::abs(worst.a);
    throw Error(moment.sample == 0 ? ExitCode::bad_input : ExitCode::method_failed,
                fmt::format("{}: side {}: {} is {:.6g} at t = {} s, and {:.6g} on the other side: the square of their "
                            "difference is out of range, beyond 1.8e308",
                            scene.preset.name, of_b ? 'b' : 'a', worst.what, of_b ? worst.b : worst.a,
                            scene.time(moment.sample), of_b ? worst.a : worst.b));
}

}  // namespace doppel
