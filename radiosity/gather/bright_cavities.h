#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/elements/element_caster.h"

namespace lightwell {

/// A bright patch, and the rays that leave it.
struct BrightPatch {
  int patch = -1;
  /// Share of its cosine-distributed rays that meet no bright patch; at least that of one ray,
  /// since points of the room may see a little of any patch.
  double openness = 1.0;
  /// Bright patches that its rays meet, in rising order; the patch itself may be among them.
  std::vector<int> met{};
};

/// A disc that light of a BrightCavity leaves through.
struct CavityMouth {
  int cavity = -1;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, outwards
  double radius = 0.0;                                ///< m

  bool is_before(const Eigen::Vector3d& point) const { return normal.dot(point - center) > 0.0; }
  double area() const;  ///< m^2
  /// A point uniform over the disc for (u, v) uniform in [0,1)^2.
  Eigen::Vector3d point(double u, double v) const;
  /// Radiant intensity in a unit direction, all columns, W/sr. Rough, and at least a tenth of the
  /// mean over all directions.
  double intensity(const Eigen::Vector3d& direction) const;

  static constexpr int rings = 8, sectors = 16;  ///< of cells of equal solid angle
  std::array<float, rings * sectors> cells{};    ///< intensity, W/sr
};

/// Bright patches that mostly see each other, as those within the shade of a spotlight do. Points
/// of the room see a part of them, through the cavity's mouths.
struct BrightCavity {
  std::vector<int> patches{};  ///< in rising order
  /// Radiosity of the place that a unit of the patches' power comes from, in the mean, W/m^2.
  double brightness = 0.0;
};

/// Cavities with their mouths, which are in rising order of their cavities.
struct BrightCavities {
  std::vector<BrightCavity> cavities{};
  std::vector<CavityMouth> mouths{};
};

/// The cavities among bright patches, which are in rising order. Without a mouth through which most
/// directions meet the cavity, as with a long cove, there is none. `of_element`: brightness of
/// every element of the mesh, W/m^2. The same bits for any number of threads.
BrightCavities find_cavities(const ElementCaster& caster, const std::vector<BrightPatch>& bright,
                             const std::vector<double>& of_element);

}  // namespace lightwell
