#include "radiosity/radiation/radiant_exchange.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <vector>

#include "scene/disjoint_sets.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

[[noreturn]] void refuse(Eigen::Index surface, const std::string& what) {
  throw RadiatingSurfaceError(static_cast<int>(surface), what);
}

void check_emittance(Eigen::Index i, double emittance) {
  if (emittance >= 0.0 && emittance <= 1.0) return;
  refuse(i, fmt::format("its emittance is {}; it must lie between 0 and 1", emittance));
}

bool is_temperature(double kelvin) {
  return kelvin >= 0.0 && kelvin <= hottest_surface;
}

void check_surface(const ExchangeAreas& areas, Eigen::Index i, const RadiatingSurface& surface) {
  check_emittance(i, surface.emittance);
  if (surface.kelvin) {
    if (is_temperature(*surface.kelvin)) return;
    refuse(i, fmt::format("its temperature is {} K; it must lie between 0 and {:g} K",
                          *surface.kelvin, hottest_surface));
  }
  if (!std::isfinite(surface.heat)) refuse(i, "its heat is not a finite number");
  if (surface.heat == 0.0) return;
  if (!(areas.area[i] > 0.0)) refuse(i, "it gives off heat, but has no area");
  if (!(surface.emittance > 0.0)) {
    refuse(i, "it gives off heat, but has no emittance; give an emittance above 0");
  }
}

// Groups of surfaces that exchange radiation with each other.
DisjointSets groups_of(const ExchangeAreas& areas) {
  const int n = areas.count();
  DisjointSets groups(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      if (areas.between(i, j) > 0.0) groups.join(i, j);
    }
  }
  return groups;
}

// Throws `what`, with the first surface, if no surface of a group is held, which is where the
// equations have a solution.
void require_held(const ExchangeAreas& areas, const std::vector<char>& holds, const char* what) {
  DisjointSets groups = groups_of(areas);
  std::vector<char> is_held(holds.size(), 0);
  for (int i = 0; i < areas.count(); ++i) {
    const auto root = static_cast<std::size_t>(groups.root(i));
    // Openings of less than the rounding of view factors hold nothing.
    constexpr double least = 1e-6;
    const bool is_open = areas.open[i] > least * areas.area[i];
    if (holds[static_cast<std::size_t>(i)] != 0 || is_open) is_held[root] = 1;
  }
  for (int i = 0; i < areas.count(); ++i) {
    const bool counts = areas.area[i] > 0.0;
    if (counts && is_held[static_cast<std::size_t>(groups.root(i))] == 0) refuse(i, what);
  }
}

double emissive_power(double kelvin) {
  return stefan_boltzmann * kelvin * kelvin * kelvin * kelvin;
}

// J of all surfaces: the solution of one equation for each.
Eigen::VectorXd radiosities(const ExchangeAreas& areas, std::span<const RadiatingSurface> surfaces,
                            double E0) {
  const int n = areas.count();
  Eigen::MatrixXd M = -areas.between;
  Eigen::VectorXd right(n);
  for (int i = 0; i < n; ++i) {
    const RadiatingSurface& surface = surfaces[static_cast<std::size_t>(i)];
    const double A = areas.area[i], from_outside = areas.open[i] * E0;
    if (!(A > 0.0)) {
      M(i, i) = 1.0;  // the rest of the row is 0
      right[i] = surface.kelvin ? surface.emittance * emissive_power(*surface.kelvin) : 0.0;
    } else if (surface.kelvin) {
      const double rho = 1.0 - surface.emittance;
      M.row(i) *= rho;
      M(i, i) += A;
      right[i] = A * surface.emittance * emissive_power(*surface.kelvin) + rho * from_outside;
    } else {
      M(i, i) += A;
      right[i] = surface.heat + from_outside;
    }
  }
  return M.partialPivLu().solve(right);
}

// The temperature of a surface with a known heat. Throws InputError if it is below zero.
double temperature_of(Eigen::Index i, const RadiatingSurface& surface, double A, double J,
                      double largest) {
  if (!(A > 0.0) || !(surface.emittance > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  const double E = J + surface.heat * (1.0 - surface.emittance) / (A * surface.emittance);
  // Below by rounding alone: absolute zero.
  constexpr double rounding = 1e-9;
  if (E < -rounding * largest) {
    refuse(i, fmt::format("to give off {:g} W it would have to be colder than 0 K; give it more "
                          "heat, or the others a higher temperature",
                          surface.heat));
  }
  return std::pow(std::max(E, 0.0) / stefan_boltzmann, 0.25);
}

}  // namespace

RadiatingSurfaceError::RadiatingSurfaceError(int number, const std::string& what_is_wrong)
    : InputError(fmt::format("surface {}: {}", number, what_is_wrong)),
      surface(number),
      fault(what_is_wrong) {}

RadiantExchange radiant_exchange(const ExchangeAreas& areas,
                                 std::span<const RadiatingSurface> surfaces, double surroundings) {
  const int n = areas.count();
  if (static_cast<int>(surfaces.size()) != n) {
    throw InputError(fmt::format("{} surfaces are given for {} areas", surfaces.size(), n));
  }
  if (!is_temperature(surroundings)) {
    throw InputError(
        fmt::format("the temperature of the surroundings is {} K; it must lie between "
                    "0 and {:g} K",
                    surroundings, hottest_surface));
  }
  std::vector<char> holds;
  for (int i = 0; i < n; ++i) {
    const RadiatingSurface& surface = surfaces[static_cast<std::size_t>(i)];
    check_surface(areas, i, surface);
    holds.push_back(surface.kelvin && surface.emittance > 0.0 ? 1 : 0);
  }
  require_held(areas, holds,
               "it exchanges radiation with no opening and with no surface of known temperature "
               "that emits, so nothing decides its temperature; give one a temperature");
  const double E0 = emissive_power(surroundings);
  const Eigen::VectorXd J = radiosities(areas, surfaces, E0);
  RadiantExchange result{.kelvin = Eigen::ArrayXd(n),
                         .radiosity = J.array(),
                         .irradiation = Eigen::ArrayXd::Zero(n),
                         .heat = Eigen::ArrayXd::Zero(n)};
  const double largest = n > 0 ? J.cwiseAbs().maxCoeff() : 0.0;
  for (int i = 0; i < n; ++i) {
    const RadiatingSurface& surface = surfaces[static_cast<std::size_t>(i)];
    const double out = areas.open[i] * (J[i] - E0);
    result.to_surroundings += out;
    result.heat[i] = out + (areas.between.row(i).transpose().array() * (J[i] - J.array())).sum();
    if (areas.area[i] > 0.0) {
      result.irradiation[i] = (areas.between.row(i).dot(J) + areas.open[i] * E0) / areas.area[i];
    }
    result.kelvin[i] =
        surface.kelvin ? *surface.kelvin : temperature_of(i, surface, areas.area[i], J[i], largest);
  }
  return result;
}

Eigen::MatrixXd gebhart_factors(const ExchangeAreas& areas, const Eigen::ArrayXd& emittance) {
  const int n = areas.count();
  if (emittance.size() != n) {
    throw InputError(fmt::format("{} emittances are given for {} areas", emittance.size(), n));
  }
  std::vector<char> absorbs;
  for (int i = 0; i < n; ++i) {
    check_emittance(i, emittance[i]);
    absorbs.push_back(emittance[i] > 0.0 ? 1 : 0);
  }
  require_held(
      areas, absorbs,
      "it exchanges radiation with no opening and with no surface that absorbs; give one an "
      "emittance above 0");
  // A_i B_ij - sum_k S_ik rho_k B_kj = S_ij eps_j, and for the surroundings open_i.
  Eigen::MatrixXd M = -areas.between * (1.0 - emittance).matrix().asDiagonal();
  Eigen::MatrixXd right(n, n + 1);
  right.leftCols(n) = areas.between * emittance.matrix().asDiagonal();
  right.col(n) = areas.open.matrix();
  for (int i = 0; i < n; ++i) M(i, i) += areas.area[i] > 0.0 ? areas.area[i] : 1.0;
  return M.partialPivLu().solve(right);
}

Eigen::MatrixXd transfer_factors(const ExchangeAreas& areas, const Eigen::ArrayXd& emittance) {
  Eigen::MatrixXd factors = gebhart_factors(areas, emittance);
  factors = emittance.matrix().asDiagonal() * factors;
  return factors;
}

}  // namespace lightwell
