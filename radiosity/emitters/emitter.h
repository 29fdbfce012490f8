#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "radiosity/closed_forms/polygon_form_factor.h"
#include "scene/scene.h"

namespace lightwell {

class EmissionTree;

/// An emitting facet whose light is a closed form times visibility, never left to random rays.
struct Emitter {
  int facet = 0;        ///< scene-wide facet number
  Spectrum exitance{};  ///< M, W/m^2, from PatchMesh::emission; the mean of a picture
  /// The picture by which the facet shines; null: it shines evenly.
  std::shared_ptr<const EmissionTree> picture{};
  Spectrum picture_scale{};  ///< exitance over the mean of `picture`
  double area = 0.0;         ///< m^2, one side
  bool emits_both_sides = false;
  bool is_sphere = false;
  Sphere sphere{};
  std::vector<Loop> loops{};  ///< boundary, then holes; counter-clockwise seen from the front
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  std::vector<std::array<Eigen::Vector3d, 3>> triangles{};  ///< tile the polygon, to place samples
  std::vector<double> area_cdf{};  ///< running share of the area, one per triangle, last is 1
  /// Middle of the area, and the greatest distance of a point from there, m.
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

}  // namespace lightwell
