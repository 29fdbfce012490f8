#include "raytrace/readings/cylinder.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

LuxReadings read_probes(const LitScene& lit, const RadiositySolution& solution,
                        const std::vector<Probe>& probes, const GatherOptions& options) {
  ProbeBounds bounds;
  const BandArray E =
      probe_irradiance(lit.scene, lit.caster, lit.direct_light, solution, probes, options, &bounds);
  LuxReadings read{.lux = Eigen::ArrayXd(E.rows()),
                   .lux_within = bounds.lux_within,
                   .read_within = bounds.read_within};
  for (Eigen::Index i = 0; i < E.rows(); ++i) {
    read.lux[i] = luminous(lit.scene.bands, E.row(i).transpose());
  }
  return read;
}

}  // namespace

std::vector<Probe> cylinder_probes(const LuxGrid& grid, const Eigen::Vector3d& position) {
  const bool is_half = grid.quantity == GridQuantity::semicylindrical;
  const Eigen::Vector3d ahead =
      is_half ? grid.facing : Eigen::Vector3d(grid.upright.unitOrthogonal());
  const Eigen::Vector3d aside = grid.upright.cross(ahead);
  std::vector<Probe> probes;
  const auto add_planes = [&](double around, int count) {
    for (int i = 0; i < count; ++i) {
      const double angle = around * ((i + 0.5) / count - 0.5);
      probes.push_back(
          {.position = position, .normal = std::cos(angle) * ahead + std::sin(angle) * aside});
    }
  };
  constexpr double circle = 2.0 * std::numbers::pi;
  add_planes(is_half ? 0.5 * circle : circle, planes_of_a_cylinder);
  if (is_half) add_planes(circle, planes_all_around);
  return probes;
}

namespace {

LuxReadings read_cylinders(const LitScene& lit, const RadiositySolution& solution,
                           const LuxGrid& grid, const GatherOptions& options) {
  std::vector<Probe> probes;
  for (const Probe& point : grid.points) {
    const std::vector<Probe> around = cylinder_probes(grid, point.position);
    probes.insert(probes.end(), around.begin(), around.end());
  }
  // The noise of n planes averages out, and light that one plane misses another one finds.
  constexpr int rays_over_plane = 8, fewest = 64;
  GatherOptions of_plane = options;
  of_plane.rays = std::min(options.rays, std::max(fewest, options.rays / rays_over_plane));
  const LuxReadings planes = read_probes(lit, solution, probes, of_plane);
  constexpr int n = planes_of_a_cylinder;
  constexpr double step = std::numbers::pi / n;
  const bool is_half = grid.quantity == GridQuantity::semicylindrical;
  const int each = n + (is_half ? planes_all_around : 0);
  const auto count = static_cast<Eigen::Index>(grid.points.size());
  LuxReadings read{.lux = Eigen::ArrayXd(count),
                   .lux_within = Eigen::ArrayXd(count),
                   .read_within = Eigen::ArrayXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::ArrayXd within = planes.lux_within.segment(i * each, n);
    const Eigen::ArrayXd shared = planes.read_within.segment(i * each, n);
    read.lux[i] = planes.lux.segment(i * each, n).mean();
    const double steps =
        is_half ? step * step / 8.0 * planes.lux.segment(i * each + n, planes_all_around).mean()
                : step * step / 12.0 * read.lux[i];
    // A plane for which nothing is known (NaN) got no light.
    const double noise =
        within.isNaN().select(0.0, (within.square() - shared.square()).max(0.0)).sum();
    read.read_within[i] = shared.mean() + steps;
    read.lux_within[i] =
        within.isNaN().all() ? within[0] : std::hypot(std::sqrt(noise) / n, read.read_within[i]);
  }
  return read;
}

}  // namespace

LuxReadings read_grid(const LitScene& lit, const RadiositySolution& solution, const LuxGrid& grid,
                      const GatherOptions& options) {
  const bool is_round =
      grid.quantity == GridQuantity::cylindrical || grid.quantity == GridQuantity::semicylindrical;
  return is_round ? read_cylinders(lit, solution, grid, options)
                  : read_probes(lit, solution, grid.points, options);
}

}  // namespace lightwell
