// The whole idea of Doppel in one file: two double pendulums, released three thousandths of a degree apart, are integrated
// side by side, their distance is printed, and the moment they diverge becomes a picture.
//
//     build/release/tests/example pair.png
//
// The suite builds and runs it. It uses the libraries below src as the program does.
#include "analysis/difference.hpp"
#include "base/error.hpp"
#include "image/color.hpp"
#include "integrate/motion.hpp"
#include "output/png.hpp"
#include "render/renderer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <vector>

namespace {

using namespace doppel;

constexpr double duration = 20;  // s

/// Two links of 1 m and 1 kg, released at rest; `angle` is that of the first link, degrees. All numbers are quads: in the text
/// of a preset 90.003 is exactly 90003/1000.
MotionSpec release(const Quad& angle) {
    const Quad degree = pi_of<Quad>() / 180;
    MotionSpec spec;
    spec.chain = Pendulum<Quad>{.angle = {angle * degree, 90 * degree}};
    spec.method = "taylor";
    spec.tolerance = Quad(1) / Quad(1'000'000'000'000);
    spec.sample_interval = Rational{1, 120};  // s
    return spec;
}

/// Where the last mass of each pendulum has been; m.
struct Trail {
    std::vector<Point> points;

    void add(const Bobs<double>& bobs) {
        points.push_back({static_cast<float>(bobs.back().x), static_cast<float>(bobs.back().y)});
    }
};

/// Metres to pixels: the pivot is in the middle of a panel.
struct View {
    Point pivot;
    float px_per_m;

    Point at(float x, float y) const { return {pivot.x + px_per_m * x, pivot.y - px_per_m * y}; }
};

/// One pendulum in its panel: the trail of the last second, the links, the masses. Items are drawn back to front.
void draw(const Bobs<double>& bobs, const Trail& trail, const View& view, Color color, const Theme& theme,
          DisplayList& list) {
    Stroke path{.width = 3, .color = color};
    const std::size_t kept = std::min<std::size_t>(trail.points.size(), 120);
    for (std::size_t i = trail.points.size() - kept; i < trail.points.size(); ++i) {
        const auto age = static_cast<float>(trail.points.size() - i) / 120;
        path.vertices.push_back({.at = view.at(trail.points[i].x, trail.points[i].y), .alpha = 1 - age});
    }
    list.push_back(path);

    Point above = view.pivot;
    for (const auto& bob : bobs) {
        const Point end = view.at(static_cast<float>(bob.x), static_cast<float>(bob.y));
        list.push_back(Capsule{.from = above, .to = end, .radius = 2, .color = theme.rod});
        above = end;
    }
    for (const auto& bob : bobs) {
        const Point center = view.at(static_cast<float>(bob.x), static_cast<float>(bob.y));
        list.push_back(Capsule{.from = center, .to = center, .radius = 10, .color = color});
    }
}

void run(const char* file) {
    const std::array motions{make_motion(release(90)), make_motion(release(Quad(90'003) / 1000))};
    std::array<Trail, 2> trails;
    Divergence parting;  // when the distance becomes 1 and stays there
    const std::atomic<bool> stop = false;

    // the outer loop: samples; advance() is the inner loop, of steps
    std::array<Bobs<double>, 2> bobs;
    for (int sample = 0; sample <= 120 * duration; ++sample) {
        for (std::size_t side = 0; side < 2; ++side) {
            if (sample > 0) motions[side]->advance(stop);
            bobs[side] = motions[side]->observe().bobs;
            trails[side].add(bobs[side]);
        }
        const double time = sample / 120.0;
        const double distance = state_space_distance(bobs[0], bobs[1]);
        parting.add(time, distance);
        if (sample % 120 == 0) fmt::print("{:4.0f} s   distance {:.3g}\n", time, distance);
        if (parting.since()) break;
    }

    // the picture: the same scene, drawn without a display
    const Size size{960, 540};
    const Theme& theme = themes[0];
    DisplayList list{filled(size, theme.background)};
    for (std::size_t side = 0; side < 2; ++side) {
        const View view{.pivot = {side == 0 ? 250.0f : 710.0f, 280}, .px_per_m = 105};
        draw(bobs[side], trails[side], view, theme.sides[side], theme, list);
        list.push_back(
            label(side == 0 ? "90°, 90°" : "90.003°, 90°", {view.pivot.x, 40}, 22, theme.sides[side], Align::center));
    }
    if (parting.since())
        list.push_back(
            label(fmt::format("diverged at {:.1f} s", *parting.since()), {480, 520}, 22, theme.text, Align::center));
    Renderer renderer(size);
    write_png(file, renderer.draw(list));
}

}  // namespace

int main(int argc, char** argv) {
    try {
        if (argc != 2) throw bad_input("usage: example FILE.png");
        run(argv[1]);
        return 0;
    } catch (const Error& error) {
        fmt::print(stderr, "example: {}\n", error.what());
        return static_cast<int>(error.code());
    }
}
