#pragma once

#include "film/layout.hpp"
#include "film/recording.hpp"
#include "output/page.hpp"
#include "output/transaction.hpp"
#include "scene/resolved.hpp"
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace doppel {

/// A film as one HTML file, NAME.html: the motion, the items around it, and the script that plays it (film/page/).
/// The script computes the same motion bit for bit for chains of one to three ideal links, in angles and double, by
/// Euler's methods or rk4. For other pendulums the file contains the motion with 16 or more bits per position.
class FilmPage {
public:
    /// `bounds`: see make_layout(). Adds its file to `parts`.
    FilmPage(const Scene& scene, const MotionBounds& bounds, Transaction& parts);

    /// Takes every sample from 0 on; ignores moments between samples.
    void add(const Snapshot& snapshot);
    /// `outcome`: of the whole motion.
    void finish(const Outcome& outcome);

private:
    using Channels = std::vector<std::vector<float>>;  // each number of a sample, over time
    Json motion_json() const;

    const Scene& scene_;
    const MotionBounds& bounds_;
    const std::filesystem::path place_;
    const bool computes_;  // the script computes the motion
    Transaction& parts_;
    Snapshot first_;
    long samples_ = 0;  // added
    Channels places_, curves_;
};

/// The player of a scene's chains of one to three ideal links, for another kind of page, which adds to its body and
/// data. It is hidden until a script calls releaseAt() with release angles, degrees, by their keys. nullopt if the scene
/// has other pendulums.
std::optional<HtmlPage> film_player(Scene scene);

/// An axis for the scripts of pages: its label, the values `from` … `to`, and the pixels `start` … `end`.
Json axis_json(const Axis& axis, const std::string& label = "");

/// The numbers in double of a motion's ideal chain of one to three links. Includes its method and steps if
/// src/film/page/chain.js computes the motion bit for bit. null for any other motion.
Json chain_json(const MotionSpec& motion);

/// Whether the page computes all of these motions.
bool page_computes(const Scene& scene);

}  // namespace doppel
