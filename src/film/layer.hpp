#pragma once

#include "film/layout.hpp"
#include "film/recording.hpp"

#include <deque>
#include <limits>
#include <memory>
#include <optional>

namespace doppel {

/// The cubic from p to q with the slopes v and w (Hermite), at the share s of the way, which takes dt.
inline double hermite(double p, double v, double q, double w, double dt, double s) {
    const double r = 1 - s;
    return (1 + 2 * s) * r * r * p + s * r * r * dt * v + s * s * (3 - 2 * s) * q - s * s * r * dt * w;
}

/// A path that fades and tapers with its age.
class Trail {
public:
    /// `width` in px.
    Trail(const Scene& scene, const Style& style, Color color, float width);
    Trail(const Scene& scene, const Style& style, std::size_t side)
        : Trail(scene, style, style.theme.sides[side], px(style.width.trail)) {}

    std::optional<Point> end() const;
    /// The path goes on to a place, where it was at `time`, s. What has faded by `now` goes.
    void add(Point at, double time, double now);

    /// Up to the head, where there is one; broken where it leaves the area, or where a point is NaN, and between
    /// points more than `jump` px apart across. All is moved by `shift`.
    void draw(const Area& area, double now, std::optional<Point> head, DisplayList& list,
              float jump = std::numeric_limits<float>::infinity(), Point shift = {}) const;

private:
    struct TrailPoint {
        Point at;
        double time;         // s
        long group;          // of points that fade together
        float bend = 0;      // px, of the way to the next one
        bool joint = false;  // this one stays
    };
    using Points = std::deque<TrailPoint>;

    void simplify(Points& points) const;
    double end_of(long group) const;
    double faded_until(long group, double now) const;
    void draw_piece(Points points, const Area& area, double now, Point shift, DisplayList& list) const;

    double sample_hz_, trail_s_;
    Stroke pen_;  // without a path
    Points points_;
};

/// What the layers of a film's picture draw: the scene, where everything goes, and what came of the pair so far.
struct FilmState {
    const Scene& scene;
    const Layout layout;
    Snapshot snapshot{};  // added last
    Outcome outcome{};

    double time() const { return scene.time(snapshot.pair.moment()); }
    /// Whether the snapshot is between two samples: traces and trails end at the last sample, and are drawn up to it.
    bool is_between() const { return snapshot.pair.share > 0; }
    const Side& side(std::size_t k) const { return k == 0 ? scene.a : scene.b; }
    const Observation& seen(std::size_t side) const { return side == 0 ? snapshot.pair.a : snapshot.pair.b; }
};

/// A part of a film's picture. What it draws depends on the scene and on the snapshots so far, and on nothing else.
class Layer {
public:
    explicit Layer(const FilmState& state) : state_(state) {}
    virtual ~Layer() = default;

    /// What never changes.
    virtual void backdrop(DisplayList& list) const = 0;
    /// The next sample, from 0 on, is that of the state.
    virtual void add() {}
    /// What lies on the backdrop at the snapshot added last.
    virtual void frame(DisplayList& list) const = 0;

protected:
    /// How the axes of its chart look.
    AxisLook axis_look() const {
        return {.edge = AxisLook::Edge::bottom,
                .em = px(style_.font.axis),
                .line = px(style_.width.grid),
                .grid = theme_.grid,
                .frame = theme_.frame,
                .text = theme_.quiet_text,
                .unit = {}};
    }

    const FilmState& state_;
    const Layout& layout_ = state_.layout;
    const Style& style_ = layout_.style;
    const Theme& theme_ = style_.theme;
};

// `state` outlives the layers.

/// The pendulums of a panel and their trails.
std::unique_ptr<Layer> make_pendulum_layer(const FilmState& state, const PendulumPanel& panel);
/// The panel of phase space.
std::unique_ptr<Layer> make_phase_layer(const FilmState& state, const PhasePanel& panel);
/// A strip of the chart below, by its number from the top.
std::unique_ptr<Layer> make_strip_layer(const FilmState& state, std::size_t index);

}  // namespace doppel
