#pragma once

#include "physics/pendulum.hpp"

#include <span>
#include <vector>

namespace doppel {

/// The numbers of pendulums of as many links each, by quantity: that of link j of member i is at [j · members + i].
struct BatchTable {
    std::vector<double> mass, length, angle, rate, gravity;

    explicit BatchTable(std::span<const Pendulum<double>> members) {
        const auto gather = [&](std::vector<double>& to, const std::vector<double> Pendulum<double>::*quantity) {
            for (std::size_t j = 0; j < members.front().links(); ++j)
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
