#pragma once

#include "figure/field_table.hpp"

#include <string_view>
#include <vector>

namespace doppel::test {

/// How presets of a kind describe what moves.
enum class MotionOf { none, release, pair };
MotionOf motion_of(std::string_view kind);

/// The tables that only this kind of figure has, and its own keys of [chart].
std::vector<FieldTable> own_tables(std::string_view kind);

/// The tables that a preset of this kind may have, except those of particles, constraints and forces. "[]" contains the
/// keys outside of tables; others are "[scene]", "[system]", "[a]" … and "[[curve]]".
std::vector<FieldTable> tables_of(std::string_view kind);

}  // namespace doppel::test
