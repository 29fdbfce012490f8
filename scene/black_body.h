#pragma once

#include <cmath>

namespace lightwell {

/// Planck's law: spectral radiance of a black body of `kelvin`, above 0, at the wavelength `nm`,
/// W/(m^2 sr nm).
inline double black_body_radiance(double nm, double kelvin) {
  constexpr double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23;
  const double metres = 1e-9 * nm;
  return 1e-9 * 2.0 * h * c * c / std::pow(metres, 5.0) / std::expm1(h * c / (metres * k * kelvin));
}

}  // namespace lightwell
