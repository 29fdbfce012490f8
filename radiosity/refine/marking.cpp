#include "radiosity/refine/marking.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radiosity/refine/element_limits.h"

namespace lightwell {
namespace {

// Ratio from which on two errors count as equal. Symmetric cells are then split together, and
// rounding does not choose between them.
constexpr double about_equal = 0.999;

}  // namespace

// A refinement that may continue later ends by the error that is expected of children. Otherwise
// cells that count are measured.
Marking::Marking(const RefinedElements& elements, const CellErrors& errors, int part_count,
                 int max_level, bool may_go_on)
    : elements_(elements),
      errors_(errors),
      max_level_(max_level),
      smallest_(std::ldexp(typical_leaf_area(elements), -2 * (max_level + 1))),
      of_children_(may_go_on ? CellErrors::of_a_split : 1.0),
      allowed_(static_cast<std::size_t>(part_count), 0.0),
      sum_(allowed_),
      measured_(allowed_) {}

// False for the smallest cells: those of the deepest level, and those of the start that are smaller
// by a level than such cells of most of the area are.
bool Marking::may_be_split(int cell) const {
  return elements_.level(cell) < max_level_ && elements_.area(cell) > smallest_;
}

bool Marking::are_reached() const {
  for (std::size_t p = 0; p < sum_.size(); ++p) {
    if (!is_reached(static_cast<int>(p))) return false;
  }
  return true;
}

std::vector<int> Marking::joined(const PartMarks& by_part) const {
  if (by_part.size() == 1) return by_part.front();
  std::vector<std::pair<double, int>> by_share;
  for (std::size_t p = 0; p < by_part.size(); ++p) {
    for (const int cell : by_part[p]) {
      by_share.emplace_back(-counted(cell, static_cast<int>(p)) / allowed_[p], cell);
    }
  }
  std::ranges::sort(by_share);
  std::vector<int> marks;
  std::vector<char> is_marked(static_cast<std::size_t>(elements_.cell_count()), 0);
  for (const auto& [share, cell] : by_share) {
    if (is_marked[cell] == 0) marks.push_back(cell);
    is_marked[cell] = 1;
  }
  return marks;
}

Marking::PartMarks Marking::mark() {
  std::vector<std::vector<std::pair<double, int>>> by_error(allowed_.size());
  std::ranges::fill(sum_, 0.0);
  std::ranges::fill(measured_, 0.0);
  std::vector<double> rest(allowed_.size(), 0.0);
  for (const int cell : elements_.leaves()) {
    errors_.for_each_part(cell, [&](int p) {
      const double square = counted(cell, p);
      sum_[p] += square;
      if (errors_.is_measured(cell)) measured_[p] += square;
      if (may_be_split(cell) && square > 0.0) {
        by_error[p].emplace_back(-square, cell);
        rest[p] += square;
      }
    });
  }
  PartMarks marks(allowed_.size());
  for (std::size_t p = 0; p < marks.size(); ++p) {
    const int part = static_cast<int>(p);
    if (marks.size() > 1 && is_reached(part)) continue;
    marks[p] = worst_half(by_error[p], rest[p], part);
  }
  return marks;
}

// The first of the cells (minus the squared error, and the cell), whose squared errors sum to
// `all`, that are to be split for a part.
std::vector<int> Marking::worst_half(std::vector<std::pair<double, int>>& by_error, double all,
                                     int part) const {
  std::sort(by_error.begin(), by_error.end());
  const double allowed = allowed_[part], fixed = sum_[part] - all;
  double rest = all, last = 0.0;
  std::vector<int> marks;
  for (const auto& [minus_square, cell] : by_error) {
    // The last round splits no more than the tolerance takes by expectation. A shortfall takes one
    // more round, which costs less than additional splits in every case.
    constexpr double nearly = 0.95;
    const bool will_do = fixed + rest + of_children_ * (all - rest) <= nearly * allowed;
    const bool is_enough = rest <= 0.5 * allowed || will_do;
    if (is_enough && (marks.empty() || -minus_square < about_equal * last)) break;
    rest += minus_square;
    if (!is_enough) last = -minus_square;
    marks.push_back(cell);
  }
  return marks;
}

std::vector<int> Marking::worst_of(PartMarks by_part, std::size_t most) const {
  constexpr double of_a_child = CellErrors::of_a_split / 4.0;
  for (std::size_t p = 0; p < by_part.size(); ++p) {
    if (by_part[p].empty() || measured_[p] <= allowed_[p]) continue;
    const auto error = [&](int cell) { return counted(cell, static_cast<int>(p)); };
    const double least = about_equal * of_a_child * error(by_part[p].front());
    const auto end =
        std::ranges::find_if(by_part[p], [&](int cell) { return error(cell) < least; });
    by_part[p].erase(end, by_part[p].end());
  }
  std::vector<int> marks = joined(by_part);
  if (marks.size() > most) marks.resize(most);
  return marks;
}

}  // namespace lightwell
