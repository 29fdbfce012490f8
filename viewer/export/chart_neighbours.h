#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "viewer/export/baked_model.h"

namespace lightwell {

/// Cosine of 25 degrees, the largest angle between normals of faces that are grouped or joined: a
/// projected face keeps at least nine tenths of its area.
inline const double most_turned = std::cos(25.0 * std::numbers::pi / 180.0);

/// Normal of a face, not unit: its length is twice the face's area, m^2.
Eigen::Vector3d face_vector(const BakedModel& model, int face);

/// Neighbours of each face of a part.
/// - Faces that share a vertex are neighbours.
/// - Faces of two facets that meet at an edge in a crease of less than 25 degrees are neighbours,
///   although the mesh has separate vertices for the two facets.
/// - Coplanar faces that meet at an edge without a shared vertex are not: the light is
///   discontinuous between them.
class ChartNeighbours {
 public:
  ChartNeighbours(const BakedModel& model, const BakedPart& part);

  /// Calls see(neighbour) for each neighbour of `face`, for some several times, and for `face`.
  template <class See>
  void around(int face, See&& see) const {
    for (int c = 0; c < model_.corner_count(face); ++c)
      see_all(around_, model_.faces[face][c], see);
    see_all(across_, face, see);
  }
  /// Representative of the vertices that are joined to `vertex` in creases; the vertex itself
  /// where there are none.
  int joined(int vertex) const;

 private:
  using Pairs = std::vector<std::pair<int, int>>;
  template <class See>
  static void see_all(const Pairs& pairs, int key, See&& see) {
    for (auto at = std::lower_bound(pairs.begin(), pairs.end(), std::pair(key, -1));
         at != pairs.end() && at->first == key; ++at) {
      see(at->second);
    }
  }
  void find_creases(const BakedPart& part);
  std::vector<int> places(const BakedPart& part) const;

  const BakedModel& model_;
  int first_vertex_;
  Pairs around_{};             // (vertex, face), sorted
  Pairs across_{};             // (face, face) across a crease, both ways, sorted
  std::vector<int> joined_{};  // see joined(), by vertex of the part
};

}  // namespace lightwell
