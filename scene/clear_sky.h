#pragma once

#include <cstdint>

#include "scene/bands.h"
#include "scene/environment_map.h"
#include "scene/sky.h"

namespace lightwell {

/// A cloudless day, in r, g and b. Turbidity is the extinction of the whole atmosphere by that of
/// clean air: 2 is a very clear sky, 3 a clear one, 6 a hazy one, 10 a thick haze.
struct ClearDay {
  double turbidity = 3.0;              ///< [1, 10]
  double sun_altitude_degrees = 45.0;  ///< (0, 90]
  Spectrum albedo{};  ///< of the ground, which lights the air; r, g and b in [0, 1]
};

/// The dome of a clear day as a picture.
struct ClearDome {
  double scale = 1.0;    ///< >= 0, factor of the radiance above the horizon
  double stretch = 1.0;  ///< [1, 2]: the horizon lies at 90 degrees times this from the zenith
  Spectrum below{};      ///< radiance below the horizon
};

/// Integral of the CIE 1931 luminous efficiency over wavelengths. Times this, W/(m^2 nm) of a clear
/// day are W/m^2 of bands with 683 lm/W.
inline constexpr double luminous_width_nm = 106.857;

/// Irradiance of a horizontal surface by the dome, W/(m^2 nm). The values are linear sRGB, and the
/// luminance 1 belongs to an even spectrum of 1 W/(m^2 nm).
///
/// A fit to the model of Hosek & Wilkie 2012, "An analytic model for full spectral sky-dome
/// radiance", as Mitsuba 3 evaluates the model. Illuminance differs by 2.6 % at most with an albedo
/// of 0.3, and by 4 % with others, for turbidities of 2 to 8 and a sun 5 to 80 degrees high.
Spectrum clear_sky_irradiance(const ClearDay& day);

/// Models of the sun behind a clear atmosphere.
enum class ClearSunModel : std::uint8_t {
  hosek_wilkie,  ///< Hosek & Wilkie 2013, "Adding a solar-radiance function to the model"
  preetham       ///< Preetham, Shirley & Smits 1999, "A practical analytic model for daylight"
};

/// Irradiance of a surface that faces the sun, by the sun alone, W/(m^2 nm) as above: I_0
/// exp(-tau), where ln tau is a polynomial of turbidity and the logarithm of the air mass, fitted
/// to the model. Illuminance differs by 8 % at most where the sun is 10 degrees high or more, for
/// turbidities of 2 to 8; by a tenth of the sun's and 4 % of the whole light of the day at 5
/// degrees.
Spectrum clear_sun_irradiance(ClearSunModel model, double turbidity, double sun_altitude_degrees);

/// The dome as a picture, W/(m^2 sr nm), with the zenith at the top and the sun above the middle.
/// With the angles Z from the zenith and gamma from the sun
///
///     L ~ (1 + a exp(-b / (cos Z + 0.01))) (1 + c exp(-d gamma) + e cos^2 gamma + f sqrt(cos Z))
///
/// the form of Hosek & Wilkie without its aureole, of which the sky of Preetham, Shirley & Smits is
/// the case f = 0. The coefficients are polynomials of turbidity and the sun's altitude. Light by
/// an albedo other than 0.3 is added or taken away in proportion to 1 / (cos Z + 0.2).
/// Illuminances of walls differ from the model by 7 % at most (root mean square: 3 %) for an albedo
/// of 0.3 and by 18 % for albedos of 0 and 1, in the range of clear_sky_irradiance().
EnvironmentMap clear_sky_map(const ClearDay& day, const ClearDome& dome);

/// Gives `sky` the dome and its name. The axis `up` of the sky and the unit direction to the sun
/// place the dome.
void set_clear_dome(const ClearDay& day, const ClearDome& dome, const Eigen::Vector3d& to_sun,
                    Sky& sky);

}  // namespace lightwell
