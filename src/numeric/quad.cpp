#include "numeric/quad.hpp"

#include <fmt/format.h>

#include <iomanip>
#include <sstream>

namespace doppel {

Quad parse_quad(std::string_view decimal) {
#if defined(__aarch64__)
    return std::strtold(std::string(decimal).c_str(), nullptr);
#else
    return Quad(std::string(decimal));
#endif
}

std::string text_of(const Quad& value) {
    auto text = fmt::format("{}", static_cast<double>(value));
    if (parse_quad(text) == value) return text;
    for (int digits = 34;; ++digits) {
        std::ostringstream stream;
        stream << std::setprecision(digits) << value;
        constexpr int sufficient_digits = 36;
        if (digits == sufficient_digits || parse_quad(stream.str()) == value) return stream.str();
    }
}

}  // namespace doppel
