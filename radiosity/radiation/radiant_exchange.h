#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "radiosity/radiation/exchange_areas.h"
#include "scene/errors.h"

namespace lightwell {

/// Stefan-Boltzmann constant, W/(m^2 K^4).
inline constexpr double stefan_boltzmann = 5.670374419e-8;

/// Highest temperature of a surface, K: sigma T^4 times the largest areas is far within a double.
inline constexpr double hottest_surface = 1e6;

/// A surface whose numbers allow no exchange. The message calls the surface by its number, from 0;
/// those who know names find both parts of the message here.
class RadiatingSurfaceError : public InputError {
 public:
  RadiatingSurfaceError(int number, const std::string& what_is_wrong);

  const int surface;
  const std::string fault;
};

/// A gray and diffuse surface. Either its temperature is known or the heat that it gives off.
struct RadiatingSurface {
  double emittance = 1.0;  ///< [0,1], and absorptance
  std::optional<double> kelvin{};
  double heat = 0.0;  ///< W, net, away from the surface; for surfaces without a temperature
};

/// Radiant exchange of an enclosure; one entry for each surface.
struct RadiantExchange {
  /// T, K. NaN where nothing decides it: a surface without emittance, or without area, of unknown
  /// temperature.
  Eigen::ArrayXd kelvin{};
  Eigen::ArrayXd radiosity{};    ///< J, W/m^2, emitted and reflected
  Eigen::ArrayXd irradiation{};  ///< G, W/m^2
  Eigen::ArrayXd heat{};         ///< Q = A (J - G), W, net, away from the surface
  double to_surroundings = 0.0;  ///< W, net, out of the openings
};

/// Net radiant exchange of gray, diffuse surfaces (network method, Oppenheim 1956; Hottel & Sarofim
/// 1967, "Radiative Transfer"):
///
///     A_i J_i = A_i eps_i sigma T_i^4 + (1 - eps_i) A_i G_i
///     A_i G_i = sum_j S_ij J_j + open_i sigma T_0^4
///     Q_i = sum_j S_ij (J_i - J_j) + open_i (J_i - sigma T_0^4)
///
/// The heats add up to `to_surroundings` to rounding, since each exchange between two surfaces
/// enters twice with opposite signs. `surroundings`: T_0 in K; black.
///
/// Throws InputError if there are not as many surfaces as areas, and RadiatingSurfaceError
///   - for numbers out of range;
///   - if heat is given for a surface without area or without emittance;
///   - for surfaces of given heat that exchange radiation with no surface of known temperature and
///     with no opening: their temperature is unbounded or any;
///   - if the given heats would need a temperature below zero.
RadiantExchange radiant_exchange(const ExchangeAreas& areas,
                                 std::span<const RadiatingSurface> surfaces, double surroundings);

/// Gebhart factors (Gebhart 1961, "Surface temperature calculations in radiant surroundings of
/// arbitrary complexity", Int. J. Heat Mass Transfer 3): B_ij is the share of what surface i emits
/// that surface j absorbs, directly or after reflections; the last column is the share that reaches
/// the surroundings. n x (n + 1); rows add up to 1, those of surfaces without area are 0.
///
///     B_ij = F_ij eps_j + sum_k F_ik (1 - eps_k) B_kj
///
/// Throws InputError for emittances out of [0,1], and if there is a part of the enclosure in which
/// nothing absorbs.
Eigen::MatrixXd gebhart_factors(const ExchangeAreas& areas, const Eigen::ArrayXd& emittance);

/// Transfer factors of Hottel & Sarofim, "script F": between surfaces, and in the last column to
/// the surroundings, Q_ij = A_i F_ij sigma (T_i^4 - T_j^4) with F_ij = eps_i B_ij. A_i F_ij = A_j
/// F_ji between surfaces. n x (n + 1). Throws as gebhart_factors().
Eigen::MatrixXd transfer_factors(const ExchangeAreas& areas, const Eigen::ArrayXd& emittance);

}  // namespace lightwell
