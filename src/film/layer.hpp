#pragma once

#include "film/layout.hpp"
#include "film/parting.hpp"

#include <memory>
#include <optional>

namespace doppel {

/// The state at one sample: the pair, and the bobs of an ensemble's members.
struct Snapshot {
    PairState pair;
    std::vector<Bobs<double>> members;
};

/// What the layers of a film's picture draw: the scene, where everything goes, and what came of the pair so far.
struct FilmState {
    const Scene& scene;
    const Layout layout;
    Snapshot snapshot{};  // added last
    double start_distance = 0, largest_distance = 0;
    Parting parting{};

    double time() const { return scene.time_of_tick(snapshot.pair.tick); }
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
    /// The next snapshot, in order from sample 0, is that of the state.
    virtual void add() {}
    /// What lies on the backdrop at the snapshot added last.
    virtual void frame(DisplayList& list) const = 0;

protected:
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
