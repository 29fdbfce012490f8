#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "raytrace/light_regions.h"

namespace lightwell {

/// Epanechnikov's kernel over a disc of radius 1, K(s) = 2 / pi (1 - s^2), integrates to 1.
///
/// What a directed edge, in the plane of the disc and relative to its centre, cuts off: the
/// kernel's integral over the part of the disc that lies beyond it, between the directions of its
/// ends; negative if the edge runs clockwise. Counter-clockwise edges all around an area thus leave
/// 1 minus their sum of the kernel within it (Green's theorem).
double kernel_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// The same of the disc's area, the whole of which counts as 1.
double disc_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// A disc that reaches over a boundary: what lies beyond is folded back, as at a mirror (Schuster
/// 1985), so that even light stays even up to a straight edge and into a right corner.
struct FoldedDisc {
  std::vector<Eigen::Vector3d> mirrored{};  ///< centres of the discs behind those mirrors
  double within = 1.0;  ///< of the kernels of all, what lies within the boundary; 0.02 at least
};

/// All edges of the boundary that the disc reaches over are given, counter-clockwise about the
/// inside seen against its unit normal; they are seen along that.
FoldedDisc fold(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                std::span<const LightRegions::Edge> edges);

/// The share of the disc's area that lies within; 0.02 at least.
double disc_within(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                   std::span<const LightRegions::Edge> edges);

}  // namespace lightwell
