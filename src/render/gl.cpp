#include "render/gl.hpp"

#include "base/error.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

namespace doppel {
namespace {

constexpr std::array<std::pair<const char*, Gl>, 3> names{
    {{"auto", Gl::automatic}, {"osmesa", Gl::osmesa}, {"egl", Gl::egl}}};

}  // namespace

std::vector<std::string> gl_names() {
    std::vector<std::string> all;
    for (const auto& [name, gl] : names) all.emplace_back(name);
    return all;
}

Gl gl_named(const std::string& name) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const auto& known) { return known.first == name; });
    if (found == names.end())
        throw bad_input("nothing that draws is called \"{}\"; there are {}", name, fmt::join(gl_names(), ", "));
    return found->second;
}

}  // namespace doppel
