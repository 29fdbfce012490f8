#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "raytrace/probe.h"
#include "scene/scene.h"

namespace lightwell {

/// Greatest distance between points of a grid over `length` metres, p = 0.2 * 5^log10(length), at
/// most 10 m (EN 12464-1:2011, formula 2). `length` > 0.
double greatest_grid_spacing(double length);

struct LuxGridOptions {
  double height = 0.0;   ///< m above the surface, along its normal
  double margin = 0.0;   ///< m along the outline that is left out, >= 0
  double spacing = 0.0;  ///< m between points, at most; 0: as EN 12464-1 has it
};

/// Points over a plane surface at which illuminance is asked for, in the middles of even cells.
struct LuxGrid {
  std::string name{};
  LuxGridOptions options{};  ///< with the spacing that was asked for, or the standard's
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< m, of the first cell, outer end
  Eigen::Vector3d u = Eigen::Vector3d::UnitX(), v = Eigen::Vector3d::UnitY();  ///< unit, in plane
  double step_u = 0.0, step_v = 0.0;  ///< m, sizes of a cell
  int columns = 0, rows = 0;
  double area = 0.0;            ///< m^2 of the surface, the margin included
  std::vector<int> cell{};      ///< row * columns + column of each point, rising
  std::vector<Probe> points{};  ///< those inside of the surface's outline less the margin
};

/// The grid over a surface: over those of its facets that lie in one plane and have most area of
/// all such; of two alike, over those that face more to `up`. Its axes follow the longest edge. By
/// EN 12464-1 the length that decides the spacing is the longer side, or the shorter of sides that
/// are more than 2 : 1. Throws InputError for a sphere, and where the margin leaves nothing.
LuxGrid lux_grid(const Scene& scene, int surface, const Eigen::Vector3d& up,
                 const LuxGridOptions& options = {});

/// The grid without points that are inside of bodies or on their faces, as those of a working plane
/// that a cupboard reaches through: from there, or from just beside, every ray that leaves the
/// plane meets the back of a surface. Where that is so of all points, the scene's surfaces face
/// away from its rooms, and all stay.
LuxGrid without_buried_points(const ElementCaster& caster, LuxGrid grid);

/// What a grid measured, lx.
struct LuxField {
  Eigen::ArrayXd lux{};  ///< at each point
  double mean = 0.0, least = 0.0, greatest = 0.0;
  double uniformity = 0.0;  ///< U_0 = least / mean; 0 without light
  /// Twice the standard error that the rays of the gathers leave (odds of 19 to 1), relative, in
  /// one point, and in the mean.
  double point_within = 0.0, mean_within = 0.0;
};

/// Illuminance at the points of a grid, times `factor` (a maintenance factor, say): two independent
/// gathers with half of the rays each, whose differences tell the error.
LuxField measure_grid(const Scene& scene, const ElementCaster& caster,
                      const DirectLight& direct_light, const RadiositySolution& solution,
                      const LuxGrid& grid, double factor, const GatherOptions& options);

}  // namespace lightwell
