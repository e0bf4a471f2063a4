#pragma once

#include "plot/plot.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace doppel {

/// Figures of every kind, for tests of their layout.

inline Curve curve(std::string label, int hue, double phase, std::size_t points = 300) {
    Curve made{.label = std::move(label), .hue = hue};
    for (std::size_t i = 0; i < points; ++i) {
        made.x.push_back(180.0 * static_cast<double>(i) / static_cast<double>(points - 1));
        made.y.push_back(std::sin(made.x.back() / 30 + phase) + 0.2 * hue);
    }
    return made;
}

inline Figure sweep() {
    Plot plot{.x = {.label = "release angle θ1, °", .every = 45}, .y = {.label = "Lyapunov exponent λ, 1/s"}};
    plot.right = PlotAxis{.label = "pairs parted within twenty seconds, %"};
    plot.curves = {curve("exponent", 0, 0), curve("parted", 1, 2), curve("to compare with", 2, 4)};
    plot.curves[0].uncertainty.assign(300, 0.1);
    plot.curves[1].right = true;
    plot.curves[2].quiet = plot.curves[2].dashed = true;
    plot.rules = {{Rule::Orientation::vertical, 63, "first chaos"}, {Rule::Orientation::horizontal, 0, "regular"}};
    return {.title = "Chaos sets in near 63°",
            .subtitle = "by release angle",
            .panels = {plot},
            .captions = {"Explicit Euler."}};
}

inline Figure convergence() {
    Plot plot{.x = {.label = "step, s", .logarithmic = true}, .y = {.label = "error, rad", .logarithmic = true}};
    for (int order = 1; order <= 8; ++order) {
        Curve made{
            .label = "order " + std::to_string(order), .mark = order % 2 ? Mark::both : Mark::line, .hue = order - 1};
        for (int k = 0; k < 9; ++k) {
            made.x.push_back(0.1 / (1 << k));
            made.y.push_back(std::max(std::pow(made.x.back(), order), 1e-15));
        }
        plot.curves.push_back(made);
    }
    plot.rules = {{Rule::Orientation::horizontal, 1e-15, "rounding of a double"}};
    return {.title = "Eight orders", .subtitle = "error after one second", .panels = {plot}};
}

inline Figure map(bool logarithmic) {
    Plot plot{.x = {.label = "θ1, °", .low = -180, .high = 180, .every = 45},
              .y = {.label = "θ2, °", .low = -180, .high = 180, .every = 45},
              .square = true};
    HeatMap cells{.columns = 60,
                  .rows = 60,
                  .label = "time to the first flip, s",
                  .none_label = "no flip within twenty seconds",
                  .logarithmic = logarithmic};
    for (int i = 0; i < 3600; ++i) cells.values.push_back(i % 7 ? 1 + static_cast<float>(i % 60) : std::nanf(""));
    plot.map = cells;
    Curve outline{.label = "energy for a flip", .quiet = true};
    for (int i = 0; i <= 90; ++i) {
        outline.x.push_back(100 * std::cos(i * std::numbers::pi / 45));
        outline.y.push_back(100 * std::sin(i * std::numbers::pi / 45));
    }
    plot.curves = {outline};
    return {.title = "When does it flip?",
            .panels = {plot},
            .captions = {"Grey: not within twenty seconds.", "Released at rest."}};
}

inline Figure sections(int count) {
    Figure figure{.title = "From order to chaos",
                  .subtitle = "sections at several energies, each hue an orbit of its own"};
    std::mt19937 random(3);
    for (int k = 0; k < count; ++k) {
        Plot plot{.title = "E = " + std::to_string(k) + " J",
                  .x = {.label = "θ2, rad"},
                  .y = {.label = "ω2, rad/s"},
                  .square = count != 5};
        Curve cloud{.label = "one orbit", .mark = Mark::points, .hue = k};
        for (int i = 0; i < 700; ++i) {
            cloud.x.push_back(std::normal_distribution<double>()(random));
            cloud.y.push_back(std::normal_distribution<double>()(random) * 1e-3);
        }
        plot.curves = {cloud};
        figure.panels.push_back(plot);
    }
    return figure;
}

inline Figure crowded() {
    Figure figure = convergence();
    figure.title = "A title that goes on and on until no line of any picture could ever hold all of its many words";
    figure.subtitle = std::string(300, 'm');
    figure.panels[0].y.label = "a label that is as long as a sentence, with a unit at its end, rad per second";
    figure.panels[0].right = PlotAxis{.label = "another one that is as long as the first, on the other side, J"};
    figure.panels[0].x.label = figure.panels[0].y.label + ", " + figure.panels[0].right->label;
    for (int i = 0; i < 8; ++i) figure.captions.push_back("Another paragraph that no one will read. ");
    return figure;
}

inline Figure twins() {
    Plot plot{.x = {.label = "x"}, .y = {.label = "y"}};
    for (int i = 0; i < 4; ++i)
        plot.curves.push_back({.label = "one of four alike", .x = {0, 1, 2}, .y = {0, 1, 1.5}, .hue = i});
    return {.panels = {plot}};
}

inline Figure extremes() {
    Figure figure{.title = "Ranges at the edge of the scalar"};
    for (const double size : {1e300, 1e-300, 0.0}) {
        Plot plot{.x = {.label = "x"}, .y = {.label = "y"}};
        plot.curves = {{.label = "c", .x = {1e10, 1e10 + size}, .y = {-size, size}}, {.label = "none"}};
        figure.panels.push_back(plot);
    }
    figure.panels[0].y.low = 5, figure.panels[0].y.high = -5;
    return figure;
}

inline std::vector<Figure> all_figures() {
    return {sweep(),     convergence(), map(false), map(true), sections(1), sections(3),
            sections(5), sections(6),   crowded(),  twins(),   extremes(),  {}};
}

inline PageList composed(const Figure& figure, Size size, const Theme& theme) {
    return compose(figure, size, theme).items;
}
inline Picture picture(const Figure& figure, Size size, const Theme& theme) {
    return picture_of(compose(figure, size, theme));
}

/// All items of this type in a list.
template <class T>
std::vector<T> items_of(const PageList& list) {
    std::vector<T> all;
    for (const PageItem& item : list)
        if (const auto* one = std::get_if<T>(&item)) all.push_back(*one);
    return all;
}

/// The pictures of maps in a list, or all others.
inline std::vector<Image> images_of(const PageList& list, bool maps) {
    auto all = items_of<Image>(list);
    std::erase_if(all, [&](const Image& image) { return image.within.has_value() != maps; });
    return all;
}

/// How often each text occurs in a list.
inline std::map<std::string, int> words_in(const PageList& list) {
    std::map<std::string, int> counts;
    for (const auto& label : items_of<Label>(list)) ++counts[label.text];
    return counts;
}

}  // namespace doppel
