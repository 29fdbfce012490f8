#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "scene/sampling.h"
#include "scene/surface_point.h"

namespace lightwell {

/// Directions out of a narrow gap between two surfaces that face each other.
///
/// Deep in a gap of width w, cosine-distributed rays end on the surface opposite, about w away; one
/// in (r / w)^2 goes farther than r, and these few bring the light. Here tan(theta), which is r /
/// w, is distributed evenly on a scale of logarithms instead, in an azimuth phi about the normal:
///
///     q = C / (2 pi cos sin^2)           1/sr, for 1 < tan < T,  C = 1 / (ln T + 1/2)
///     q = C T^2 cos / (2 pi sin^4)       for tan > T, as many as cosine-distributed ones
///
/// Pilot rays tell in which cells of (log tan, phi) the gap has its exits; half of the directions
/// are drawn there, in proportion to the light that even surroundings would send (Vorba et al.
/// 2014, "On-line learning of parametric mixture models", guide paths so), half in all cells. Where
/// a gather has fewer rays than pilots would take, all are drawn in all cells.
class GapExits {
 public:
  /// True if a ray is out of the gap.
  using IsOut = std::function<bool(const Ray& ray, const ElementHit& hit)>;

  /// The exits seen from a point of a surface in a gap of `width` metres that ends about `reach`
  /// metres away at most. `key` decides the pilot rays.
  GapExits(const ElementCaster& caster, const SurfacePoint& at, double width, double reach,
           std::uint64_t key, const IsOut& is_out);

  /// Directions of the same gap that are drawn in all cells alike, without pilot rays.
  GapExits(const SurfacePoint& at, double width, double reach);

  /// True if no pilot ray got out.
  bool is_closed() const { return is_closed_; }

  double width() const { return width_; }                    ///< metres
  const Eigen::Vector3d& across() const { return across_; }  ///< normal of the point, unit

  /// Unit direction above a surface in the gap, whose unit normal `normal` is about that of the
  /// point or the opposite one; u, v and `which` are random numbers in [0,1).
  Eigen::Vector3d draw(const Eigen::Vector3d& normal, double u, double v, double which) const;
  /// Probability density q of draw()'s directions, 1/sr.
  double density(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) const;

  /// Number of rays of a gather from which on pilot rays, of which there are as many, are worth
  /// their time.
  static constexpr int fewest_rays = 256;
  /// Number of rays aimed at exits beside `rays` cosine-distributed ones.
  static int aimed(int rays) { return rays; }

 private:
  static constexpr int side = 16;  // rows and columns of cells
  static_assert(side * side == fewest_rays);

  // Axes beside a normal, nearest to those of the point.
  Eigen::Matrix<double, 3, 2> frame(const Eigen::Vector3d& normal) const;
  // Coordinates of a direction in [0,1)^2, of (log tan, phi); below 0: too steep.
  Eigen::Array2d coordinates(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) const;
  Eigen::Vector3d direction_at(const Eigen::Vector3d& normal, double s, double turn) const;
  double even_density(double cosine) const;

  Eigen::Vector3d a_ = Eigen::Vector3d::UnitX(), b_ = Eigen::Vector3d::UnitY();  // in the gap
  Eigen::Vector3d across_ = Eigen::Vector3d::UnitZ();
  double width_ = 0.0;
  double log_reach_ = 1.0;  // ln T
  bool is_closed_ = false;
  std::vector<double> cell_up_to_{};  // running sum of probabilities, row by row
};

}  // namespace lightwell
