#include "figure/film_tables.hpp"

#include "figure/kind_tables.hpp"
#include "scene/preset_fields.hpp"

namespace doppel::test {

std::string default_of(const ListedField& field) {
    return field.default_value.empty() ? std::string(field.described_default)
                                       : fmt::format("`{}`", field.default_value);
}

std::vector<FieldTable> film_tables() {
    const auto film = tables_of(pair_kind);
    const std::optional<std::string> no_name;
    const Field name{.key = "name", .help = "by which `[a]` and `[b]` change it"};
    std::vector<FieldTable> tables{film.begin(), film.begin() + 3};
    tables[0].name = "title, subtitle";
    tables[2].name = "[system], [a], [b]";
    auto& particle = tables.emplace_back(
        "[[system.particle]]",
        "In place of a chain, a system may have particles; constraints and forces may stand on top of a chain, too, "
        "whose\nbobs are called `bob1`, `bob2` …\n");
    particle({.key = "name",
              .help = "the name that constraints and forces refer to",
              .needed_by = "particle",
              .is_drawn = true},
             std::string());
    ParticleSpec released;
    part_fields(particle, released);
    for (std::size_t i = 0; i < names_of<PartKind>.size(); ++i) {
        PartSpec part{.kind = static_cast<PartKind>(i)};
        auto& table = tables.emplace_back(fmt::format(
            "[[system.{}]] kind = \"{}\"", i < constraint_kinds ? "constraint" : "force", name_of(part.kind)));
        table(name, no_name);
        part_fields(table, part);
    }
    auto& torque = tables.emplace_back(std::string(torque_table),
                                       "A motor at a joint of a chain: amplitude · cos(2π · frequency · t + phase).\n");
    torque(name, no_name);
    TorqueSpec motor;
    part_fields(torque, motor);
    SideSpec side;
    side_text_fields(tables.emplace_back("[a], [b]", "What a picture says of a side.\n"), side);
    tables.push_back(film.back());
    return tables;
}

}  // namespace doppel::test
