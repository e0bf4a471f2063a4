#pragma once

#include "figure/field_table.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace doppel::test {

inline constexpr std::string_view torque_table = "[[system.torque]]";

/// All tables of a film's preset: keys outside of tables; [scene]; [system], [a], [b]; particles; the kinds of
/// constraints and forces; torques; further keys of [a] and [b]; [video].
std::vector<FieldTable> film_tables();

/// Whether a preset must give the key.
inline bool is_needed(const ListedField& field) {
    return field.described_default == must_be_given;
}

/// The default of a key, or its description, Markdown.
std::string default_of(const ListedField& field);

}  // namespace doppel::test
