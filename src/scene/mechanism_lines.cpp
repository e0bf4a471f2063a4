#include "scene/scene.hpp"

namespace doppel {

std::vector<MechanismLine> lines_of(const Pendulum<double>& chain) {
    using Kind = MechanismLine::Kind;
    const End<double> pivot = Place<double>(0, 0);
    std::vector<MechanismLine> lines;
    for (std::size_t i = 0; i < chain.links(); ++i)
        lines.push_back({Kind::rod, i == 0 ? pivot : End<double>(i - 1), i});
    return lines;
}

std::vector<MechanismLine> lines_of(const Assembly<double>& assembly) {
    using Kind = MechanismLine::Kind;
    std::vector<MechanismLine> lines;
    for (const auto& constraint : assembly.constraints) {
        if (const auto* anchor = std::get_if<Anchor<double>>(&constraint))
            lines.push_back({Kind::anchor, anchor->place, anchor->place});
        if (const auto* rod = std::get_if<Rod<double>>(&constraint)) lines.push_back({Kind::rod, rod->a, rod->b});
        if (const auto* slot = std::get_if<SlotLine<double>>(&constraint))
            lines.push_back({Kind::slot_line, slot->point, Place<double>(slot->point + slot->direction)});
        if (const auto* slot = std::get_if<SlotCircle<double>>(&constraint))
            lines.push_back({Kind::slot_circle, slot->centre, slot->centre, slot->radius});
    }
    for (const auto& force : assembly.forces)
        if (const auto* spring = std::get_if<Spring<double>>(&force))
            lines.push_back({Kind::spring, spring->a, spring->b});
    return lines;
}

}  // namespace doppel
