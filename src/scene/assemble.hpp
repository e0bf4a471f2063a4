#pragma once

#include "scene/preset.hpp"

namespace doppel {

/// The chain as written, in radians.
Pendulum<Quad> chain_of(const SideSpec& spec);

/// The particles of a side (those of its chain, "bob1", "bob2" …, where it names none), its constraints and forces, and
/// gravity. Throws Error (exit 2) where a part names a particle that is not there.
Assembly<Quad> assembly_of(const SideSpec& spec);

}  // namespace doppel
