#pragma once

#include "film/layout.hpp"
#include "film/recording.hpp"

#include <deque>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A path that fades and narrows with age.
class Trail {
public:
    /// The path is interrupted between points more than `jump` px apart horizontally.
    Trail(const Scene& scene, const Style& style, Color color, float width,
          float jump = std::numeric_limits<float>::infinity());

    std::optional<Point> end() const;
    /// Adds a point that was reached at `time`, s. Points that have faded out at `now` are removed.
    void add(Point at, double time, double now);

    /// Draws the path up to the head, if there is one, all moved by `shift`. It is interrupted outside the area.
    void draw(const Area& area, double now, std::optional<Point> head, DisplayList& list, Point shift = {}) const;

private:
    struct TrailPoint {
        Stroke::Vertex vertex;  // without opacity, width and glow
        double time;            // s
        long group;             // number of the group of points that fade together
        bool starts = false;    // the path is interrupted before it
    };
    using Points = std::deque<TrailPoint>;

    void simplify(Points& points) const;
    double end_of(long group) const;
    double faded_until(long group, double now) const;

    double sample_hz_, trail_s_;
    float jump_;
    Stroke pen_;  // stroke without vertices
    Points points_;
};

/// The data for all layers: the scene, the layout, and the state of the pair.
struct FilmState {
    const Scene& scene;
    const Layout layout;
    Snapshot snapshot{};  // added last
    Outcome outcome{};

    double time() const { return scene.time(snapshot.pair.moment()); }
    /// Between two samples: curves and trails contain only samples, and are drawn on to the snapshot.
    bool is_between() const { return snapshot.pair.share > 0; }
    const Observation& seen(const Side& side) const { return &side == &scene.a ? snapshot.pair.a : snapshot.pair.b; }
    const Bobs<double>& bobs(std::size_t pendulum) const {
        if (!snapshot.members.empty()) return snapshot.members[pendulum];
        return (pendulum == 0 ? snapshot.pair.a : snapshot.pair.b).bobs;
    }
};

/// A part of a film's picture. It depends only on the scene and on the snapshots up to now.
class Layer {
public:
    explicit Layer(const FilmState& state) : state_(state) {}
    virtual ~Layer() = default;

    /// What marks the limits of the motion, below the backdrop.
    virtual void marks(DisplayList& /*list*/) const {}
    virtual void backdrop(DisplayList& list) const = 0;
    /// Adds the state's snapshot, which is the next sample from 0 on.
    virtual void add() {}
    /// Draws the last snapshot over the backdrop.
    virtual void frame(DisplayList& list) const = 0;
    /// Texts that frame() does not draw for lack of space.
    virtual std::vector<std::string> left_out() const { return {}; }

protected:
    using Edge = AxisStyle::Edge;
    /// In the film's sizes and colours; `style` has the rest.
    void add_axis(const Axis& axis, const Area& area, const Area& within, AxisStyle style, DisplayList& list,
                  std::optional<double> every = {}) const {
        style.em = px(style_.font.axis);
        style.line = px(style_.width.grid);
        style.grid = theme_.grid;
        style.frame = theme_.frame;
        style.text = theme_.quiet_text;
        const auto ticks = spaced_ticks(axis, style.edge == Edge::bottom, style.em, every);
        std::ranges::move(axis_items(axis, ticks, area, within, style), std::back_inserter(list));
    }

    const FilmState& state_;
    const VideoSpec& video_ = state_.scene.preset.video;
    const Layout& layout_ = state_.layout;
    const Style& style_ = layout_.style;
    const Theme& theme_ = style_.theme;
};

// `state` must outlive the layers.

/// The pendulums of a panel and their trails.
std::unique_ptr<Layer> make_pendulum_layer(const FilmState& state, const PendulumPanel& panel);
/// A strip, with its curves and marks.
std::unique_ptr<Layer> make_strip_layer(const FilmState& state, const StripLayout& strip);
/// The texts of a strip's marks with this outcome.
DisplayList placed_marks(const FilmState& state, const Outcome& outcome, const StripLayout& strip);
/// Of the panels of pendulums, the phase portrait and the strips, from back to front.
std::vector<std::unique_ptr<Layer>> layers_of(const FilmState& state);

}  // namespace doppel
