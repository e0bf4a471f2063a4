#pragma once

#include "figure/work.hpp"

#include <atomic>
#include <span>
#include <string>
#include <string_view>

namespace doppel {

enum class Verdict { holds, fails, misprinted };

/// A claim of the study (Kao 2022), how it is put to the test, and what the numbers then say.
struct Claim {
    std::string_view key;    // for the manifest
    std::string_view words;  // the claim, in short
    std::size_t numbers;     // that it comes to
    TrialNumbers (*measure)(const std::atomic<bool>& stop);
    std::string (*found)(const TrialNumbers& numbers);  // in words
    Verdict (*verdict)(const TrialNumbers& numbers);    // by the numbers alone
};

/// All of them, in the order of the study.
std::span<const Claim> claims();

}  // namespace doppel
