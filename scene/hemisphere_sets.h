#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace lightwell {

/// A direction, and which point of a sequence it is of.
struct HemispherePoint {
  float x, y, z;  ///< unit, about +z with density cos(theta)/pi
  int rank;       ///< its place in the sequence, counted from the beginning of its block
};

/// Ready-made sets of directions and of places on a patch that they leave from, each an
/// Owen-scrambled 4-D Sobol sequence of its own.
/// Whoever casts from very many patches draws one for each and makes it its own by a shift of the
/// places (Cranley & Patterson 1976) and a turn of the directions about the normal, which costs a
/// fraction of making the points.
/// Points come in blocks, each in an order in which neighbours point nearly alike, so that rays
/// cast one after the other go down much the same way in the tree.
class HemisphereSets {
 public:
  static constexpr int block = 1024;
  /// Sets of `count` >= 1 points; without places for who casts from points.
  explicit HemisphereSets(int count, bool with_planar_points = false);
  int count() const { return count_; }

  class Draw {
   public:
    std::span<const HemispherePoint> all() const { return points_; }
    /// The points first .. first + size - 1 of the sequence; `first` a multiple of `block`, size at
    /// most `block`. `some` keeps them where they are not all of a block.
    std::span<const HemispherePoint> points(int first, int size,
                                            std::vector<HemispherePoint>& some) const;
    /// The place of a point of the block that begins at `first`, shifted; in [0,1)^2.
    Eigen::Vector2d planar_point(int first, const HemispherePoint& point) const {
      const Eigen::Vector2f& planar = planar_points_[static_cast<std::size_t>(first + point.rank)];
      return {wrapped(planar.x() + shift_.x()), wrapped(planar.y() + shift_.y())};
    }
    /// Columns: the frame about the unit vector `normal` in which the points' directions are meant.
    Eigen::Matrix3d frame(const Eigen::Vector3d& normal) const;

   private:
    friend class HemisphereSets;
    // Half of all sums pass 1, and no processor foresees which: no branch.
    static double wrapped(double x) { return x - static_cast<int>(x); }
    std::span<const HemispherePoint> points_{};
    std::span<const Eigen::Vector2f> planar_points_{};  // in the sequence's order
    Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();
    double cosine_ = 1.0, sine_ = 0.0;  // of the turn
  };
  /// The same key draws the same set, shift and turn.
  Draw draw(std::uint64_t key) const;

 private:
  int count_;
  int sets_;
  std::vector<HemispherePoint> points_;         // set by set
  std::vector<Eigen::Vector2f> planar_points_;  // the same, or none
};

}  // namespace lightwell
