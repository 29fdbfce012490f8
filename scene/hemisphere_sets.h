#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// A direction of the hemisphere and its rank in a sequence of sample points.
struct HemispherePoint {
  float x, y, z;  ///< unit, about +z with density cos(theta)/pi
  int rank;       ///< index in the sequence, counted from the beginning of the block
};

/// Precomputed sets of hemisphere directions and of sample points on a patch, each an
/// Owen-scrambled 4-D Sobol sequence.
///
/// A caller with very many patches draws one set for each patch, with a shift of the sample points
/// (Cranley & Patterson 1976) and a turn of the directions about the normal. Shift and turn cost a
/// fraction of the making of new points.
///
/// Points come in blocks. Neighbours in a block point nearly alike, so that rays cast one after the
/// other visit much the same nodes of the tree.
class HemisphereSets {
 public:
  static constexpr int block = 1024;
  /// Makes sets of `count` >= 1 directions. `with_planar_points`: also makes sample points on a
  /// patch; rays from a single point need none.
  explicit HemisphereSets(int count, bool with_planar_points = false);
  int count() const { return count_; }

  /// One set with a shift and a turn.
  class Draw {
   public:
    std::span<const HemispherePoint> all() const { return points_; }
    /// Points first .. first + size - 1 of the sequence; `first` is a multiple of `block`, `size`
    /// at most `block`. `some` holds the points if they are not a whole block.
    std::span<const HemispherePoint> points(int first, int size,
                                            std::vector<HemispherePoint>& some) const;
    /// Sample point on the patch, shifted, in [0,1)^2, for a point of the block that begins at
    /// `first`.
    Eigen::Vector2d planar_point(int first, const HemispherePoint& point) const {
      const Eigen::Vector2f& planar = planar_points_[static_cast<std::size_t>(first + point.rank)];
      return {wrapped(planar.x() + shift_.x()), wrapped(planar.y() + shift_.y())};
    }
    /// Frame whose columns are the axes of the points' directions, turned about the unit vector
    /// `normal`, the last column.
    Eigen::Matrix3d frame(const Eigen::Vector3d& normal) const;

   private:
    friend class HemisphereSets;
    // No branch: half of all sums exceed 1, unpredictably.
    static double wrapped(double x) { return x - static_cast<int>(x); }
    std::span<const HemispherePoint> points_{};
    std::span<const Eigen::Vector2f> planar_points_{};  // in the sequence's order
    Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();
    double cosine_ = 1.0, sine_ = 0.0;  // of the turn
  };
  /// Draws a set, a shift and a turn that depend on `key` only.
  Draw draw(std::uint64_t key) const;

 private:
  int count_;
  int sets_;
  std::vector<HemispherePoint> points_;         // set by set
  std::vector<Eigen::Vector2f> planar_points_;  // set by set, in the sequence's order; or empty
};

}  // namespace lightwell
