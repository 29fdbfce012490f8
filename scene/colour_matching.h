#pragma once

#include <array>
#include <string_view>

namespace lightwell {

/// Greatest luminous efficacy, lm/W, at 555 nm.
inline constexpr double greatest_luminous_efficacy = 683.0;

/// Means of the colour-matching functions x, y and z of the CIE 1931 standard observer over
/// [low, high] nm, within 360 to 830 nm: the table of CIE 15 in steps of 1 nm, linear between them.
/// y is the luminous efficiency V.
std::array<double, 3> colour_matching(double low, double high);

namespace scene_data {
extern const std::string_view colour_matching;  ///< the bytes of colour_matching.csv
}  // namespace scene_data

}  // namespace lightwell
