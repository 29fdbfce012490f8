#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "viewer/export/baked_model.h"

namespace lightwell {

/// Cosine of how much the faces of a chart may turn away: of a projected face at least nine tenths
/// of the area are left.
inline const double most_turned = std::cos(25.0 * std::numbers::pi / 180.0);

/// Twice a face's area, along its normal.
Eigen::Vector3d face_vector(const BakedModel& model, int face);

/// Which faces of a part hang together: those that share a vertex, and those of two facets that
/// meet in an edge, even if the mesh has vertices of its own for each because they meet in a
/// crease. Faces in one plane that do not share vertices have something between them.
class ChartNeighbours {
 public:
  ChartNeighbours(const BakedModel& model, const BakedPart& part);

  /// Calls see(face) for each of them; for some several times.
  template <class See>
  void around(int face, See&& see) const {
    for (int c = 0; c < model_.corner_count(face); ++c)
      see_all(around_, model_.faces[face][c], see);
    see_all(across_, face, see);
  }
  /// One vertex for all that are joined in creases.
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
  Pairs around_{};           // vertex and face
  Pairs across_{};           // two faces
  std::vector<int> weld_{};  // union-find over the part's vertices
};

}  // namespace lightwell
