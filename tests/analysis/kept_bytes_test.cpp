#include "analysis/difference.hpp"
#include "analysis/exponent.hpp"
#include "analysis/pair_batch.hpp"
#include "integrate/methods.hpp"
#include "integrate/motion.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <string>

// The bits of tables, compared with kept_bytes.txt: they are equal on every processor and with
// every C library. Runs are chaotic, so one different bit soon changes all of them. tests/check-arm64 runs these on
// another processor. A change of the order of sums changes the bits: tests/update-kept-bytes stores the new ones.

namespace doppel::kept_bytes_test {

const std::string kept_file = std::string(DOPPEL_SOURCE_DIR) + "/tests/analysis/kept_bytes.txt";
const std::atomic<bool> never = false;

/// FNV-1a of the bits of doubles.
class Hash {
public:
    void add(double number) {
        auto bits = std::bit_cast<std::uint64_t>(number);
        for (int i = 0; i < 8; ++i, bits >>= 8) sum_ = (sum_ ^ (bits & 0xff)) * 1099511628211u;
    }
    std::string text() const { return fmt::format("{:016x}", sum_); }

private:
    std::uint64_t sum_ = 14695981039346656037u;
};

Pendulum<double> released(std::size_t links) {
    Pendulum<double> p{.mass = {}, .length = {}, .angle = {}, .rate = std::vector<double>(links, 0)};
    for (std::size_t i = 0; i < links; ++i) {
        p.mass.push_back(1 + 0.25 * static_cast<double>(i));
        p.length.push_back(1 - 0.125 * static_cast<double>(i % 3));
        p.angle.push_back(2 + 0.25 * static_cast<double>(i));
    }
    return p;
}

/// 20 s of a motion with all columns of a table.
std::string hash_of(const std::string& method, Model model, std::size_t links) {
    MotionSpec spec{.chain = released(links).cast<Quad>(), .parts = {}, .model = model, .method = method};
    spec.steps_per_sample = 25;
    spec.tolerance = Quad(1e-11);
    const auto motion = make_motion(spec);
    Hash hash;
    for (int n = 0; n < 2400; ++n) {
        motion->advance(never);
        const auto seen = motion->observe();
        for (const auto& bob : seen.bobs)
            for (const double number : {bob.x, bob.y, bob.vx, bob.vy, bob.theta, bob.omega}) hash.add(number);
        hash.add(seen.energy);
    }
    return hash.text();
}

std::string hash_of_exponents() {
    Hash hash;
    const auto exponent = largest_exponent(released(2), {.duration_s = 50, .transient_s = 5}, never);
    hash.add(exponent.value);
    hash.add(exponent.uncertainty);
    for (const auto& sample : lyapunov_spectrum(physical(released(2)), {.duration_s = 40, .samples = 40}, never))
        for (const double number : sample.exponents) hash.add(number);
    return hash.text();
}

std::string hash_of_twins(const MotionSpec& side, std::size_t links) {
    std::vector<PendulumPair> twins;
    for (int i = 0; i < 5; ++i) {
        auto p = released(links), other = p;
        p.angle[0] += 0.01 * i;
        other.angle[0] += 0.01 * i + 1e-9;
        twins.push_back({p, other});
    }
    Hash hash;
    std::vector<AverageLogRatio> means(twins.size());
    const auto watch = [&](std::size_t i, long, const Bobs<double>& a, const Bobs<double>& b) {
        means[i].add(state_space_distance(a, b));
    };
    step_pairs(twins, {.a = side, .b = side, .samples = 2400}, watch, never);
    for (const auto& mean : means) hash.add(mean.value());
    return hash.text();
}

/// The hashes of each method and model, at two, three and six links, and of pairs in angles and in constraints.
std::map<std::string, std::string> hashes() {
    std::map<std::string, std::string> all;
    for (const auto& method : methods())
        for (const auto model : {Model::angles, Model::constraints}) {
            const bool in_angles = model == Model::angles;
            if (!(in_angles ? method.angles : method.constraints)) continue;
            auto& line = all[fmt::format("{} {}", method.name, in_angles ? "angles" : "constraints")];
            for (const std::size_t links : {2u, 3u, 6u}) line += ' ' + hash_of(std::string(method.name), model, links);
        }
    all["exponents"] = ' ' + hash_of_exponents();
    for (const char* method : {"euler", "rk4"})
        all[fmt::format("twins {}", method)] =
            fmt::format(" {} {}", hash_of_twins({.model = Model::angles, .method = method}, 2),
                        hash_of_twins({.model = Model::constraints, .method = method}, 3));
    return all;
}

TEST(KeptBytes, OfChaoticRunsAreTheSameEverywhere) {
    const auto found = hashes();
    if (const char* update = std::getenv("DOPPEL_UPDATE_KEPT_BYTES"); update && std::strcmp(update, "1") == 0) {
        std::ofstream file(kept_file);
        for (const auto& [name, hash] : found) file << name << ':' << hash << '\n';
        return;
    }
    std::map<std::string, std::string> kept;
    std::ifstream file(kept_file);
    for (std::string line; std::getline(file, line);)
        kept[line.substr(0, line.find(':'))] = line.substr(line.find(':') + 1);
    ASSERT_GT(kept.size(), 20u) << kept_file;
    EXPECT_EQ(found.size(), kept.size());
    for (const auto& [name, hash] : found) EXPECT_EQ(hash, kept[name]) << name;
}

}  // namespace doppel::kept_bytes_test
