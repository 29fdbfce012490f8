#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace lightwell {

/// Relief of materials on the facets of a scene, where facets have texture coordinates. Facets are
/// numbered through the scene (see scene_facets). Keeps no reference to the scene.
class FacetRelief {
 public:
  explicit FacetRelief(const Scene& scene);

  /// True if no facet has relief.
  bool is_empty() const { return entry_of_.empty(); }
  bool is_given(int facet) const {
    return !entry_of_.empty() && entry_of_[static_cast<std::size_t>(facet)] >= 0;
  }
  /// Gradient, in the facet's plane, of the height over the facet's front about `point` (metres),
  /// the mean over the parallelogram with sides `footprint` (columns, metres). At most
  /// steepest_relief long. The facet has relief.
  Eigen::Vector3d rise(int facet, const Eigen::Vector3d& point,
                       const Eigen::Matrix<double, 3, 2>& footprint) const;
  /// Hash of all that decides the relief; 0 if is_empty().
  std::uint64_t hash() const { return hash_; }

 private:
  struct Entry {
    int relief = 0;
    UvMap uv{};
    /// Gradient of the height for slopes of 1 to the right and downwards of the picture.
    Eigen::Matrix<double, 3, 2> of_slopes = Eigen::Matrix<double, 3, 2>::Zero();
  };
  void add_to_hash(const Entry& entry);

  std::vector<Relief> reliefs_{};
  std::vector<Entry> entries_{};  // one for each UvMap of a surface that has relief
  std::vector<int> entry_of_{};   // by facet; -1: no relief; empty: no facet has any
  std::uint64_t hash_ = 0;
};

}  // namespace lightwell
