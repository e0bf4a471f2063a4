#include "analysis/watched_motion.hpp"

#include "base/error.hpp"

namespace doppel {

bool advanced(Motion& motion, const std::atomic<bool>& stop, std::string* why) {
    throw_if_set(stop);
    try {
        motion.advance(stop);
        return true;
    } catch (const Error& error) {
        if (error.code() != ExitCode::method_failed) throw;
        if (why) *why = error.what();
        return false;
    }
}

bool WatchedMotion::advance(const std::atomic<bool>& stop) {
    if (!advanced(*motion, stop)) return false;
    const auto seen = motion->observe();
    energy_error = proportion.energy_error(seen);
    length_error = seen.length_error;
    return proportion.is_plausible(seen);
}

}  // namespace doppel
