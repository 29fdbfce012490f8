#include "mesh/facets/group_patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace lightwell {
namespace {

// Share of a cell's area below which a group joins a neighbour. The value matters little: shares
// of 0, 0.05, 0.15 and 0.3 give 1778, 1778, 1756 and 1750 front patches of the Cornell box, and
// 8272, 8228, 8219 and 8213 of a furnished room.
constexpr double least_cell_share = 0.15;

class Groups {
 public:
  explicit Groups(const std::vector<PlacedElement>& elements)
      : parent_(elements.size()), area_(elements.size()) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      area_[i] = elements[i].area;
      box_.push_back(elements[i].box);
      cell_size_.push_back(elements[i].cell_size);
    }
  }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  // The lower number stays the root, so the roots do not depend on the order of joining.
  void join(int a, int b) {
    a = root(a), b = root(b);
    if (a == b) return;
    if (a > b) std::swap(a, b);
    parent_[b] = a;
    area_[a] += area_[b];
    box_[a].extend(box_[b]);
    cell_size_[a] = cell_size_[a].cwiseMax(cell_size_[b]);
  }
  double area(int root) const { return area_[root]; }
  double cell_area(int root) const { return cell_size_[root].prod(); }
  bool is_small(int root) const { return area(root) < least_cell_share * cell_area(root); }
  bool fit_together(int a, int b) const {
    constexpr double outgrown = 1.5;
    const Eigen::Vector2d extent = box_[a].merged(box_[b]).sizes();
    return (extent.array() <= outgrown * cell_size_[a].cwiseMax(cell_size_[b]).array()).all();
  }

 private:
  std::vector<int> parent_;
  std::vector<double> area_;
  std::vector<Eigen::AlignedBox2d> box_;
  std::vector<Eigen::Vector2d> cell_size_;  // the largest of each group
};

}  // namespace

std::vector<int> group_patches(const std::vector<PlacedElement>& elements,
                               const std::vector<ElementContact>& contacts) {
  const int count = static_cast<int>(elements.size());
  Groups groups(elements);
  for (const ElementContact& c : contacts) {
    if (elements[c.one].cell == elements[c.other].cell) groups.join(c.one, c.other);
  }
  // Border lengths of every group, by the root of the group across.
  std::vector<std::map<int, double>> border(count);
  for (const ElementContact& c : contacts) {
    const int a = groups.root(c.one), b = groups.root(c.other);
    if (a == b) continue;
    border[a][b] += c.length;
    border[b][a] += c.length;
  }
  const auto share_of_cell = [&](int i) {
    return std::round(1e6 * groups.area(i) / groups.cell_area(i));
  };
  std::vector<int> small;
  for (int i = 0; i < count; ++i) {
    if (groups.root(i) == i && groups.is_small(i)) small.push_back(i);
  }
  std::stable_sort(small.begin(), small.end(),
                   [&](int a, int b) { return share_of_cell(a) < share_of_cell(b); });
  for (int i : small) {
    const int group = groups.root(i);
    if (group != i || !groups.is_small(group)) continue;
    int best = -1;
    double longest = 0.0;
    constexpr double clearly = 1.0 + 1e-6;  // the first of equals wins, in every unit of length
    for (const auto& [other, length] : border[group]) {
      if (length > clearly * longest && groups.fit_together(group, groups.root(other))) {
        best = other;
        longest = length;
      }
    }
    if (best < 0) continue;
    const int other = groups.root(best);
    groups.join(group, other);
    const int kept = groups.root(group), gone = kept == group ? other : group;
    for (const auto& [next, length] : border[gone]) {
      if (groups.root(next) != kept) border[kept][groups.root(next)] += length;
    }
  }
  std::vector<int> order, number(count, -1), patch(count);
  for (int i = 0; i < count; ++i) {
    if (groups.root(i) == i) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return elements[a].cell < elements[b].cell; });
  for (int p = 0; p < static_cast<int>(order.size()); ++p) number[order[p]] = p;
  for (int i = 0; i < count; ++i) patch[i] = number[groups.root(i)];
  return patch;
}

}  // namespace lightwell
