#pragma once

#include "base/error.hpp"
#include "physics/pendulum.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace doppel {

/// The numbers of pendulums of as many links each, by quantity: that of link j of member i is at [j · members + i].
/// Errors  Error (exit 2) where there is no pendulum, or they differ in their links.
struct BatchTable {
    std::size_t links;
    std::vector<double> mass, length, angle, rate, gravity;

    explicit BatchTable(std::span<const Pendulum<double>> members) : links(members.empty() ? 0 : members[0].links()) {
        if (members.empty()) throw bad_input("a batch needs at least one pendulum");
        for (const auto& member : members)
            if (member.links() != links)
                throw bad_input("the pendulums of a batch have as many links each: not {} and {}", links,
                                member.links());
        const auto gather = [&](std::vector<double>& to, const std::vector<double> Pendulum<double>::*quantity) {
            for (std::size_t j = 0; j < links; ++j)
                for (const auto& member : members) to.push_back((member.*quantity)[j]);
        };
        gather(mass, &Pendulum<double>::mass);
        gather(length, &Pendulum<double>::length);
        gather(angle, &Pendulum<double>::angle);
        gather(rate, &Pendulum<double>::rate);
        for (const auto& member : members) gravity.push_back(member.gravity);
    }
};

}  // namespace doppel
