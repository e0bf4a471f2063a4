#pragma once

#include "film/layout.hpp"
#include "film/shot.hpp"
#include "render/stroke.hpp"

#include <array>
#include <deque>
#include <optional>
#include <span>
#include <vector>

namespace doppel {

/// Turns a film's shots into display lists. The list of a shot depends on the scene and on the shots so far, and on
/// nothing else: any frame can be drawn alone.
class Composer {
public:
    /// Throws as make_layout() does.
    explicit Composer(const Scene& scene, const std::atomic<bool>& stop = false);

    /// What never changes: the page, the panels, the axes and their words.
    DisplayList backdrop() const;

    /// The next shot, in order from sample 0.
    void add(const Shot& shot);

    /// The picture of the shot added last.
    DisplayList frame() const;

    Color page_color() const { return layout_.style.theme.background; }

    /// A card over the whole picture, `opacity` 0…1: what the film is about, and what came of it so far.
    DisplayList title_card(double opacity) const;
    DisplayList end_card(double opacity) const;

private:
    struct TrailPoint {
        Point at;
        double time;         // s
        long group;          // of points that fade together
        float bend = 0;      // px, of the way to the next one
        bool joint = false;  // this one stays
    };
    using Trail = std::deque<TrailPoint>;
    /// What goes up in a strip: a line of its own for each.
    struct StripValue {
        std::optional<double> value;
        Color color;
        double width = 0;    // px
        std::string name{};  // empty where the heading says it all
    };

    const Observation& seen(std::size_t side) const { return side == 0 ? now_.moment.a : now_.moment.b; }
    const PendulumPanel& panel_of(std::size_t side) const;
    bool start_as_one() const;  // or there is no parting to speak of
    double now() const { return scene_.time(now_.moment.sample); }

    // composer.cpp: the page
    void compose_page(DisplayList& list) const;

    // composer_panel.cpp: the pendulums
    void compose_panel_backdrop(const PendulumPanel& panel, DisplayList& list) const;
    void compose_panel(const PendulumPanel& panel, DisplayList& list) const;
    bool swing_as_one(const PendulumPanel& panel) const;
    void compose_pendulum(const PendulumPanel& panel, std::size_t side, bool alone, DisplayList& list) const;
    void compose_crowd(const PendulumPanel& panel, DisplayList& list) const;
    void compose_lines(std::size_t side, const PendulumPanel& panel, const Bobs<double>& bobs, float radius,
                       Color color, DisplayList& list) const;
    void compose_tracks(std::size_t side, const PendulumPanel& panel, DisplayList& list) const;
    void compose_pivots(std::size_t side, const PendulumPanel& panel, DisplayList& list) const;
    const std::vector<MechanismLine>& lines(std::size_t side) const;
    float bob_radius(const Bob<double>& bob) const;

    // composer_trail.cpp: the path of the last bob
    void extend_trail(std::size_t side, const Bob<double>& bob, double time);
    void extend(Trail& trail, Point at, double time) const;
    void settle(Trail& trail) const;
    double end_of(long group) const;
    double faded_until(long group) const;
    void compose_trail(std::size_t side, const Area& area, std::optional<Point> head, Trail trail,
                       DisplayList& list) const;

    // composer_phase.cpp: the panel of phase space
    void compose_phase_backdrop(DisplayList& list) const;
    void extend_phase(std::size_t side, const Bobs<double>& bobs, double time);
    void compose_phase(DisplayList& list) const;

    // composer_strip.cpp: the chart below
    std::vector<StripValue> strip_values(StripKind kind) const;
    std::string strip_heading(StripKind kind) const;
    void compose_strip_backdrop(const StripLayout& strip, DisplayList& list) const;
    void compose_horizon(DisplayList& list) const;
    void compose_time_labels(const StripLayout& strip, DisplayList& list) const;
    void compose_strip(std::size_t index, DisplayList& list) const;
    void compose_parting(const StripLayout& strip, float free_from, DisplayList& list) const;

    const Scene& scene_;
    Layout layout_;
    double heaviest_;     // kg
    double energy_unit_;  // J: one for both sides, or the side that starts near E = 0 would look far worse
    Shot now_;
    double start_distance_ = 0, largest_distance_ = 0;
    std::array<Trail, 2> trails_, phase_trails_;
    std::array<std::optional<std::pair<Bob<double>, double>>, 2> last_bob_;
    std::array<std::optional<Bobs<double>>, 2> last_bobs_;  // of a section
    std::array<std::vector<Point>, 2> section_;             // its points, px
    std::vector<std::vector<Trace>> traces_;                // strip by strip
    std::optional<double> parted_;                          // s
};

}  // namespace doppel
