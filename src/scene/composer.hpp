#pragma once

#include "picture/theme.hpp"
#include "picture/trace.hpp"
#include "scene/layout.hpp"

#include <array>
#include <deque>
#include <optional>

namespace doppel {

/// Turns a pair's moments into display lists. The list of a moment depends on the scene and on the moments so far, and
/// on nothing else: any frame can be drawn alone.
class Composer {
public:
    explicit Composer(const Scene& scene);

    /// What never changes: the page, the panels, the axes and their words.
    DisplayList backdrop() const;

    /// The next moment, in order from sample 0.
    void add(const Moment& moment);

    /// The picture of the moment added last.
    DisplayList frame() const;

private:
    struct TrailPoint {
        Point at;
        double time;  // s
    };

    void extend_trail(std::size_t side, const Bob<double>& bob, double time);
    void compose_panel(std::size_t side, DisplayList& list) const;
    void compose_lines(std::size_t side, const PanelLayout& panel, const Bobs<double>& bobs, float radius, Color color,
                       DisplayList& list) const;
    void compose_tracks(std::size_t side, DisplayList& list) const;
    void compose_pivots(std::size_t side, DisplayList& list) const;
    const std::vector<MechanismLine>& lines(std::size_t side) const;
    void compose_disc(const PanelLayout& panel, Point at, float radius, Color color, DisplayList& list) const;
    void compose_trail(std::size_t side, Point head, DisplayList& list) const;
    float bob_radius(const Bob<double>& bob) const;
    void compose_distance(DisplayList& list) const;
    void compose_energy(DisplayList& list) const;
    void compose_strip_backdrop(const StripLayout& strip, const char* heading, float label_px, DisplayList& list) const;
    void compose_horizon(DisplayList& list) const;
    void compose_time_labels(const StripLayout& strip, DisplayList& list) const;

    static constexpr const char* distance_heading = "state-space distance";

    const Scene& scene_;
    Layout layout_;
    Theme theme_;
    double heaviest_;     // kg
    double energy_unit_;  // J: one for both sides, or the side that starts near E = 0 would look far worse
    Moment now_;
    std::array<std::deque<TrailPoint>, 2> trails_;
    std::array<std::optional<std::pair<Bob<double>, double>>, 2> last_bob_;
    Trace distance_;
    std::array<Trace, 2> energy_;
    std::optional<double> parted_;  // s
};

}  // namespace doppel
