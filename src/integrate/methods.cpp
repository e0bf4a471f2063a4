#include "integrate/methods.hpp"

#include "integrate/registry.hpp"
#include "integrate/stabilise.hpp"
#include "physics/angle_chain.hpp"
#include "physics/mechanism.hpp"
#include "physics/rod_chain.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace doppel {

std::span<const MethodEntry> methods() {
    static constexpr auto all = [] {
        constexpr int links = Eigen::Dynamic;
        std::array<MethodEntry, std::tuple_size_v<Methods>> entries{};
        std::size_t n = 0;
        for_each_method([&]<class Which>() {
            entries[n++] = {Which::method, supports<Which, AngleChain<double, links>>,
                            supports<Which, RodChain<double, links>>, supports<Which, Mechanism<double>>,
                            supports<Which, Projected<RodChain<double, links>>>};
        });
        return entries;
    }();
    return all;
}

std::span<const std::string_view> names_of_methods() {
    static const auto names = [] {
        std::vector<std::string_view> all;
        for (const auto& method : methods()) all.push_back(method.name);
        return all;
    }();
    return names;
}

const MethodEntry* find_method(std::string_view name) {
    const auto all = methods();
    const auto found = std::ranges::find(all, name, &MethodEntry::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace doppel
