#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/io/remarks.h"
#include "scene/io/stf/stf_plan.h"

namespace lightwell {

/// A window, door or skylight of a file: furniture of the names `win`, `door` and `skylight`.
struct StfOpening {
  enum class Kind { window, door, skylight };
  Kind kind = Kind::window;
  std::string name{};  ///< for remarks
  /// m above the floor of the room: the middle of the lower edge; of a skylight its middle in plan.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double width = 0.0, height = 0.0;     ///< m; of a skylight along x and y
  double turn = 0.0;                    ///< degrees about z, of a skylight
  std::optional<double> reflectance{};  ///< [0,1]; empty: not given
};

/// An opening as a polygon of its wall or ceiling; its front faces into the room.
struct PlacedOpening {
  StfOpening opening{};
  Loop outline{};
};

/// Places the openings of a room. A window or door lies in the wall that is nearest to it, whatever
/// its rotation.
class StfOpenings {
 public:
  /// Keeps references.
  StfOpenings(const StfPlan& plan, Remarks& remarks);

  /// Adds an opening. What reaches beyond its wall is cut off, and an opening that overlaps an
  /// earlier one or does not lie within the ceiling is left out, both with a remark.
  void add(StfOpening opening);

  const std::vector<PlacedOpening>& in_wall(std::size_t wall) const { return walls_[wall]; }
  const std::vector<PlacedOpening>& in_ceiling() const { return ceiling_; }

  static constexpr std::size_t most = 1000;              ///< openings of a room
  static constexpr std::size_t most_pairs = 10'000'000;  ///< openings times walls: some seconds

 private:
  /// A rectangle on a wall: along it from its first corner, and above the floor, m.
  struct Extent {
    double left = 0.0, right = 0.0, bottom = 0.0, top = 0.0;
  };
  void add_to_wall(StfOpening opening);
  void add_to_ceiling(StfOpening opening);

  const StfPlan& plan_;
  Remarks& remarks_;
  std::vector<std::vector<PlacedOpening>> walls_;
  std::vector<std::vector<Extent>> extents_;  // of the openings of each wall
  std::vector<PlacedOpening> ceiling_{};
};

/// A rectangle of a wall; its front faces into the room.
Loop stf_wall_rectangle(const StfPlan& plan, std::size_t wall, const Eigen::Vector2d& along,
                        const Eigen::Vector2d& above);

}  // namespace lightwell
