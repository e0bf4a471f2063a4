#include "scene/resolved.hpp"

#include "integrate/methods.hpp"

#include <fmt/format.h>

namespace doppel {

std::string toml_text(const std::string& text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            quoted += {'\\', c};
        else if (byte < 0x20 || byte == 0x7f)  // TOML allows them escaped alone; JSON's writers leave U+007F as it is
            quoted += fmt::format("\\u{:04X}", static_cast<unsigned>(byte));
        else
            quoted += c;
    }
    return quoted + '"';
}

std::string toml_ratio(const Rational& value) {
    return value.is_whole() ? value.text() : fmt::format("\"{}\"", value.text());
}

namespace {

std::string numbers(const std::vector<Quad>& values) {
    std::vector<std::string> texts;
    for (const auto& value : values) texts.push_back(text_of(value));
    return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string pair_text(const std::array<Quad, 2>& xy) {
    return fmt::format("[{}, {}]", text_of(xy[0]), text_of(xy[1]));
}

std::string end_text(const EndSpec& end) {
    const auto* name = std::get_if<std::string>(&end);
    return name ? toml_text(*name) : pair_text(std::get<std::array<Quad, 2>>(end));
}

std::string particle_toml(const std::string& side, const ParticleSpec& particle) {
    return fmt::format("\n[[{}.particle]]\nname = {}\nmass_kg = {}\nposition_m = {}\nvelocity_m_per_s = {}\n", side,
                       toml_text(particle.name), text_of(particle.mass_kg), pair_text(particle.position_m),
                       pair_text(particle.velocity_m_per_s));
}

std::string part_toml(const std::string& side, const char* what, const PartSpec& part) {
    auto text = fmt::format("\n[[{}.{}]]\nkind = {}\n", side, what, toml_text(part.kind));
    const auto add = [&](std::string_view key, const std::string& value) {
        text += fmt::format("{} = {}\n", key, value);
    };
    if (!part.name.empty()) add("name", toml_text(part.name));
    if (!part.particle.empty()) add("particle", toml_text(part.particle));
    if (part.from) add("from", end_text(*part.from));
    if (part.to) add("to", end_text(*part.to));
    if (part.position_m) add("position_m", pair_text(*part.position_m));
    if (part.kind == "slot-line") add("direction", pair_text(part.direction));
    if (part.length_m) add(part.kind == "slot-circle" ? "radius_m" : "length_m", text_of(*part.length_m));
    if (part.kind == "spring") {
        add("stiffness_N_per_m", text_of(part.stiffness_N_per_m));
        add("damping_N_s_per_m", text_of(part.damping_N_s_per_m));
    }
    if (part.kind == "droplet") add("mass_kg", text_of(part.mass_kg));
    if (part.constant) add("constant_m3_per_kg_s2", text_of(*part.constant));
    return text;
}

std::string links_toml(const SideSpec& side) {
    return fmt::format("links = {}\nmass_kg = {}\nlength_m = {}\n", side.links(), numbers(side.mass_kg),
                       numbers(side.length_m));
}

std::string chain_toml(const SideSpec& side) {
    return links_toml(side) + fmt::format("angle_deg = {}\nomega_deg_per_s = {}\n", numbers(side.angle_deg),
                                          numbers(side.omega_deg_per_s));
}

std::string pace_toml(const SideSpec& side) {
    return find_method(side.integrator)->adaptive ? fmt::format("tolerance = {}\n", text_of(side.allowed_error()))
                                                  : fmt::format("step_s = {}\n", toml_ratio(side.step()));
}

/// [a] or [b] with everything in it.
std::string side_toml(const std::string& name, const SideSpec& side) {
    constexpr const char* models[] = {"auto", "angles", "constraints", "mechanism"};
    constexpr const char* precisions[] = {"double", "quad"};
    constexpr const char* stabilise[] = {"none", "baumgarte", "projection"};
    auto text = fmt::format("\n[{}]\n{}", name, side.particles.empty() ? chain_toml(side) : "");
    text += fmt::format("gravity_m_per_s2 = {}\nmodel = \"{}\"\nprecision = \"{}\"\nstabilise = \"{}\"\n",
                        text_of(side.gravity_m_per_s2), models[static_cast<int>(side.model)],
                        precisions[static_cast<int>(side.precision)], stabilise[static_cast<int>(side.stabilise)]);
    text += side.accuracy ? fmt::format("accuracy = {}\n", text_of(*side.accuracy))
                          : fmt::format("integrator = \"{}\"\n{}", side.integrator, pace_toml(side));
    if (side.stabilise == Stabilise::baumgarte)
        text += fmt::format("stabilise_rate_per_s = {}\n", text_of(side.stabilise_rate_per_s));
    for (const auto& particle : side.particles) text += particle_toml(name, particle);
    for (const auto& part : side.constraints) text += part_toml(name, "constraint", part);
    for (const auto& part : side.forces) text += part_toml(name, "force", part);
    return text;
}

}  // namespace

std::string resolved_pair(const Preset& preset) {
    return fmt::format("duration_s = {}\nsample_hz = {}\n", toml_ratio(preset.duration_s),
                       toml_ratio(preset.sample_hz)) +
           resolved_sides(preset);
}

std::string resolved_sides(const Preset& preset, const std::string& above) {
    return side_toml(above + "a", preset.a) + side_toml(above + "b", preset.b);
}

std::string resolved_release(const SideSpec& side) {
    return fmt::format("\n[system]\n{}gravity_m_per_s2 = {}\n", chain_toml(side), text_of(side.gravity_m_per_s2));
}

std::string resolved_chain(const SideSpec& side) {
    return fmt::format("\n[system]\n{}gravity_m_per_s2 = {}\n", links_toml(side), text_of(side.gravity_m_per_s2));
}

std::string resolved_toml(const Preset& preset) {
    return fmt::format("title = {}\n\n[scene]\nkind = \"pair\"\n", toml_text(preset.title)) + resolved_pair(preset) +
           resolved_video(preset.video);
}

}  // namespace doppel
