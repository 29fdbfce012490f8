#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lightwell {

/// Quantity that false colours show.
enum class Measure {
  illuminance,  ///< lx
  luminance,    ///< cd/m^2, of the radiance drawn
  unshot,       ///< unshot radiosity of patches, lm/m^2, during progressive refinement
};

/// Ends of a false-colour scale, low < high, in lx or the unit of the quantity shown. The scale is
/// linear where `low` is 0, else logarithmic.
struct LuxRange {
  double low = 1.0, high = 1000.0;

  bool is_even() const { return low == 0.0; }
};

/// Logarithmic scale for values at vertices, lx. Either end is 1, 2 or 5 times a power of ten. The
/// high end is above all but the brightest 0.5 % of the positive values; the low end is at least a
/// thousandth of the high end. Without positive values: LuxRange's default.
LuxRange lux_range(const std::vector<float>& lux);

/// Position of a value on a scale: 0 at the low end, 1 at the high end; beyond them outside [0,1],
/// and 0 for values that a logarithmic scale does not know.
double place_on_scale(double value, const LuxRange& range);

/// Labelled values of a scale, in its unit.
/// - linear: about five even steps
/// - logarithmic: 1, 2 and 5 times the powers of ten
/// - logarithmic over more than two decades: the powers of ten and the ends
std::vector<double> scale_steps(const LuxRange& range);

/// False colour, sRGB in [0,1], at a position on the scale in [0,1]: dark blue through green to
/// yellow. Lightness rises along the scale, so that the order of values survives printing in grey
/// and colour blindness.
Eigen::Array3f false_color(float place);

/// False colours of values in the unit of `range`, 8-bit sRGB, 3 bytes a value.
std::vector<std::uint8_t> false_colors(const std::vector<float>& lux, const LuxRange& range);

}  // namespace lightwell
