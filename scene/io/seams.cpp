#include "scene/io/seams.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "scene/io/convex_cut.h"

namespace lightwell {
namespace {

// Vertex numbers of a loop; equal positions share a number.
class Numbered {
 public:
  explicit Numbered(const Loop& loop) {
    std::map<std::array<double, 3>, int> known;
    for (const Eigen::Vector3d& p : loop) {
      const std::array<double, 3> key = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
      const auto [entry, is_new] = known.emplace(key, static_cast<int>(positions_.size()));
      if (is_new) positions_.push_back(p);
      corners_.push_back(entry->second);
    }
    tolerance_ = flatness * size_of(loop);
  }

  // The loop's edges, split at the vertices that lie on them.
  std::vector<std::pair<int, int>> edges() const {
    std::vector<std::pair<int, int>> result;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      int from = corners_[i];
      const int to = corners_[(i + 1) % corners_.size()];
      for (const int on_the_way : between(from, to)) {
        result.emplace_back(from, on_the_way);
        from = on_the_way;
      }
      result.emplace_back(from, to);
    }
    return result;
  }

  const Eigen::Vector3d& position(int vertex) const {
    return positions_[static_cast<std::size_t>(vertex)];
  }

 private:
  std::vector<int> between(int from, int to) const {
    const Eigen::Vector3d a = position(from), edge = position(to) - a;
    const double length = edge.norm();
    std::vector<std::pair<double, int>> found;
    for (int v = 0; length > tolerance_ && v < static_cast<int>(positions_.size()); ++v) {
      if (v == from || v == to) continue;
      const double along = (position(v) - a).dot(edge) / length;
      if (!(along > tolerance_ && along < length - tolerance_)) continue;
      if ((position(v) - a - edge * (along / length)).norm() <= tolerance_) {
        found.emplace_back(along, v);
      }
    }
    std::ranges::sort(found);
    std::vector<int> result;
    for (const auto& [along, v] : found) result.push_back(v);
    return result;
  }

  std::vector<Eigen::Vector3d> positions_;
  std::vector<int> corners_;
  double tolerance_ = 0.0;
};

// Edges by their first vertex, without pairs of opposite edges.
std::multimap<int, int> without_seams(const std::vector<std::pair<int, int>>& edges) {
  std::multimap<int, int> kept;
  for (const auto& [from, to] : edges) {
    const auto [first, last] = kept.equal_range(to);
    const auto back =
        std::find_if(first, last, [origin = from](const auto& e) { return e.second == origin; });
    if (back != last) {
      kept.erase(back);
    } else {
      kept.emplace(from, to);
    }
  }
  return kept;
}

}  // namespace

std::optional<Polygon> without_seams(const Loop& loop) {
  const Numbered numbered(loop);
  const auto edges = numbered.edges();
  std::multimap<int, int> left = without_seams(edges);
  if (left.size() == edges.size()) return std::nullopt;
  const Eigen::Vector3d normal = area_vector(loop);
  Polygon result;
  while (!left.empty()) {
    Loop part;
    const int start = left.begin()->first;
    int at = start;
    do {
      const auto next = left.find(at);
      if (next == left.end()) return std::nullopt;
      part.push_back(numbered.position(at));
      at = next->second;
      left.erase(next);
    } while (at != start);
    if (area_vector(part).dot(normal) < 0.0) {
      result.holes.push_back(std::move(part));
    } else if (result.boundary.empty()) {
      result.boundary = std::move(part);
    } else {
      return std::nullopt;
    }
  }
  if (result.boundary.empty()) return std::nullopt;
  return result;
}

}  // namespace lightwell
