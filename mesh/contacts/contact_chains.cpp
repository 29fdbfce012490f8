#include "mesh/contacts/contact_chains.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace lightwell {
namespace {

using Eigen::Vector3d;
using Piece = std::array<int, 2>;

// Lengths as shares of the element size.
constexpr double moved_share = 0.005;  // largest distance of a joined line from the original
constexpr double most_share = 0.5;     // longest joined piece
constexpr double fine_share = 0.1;     // only shorter pieces are joined

double distance_to(const Vector3d& q, const Vector3d& a, const Vector3d& b) {
  const Vector3d d = b - a;
  const double squared = d.squaredNorm();
  const double t = squared > 0.0 ? std::clamp(d.dot(q - a) / squared, 0.0, 1.0) : 0.0;
  return (q - a - t * d).norm();
}

// Appends the chain to `joined` in pieces no longer than `most`, within `tolerance` of the chain.
void join(const std::vector<int>& chain, const std::vector<Vector3d>& points, double tolerance,
          double most, std::vector<Piece>& joined) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, chain.size() - 1}};
  while (!open.empty()) {
    const auto [begin, end] = open.back();
    open.pop_back();
    const Vector3d &a = points[chain[begin]], &b = points[chain[end]];
    std::size_t at = begin + (end - begin) / 2;
    double farthest = tolerance;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const double distance = distance_to(points[chain[i]], a, b);
      if (distance > farthest) {
        farthest = distance;
        at = i;
      }
    }
    const bool fits = farthest <= tolerance && (b - a).norm() <= most && chain[begin] != chain[end];
    if (end == begin + 1 || fits) {
      joined.push_back({chain[begin], chain[end]});
      continue;
    }
    open.emplace_back(at, end);
    open.emplace_back(begin, at);
  }
}

}  // namespace

FacetOutline with_joined_contacts(const FacetOutline& outline, const std::vector<Vector3d>& points,
                                  double element_size) {
  const std::vector<Piece>& pieces = outline.contacts;
  std::map<int, std::vector<std::size_t>> at;  // pieces by point
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const int p : pieces[i]) at[p].push_back(i);
  }
  std::set<int> fixed;
  for (const auto& loop : outline.loops) fixed.insert(loop.begin(), loop.end());
  for (const auto& crease : outline.creases) fixed.insert(crease.begin(), crease.end());
  for (const auto& [a, b] : pieces) {
    if ((points[a] - points[b]).norm() >= fine_share * element_size) fixed.insert({a, b});
  }
  const auto is_end = [&](int p) { return at[p].size() != 2 || fixed.contains(p); };

  FacetOutline result = outline;
  result.contacts.clear();
  std::vector<char> is_used(pieces.size(), 0);
  const auto follow = [&](std::size_t first, int from) {
    std::vector<int> chain{from};
    for (std::size_t i = first;;) {
      is_used[i] = 1;
      chain.push_back(pieces[i][0] == chain.back() ? pieces[i][1] : pieces[i][0]);
      if (is_end(chain.back()) || chain.back() == from) break;
      const auto& both = at[chain.back()];
      i = both[0] == i ? both[1] : both[0];
    }
    // A line between two free ends keeps a point, at which the values on the line's two sides can
    // differ.
    const bool is_free = at[from].size() == 1 && at[chain.back()].size() == 1 &&
                         !fixed.contains(from) && !fixed.contains(chain.back());
    if (is_free && chain.size() > 2) {
      const auto middle = chain.begin() + static_cast<std::ptrdiff_t>(chain.size() / 2);
      const std::vector<int> rest(middle, chain.end());
      chain.erase(middle + 1, chain.end());
      join(rest, points, moved_share * element_size, most_share * element_size, result.contacts);
    }
    join(chain, points, moved_share * element_size, most_share * element_size, result.contacts);
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const int p : pieces[i]) {
      if (!is_used[i] && is_end(p)) follow(i, p);
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (!is_used[i]) follow(i, pieces[i][0]);  // a ring
  }
  return result;
}

}  // namespace lightwell
