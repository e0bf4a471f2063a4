#pragma once

#include "film/bounds.hpp"
#include "film/recording.hpp"
#include "output/page.hpp"
#include "output/transaction.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <vector>

namespace doppel {

/// A film as one HTML file, NAME.html: the motion, what is drawn around it, and the script that plays it (film/page/).
/// Where all pendulums are chains of one to three ideal links in angles, in double, by Euler's methods or rk4, the script
/// computes the motion, to the last bit; else the file holds it in 16 bits a position, or more.
class FilmPage {
public:
    /// `bounds` as make_layout() takes them. Adds its file to `parts`.
    FilmPage(const Scene& scene, const MotionBounds& bounds, Transaction& parts);

    /// Every sample, from 0 on; moments between them are left out.
    void add(const Snapshot& snapshot);
    /// Writes the file. Throws Error (exit 4).
    void finish();

private:
    using Channels = std::vector<std::vector<float>>;  // numbers over time

    void add_positions(const Snapshot& snapshot);
    void add_curves(const PairState& state);
    Json motion_json() const;

    const Scene& scene_;
    const MotionBounds& bounds_;
    const std::filesystem::path place_;
    const bool computes_;  // the script computes the motion
    Transaction& parts_;
    double start_distance_ = 0;
    long samples_ = 0;                 // added
    std::vector<Channels> positions_;  // by pendulum
    Channels curves_;                  // of strips, one after the other, and of a phase panel
};

/// The player of a scene's chains of one to three ideal links, for a page of another kind, whose data holds its own as "film":
/// hidden until the document gets an event "release", whose detail has the angles of the release by their keys. Nothing where
/// the scene has other pendulums.
std::optional<HtmlPage> film_player(Scene scene);

/// About how many bytes the page of a scene has.
double estimated_page_bytes(const Scene& scene);

}  // namespace doppel
