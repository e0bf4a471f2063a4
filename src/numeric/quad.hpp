#pragma once

#include <Eigen/Core>

#include <string>
#include <string_view>

// Quad, IEEE binary128: 113 bits, about 34 digits. It is long double if that is binary128; otherwise the compiler's
// software type, wrapped by Boost.
#if defined(__aarch64__)
namespace doppel {
using Quad = long double;
static_assert(__LDBL_MANT_DIG__ == 113);
}  // namespace doppel
#else
#include <boost/multiprecision/float128.hpp>
namespace doppel {
using Quad = boost::multiprecision::float128;
}

/// Its costs, for Eigen.
template <>
struct Eigen::NumTraits<doppel::Quad> : Eigen::GenericNumTraits<doppel::Quad> {
    enum { ReadCost = 2, AddCost = 40, MulCost = 40 };
};
#endif

namespace doppel {

/// The quad nearest to a decimal literal, "90.003". The text must be a literal (the preset reader checks this).
Quad parse_quad(std::string_view decimal);

/// The fewest digits that mean this number: the shortest decimal of the nearest double if that is the same quad
/// ("9.8"), otherwise 34 to 36.
std::string text_of(const Quad& value);

}  // namespace doppel
