#include "mesh/contacts/line_selection.h"

#include <algorithm>
#include <numeric>

#include "mesh/geometry/box_tree.h"
#include "mesh/geometry/cross.h"

namespace lightwell {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool do_cross(const FlatLine& e, const FlatLine& f) {
  for (const int p : e.point) {
    if (p == f.point[0] || p == f.point[1]) return false;
  }
  const auto parts = [](const FlatLine& line, const FlatLine& ends) {
    const Vector2d d = line.end[1] - line.end[0];
    return cross(d, ends.end[0] - line.end[0]) * cross(d, ends.end[1] - line.end[0]) < 0.0;
  };
  return parts(e, f) && parts(f, e);
}

BoxTree tree_of(const std::vector<FlatLine>& lines, std::vector<BoxTree::Box>& boxes) {
  for (const FlatLine& line : lines) {
    BoxTree::Box box(Vector3d(line.end[0].x(), line.end[0].y(), 0.0));
    boxes.push_back(box.extend(Vector3d(line.end[1].x(), line.end[1].y(), 0.0)));
  }
  return BoxTree(boxes);
}

}  // namespace

std::size_t count_crossings(const std::vector<FlatLine>& lines, std::size_t most) {
  std::vector<BoxTree::Box> boxes;
  const BoxTree tree = tree_of(lines, boxes);
  std::vector<int> near;
  std::size_t count = 0;
  for (std::size_t i = 0; i < lines.size() && count <= most; ++i) {
    tree.find_overlaps(boxes[i], near);
    for (const int j : near) {
      const auto other = static_cast<std::size_t>(j);
      if (other > i && do_cross(lines[i], lines[other])) ++count;
    }
  }
  return count;
}

std::vector<char> longest_lines(const std::vector<FlatLine>& lines, std::size_t most) {
  std::vector<std::size_t> order(lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto length = [&](std::size_t i) {
    return (lines[i].end[1] - lines[i].end[0]).squaredNorm();
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return length(a) > length(b); });
  std::vector<BoxTree::Box> boxes;
  const BoxTree tree = tree_of(lines, boxes);
  std::vector<char> kept(lines.size(), 0);
  std::vector<int> near;
  std::size_t total = 0;
  for (const std::size_t i : order) {
    tree.find_overlaps(boxes[i], near);
    std::size_t count = 0;
    for (const int j : near) {
      const auto other = static_cast<std::size_t>(j);
      if (kept[other] && do_cross(lines[i], lines[other])) ++count;
    }
    total += count;
    if (total > most) break;
    kept[i] = 1;
  }
  return kept;
}

}  // namespace lightwell
