#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "raytrace/caustics/light_regions.h"

namespace lightwell {

/// Integral of Epanechnikov's kernel beyond a directed edge: over the part of the unit disc that
/// lies beyond the edge, between the directions of the edge's ends. The kernel is
///
///     K(s) = 2 / pi (1 - s^2), with the integral 1 over the disc.
///
/// The ends lie in the plane of the disc, relative to its centre, in units of its radius. The
/// result is negative if the edge runs clockwise about the centre. For counter-clockwise edges all
/// around an area, 1 minus the sum over edges is the integral of the kernel within the area
/// (Green's theorem).
double kernel_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// Share of the unit disc's area beyond a directed edge, with ends and sign as for kernel_beyond().
/// The whole disc counts as 1.
double disc_beyond(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// A disc that reaches over a boundary, with the part beyond the boundary folded back as at a
/// mirror (Schuster 1985). Even light thus stays even up to a straight edge and into a right
/// corner.
struct FoldedDisc {
  std::vector<Eigen::Vector3d> mirrored{};  ///< centres of the disc's mirror images
  /// Integral within the boundary of the disc's kernel and those of its mirror images; at least
  /// 0.02.
  double within = 1.0;
};

/// Folds a disc at `edges`: all edges of the boundary that the disc reaches over, counter-clockwise
/// about the inside when seen against the disc's unit normal. Edges are projected along the normal.
FoldedDisc fold(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                std::span<const LightRegions::Edge> edges);

/// Share of the disc's area within the boundary, at least 0.02. `edges` as for fold().
double disc_within(const Eigen::Vector3d& center, const Eigen::Vector3d& normal, double radius,
                   std::span<const LightRegions::Edge> edges);

}  // namespace lightwell
