#include "radiosity/refine/refine_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "radiosity/refine/interpolation_error.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// The expected share of a cell's squared error that is left in its parts: a sixteenth in smooth
// light, a half along the edge of a shadow, for which most cells (not all) are split. A refinement
// that may continue later ends by this expectation. Otherwise cells that count are measured, or
// taken to be as bad as their parents, and only the report expects a share, of a quarter.
constexpr double of_a_split = 0.4, of_a_split_in_the_end = 0.25;

// Ratio from which on two errors count as equal. Symmetric cells are then split together, and
// rounding does not choose between them.
constexpr double about_equal = 0.999;

// The limit that is asked for, or about the number of elements of a quarter of the edge everywhere,
// both sides counted. Elements that are small already are not split.
std::int64_t wanted_elements(const RefinedElements& elements, const RefineOptions& options) {
  if (options.max_elements > 0) return options.max_elements;
  const double typical = typical_leaf_area(elements);
  std::int64_t count = elements.element_count();
  for (const int cell : elements.leaves()) {
    if (elements.area(cell) > 0.25 * typical) count += 15 * elements.side_count(cell);
  }
  return count;
}

class Refinement {
 public:
  Refinement(RefinedElements& elements, InterpolationError& error, const RefineOptions& options,
             bool may_go_on)
      : elements_(elements),
        error_(error),
        options_(options),
        typical_area_(typical_leaf_area(elements)),
        max_elements_(most_elements(elements, options)),
        is_memory_short_(options.room >= 0 && options.room < wanted_elements(elements, options)),
        may_go_on_(may_go_on),
        of_children_(may_go_on ? of_a_split : 1.0),
        in_the_end_(may_go_on ? 1.0 : of_a_split_in_the_end),
        report_{.elements_at_first = elements.element_count()},
        part_count_(options.parts.group_count()),
        allowed_(static_cast<std::size_t>(part_count_), 0.0),
        sum_(allowed_) {
    resize();
    for (const int cell : elements.leaves()) {
      std::array<double, 2> expected{0.0, 0.0};
      for (int side = 0; side < elements.side_count(cell); ++side) {
        expected[side] = error.expected(cell, side);
      }
      set(cell, {.error = expected});
    }
  }

  // Splits until the tolerances or a limit are reached; a further call continues.
  RefineReport run(const RefineOptions& options) {
    options_.tolerance = options.tolerance;
    options_.efforts = options.efforts;
    for (int p = 0; p < part_count_; ++p) {
      allowed_[p] = std::pow(options.tolerance_of(judged(p)), 2) * error_.area(p);
    }
    for (const int cell : elements_.leaves()) {
      if (error_.is_stale(cell)) measured_[cell] = 0;
    }
    do {
      split_to_the_end();
      report_errors();
    } while (sharpen_sky());
    report_.elements = elements_.element_count();
    return report_;
  }

  // Includes half of the squared error that noise may hide, which is between none and all of it.
  float relative_error(int cell, int side) const {
    const Square& square = squares_[elements_.side_number(cell, side)];
    const double expected = double{square.known} + 0.5 * double{square.hidden};
    return static_cast<float>(std::sqrt(share_left(cell) * expected));
  }

 private:
  // Measures and splits until the tolerances or a limit are reached.
  void split_to_the_end() {
    report_.outcome = RefineOutcome::off;
    while (report_.outcome == RefineOutcome::off) {
      PartMarks by_part = cells_to_split();
      std::vector<int> marks = joined(by_part);
      // Measures no more cells than can be split, since each split adds at least three elements. (A
      // measured error is below its bound, and other cells come to the front.)
      const std::int64_t room =
          std::max<std::int64_t>(max_elements_ - elements_.element_count(), 0);
      constexpr std::size_t at_once = 4096;
      const std::size_t most = std::max(static_cast<std::size_t>(room / 3 + 1), at_once);
      if (marks.size() > most) marks.resize(most);
      if (are_reached()) {
        report_.outcome = RefineOutcome::tolerance_reached;
      } else if (report_.rounds > 0 && error_.run().is_time_up()) {
        report_.outcome = RefineOutcome::time_limit_reached;
      } else if (marks.empty()) {
        report_.outcome = RefineOutcome::smallest_size_reached;
      } else if (!measure(marks)) {
        if (!split(may_wait(marks) ? worst_of(std::move(by_part), most) : marks)) {
          report_.outcome = is_memory_short_ ? RefineOutcome::memory_limit_reached
                                             : RefineOutcome::max_elements_reached;
        }
        ++report_.rounds;
      }
    }
  }

  // Sharpens the light of the sky where its noise is notable beside the errors that are left, and
  // measures anew what was measured with it; returns whether there is such light.
  bool sharpen_sky() {
    if (report_.outcome == RefineOutcome::time_limit_reached) return false;
    std::vector<double> left;
    for (const PartRefinement& part : report_.parts) left.push_back(part.estimate);
    if (!error_.sharpen_sky(left)) return false;
    std::vector<int> again;
    for (const int cell : elements_.leaves()) {
      if (measured_[cell] == 0) continue;
      measured_[cell] = 0;
      again.push_back(cell);
    }
    measure(again);
    return true;
  }

  void resize() {
    squares_.resize(elements_.side_total());
    is_known_.resize(elements_.cell_count(), 0);
    measured_.resize(elements_.cell_count(), 0);
  }
  void set(int cell, const InterpolationError::Measured& squares) {
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      squares_[elements_.side_number(cell, side)] = {static_cast<float>(squares.error[side]),
                                                     static_cast<float>(squares.hidden[side])};
    }
    is_known_[cell] = 1;
  }

  // False for the smallest cells: those of the deepest level, and those of the start that are
  // smaller by a level than such cells of most of the area are.
  bool may_be_split(int cell) const {
    const double smallest = std::ldexp(typical_area_, -2 * (options_.max_level + 1));
    return elements_.level(cell) < options_.max_level && elements_.area(cell) > smallest;
  }

  bool are_reached() const {
    for (int p = 0; p < part_count_; ++p) {
      if (sum_[p] > allowed_[p]) return false;
    }
    return true;
  }

  int part_of(int cell, int side) const {
    return options_.parts.group_of(elements_.base().patch[elements_.element(cell, side)]);
  }
  // The part that a group is of.
  int judged(int group) const { return group % options_.parts.judged_count(); }

  double importance_of(int cell, int side) const {
    const int patch = elements_.base().patch[elements_.element(cell, side)];
    return double{options_.parts.importance_of(patch)};
  }

  // Calls visit(part) for the parts that the sides of a cell are in, once each.
  template <class Visit>
  void for_each_part(int cell, Visit&& visit) const {
    const int first = part_of(cell, 0);
    visit(first);
    if (elements_.side_count(cell) < 2) return;
    if (const int second = part_of(cell, 1); second != first) visit(second);
  }

  // Leaves to split for each part, in falling order of squared error.
  using PartMarks = std::vector<std::vector<int>>;

  // The leaves of all parts by the share that they hold of the error that is allowed, once each.
  std::vector<int> joined(const PartMarks& by_part) const {
    if (part_count_ == 1) return by_part.front();
    std::vector<std::pair<double, int>> by_share;
    for (int p = 0; p < part_count_; ++p) {
      for (const int cell : by_part[p])
        by_share.emplace_back(-counted(cell, p) / allowed_[p], cell);
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

  // The leaves with the largest squared errors of each part, so many that the others hold at most
  // half of what the part's tolerance allows. Also sums over all leaves.
  PartMarks cells_to_split() {
    std::vector<std::vector<std::pair<double, int>>> by_error(allowed_.size());
    std::ranges::fill(sum_, 0.0);
    std::vector<double> rest(allowed_.size(), 0.0);
    for (const int cell : elements_.leaves()) {
      for_each_part(cell, [&](int p) {
        const double square = counted(cell, p);
        sum_[p] += square;
        if (may_be_split(cell) && square > 0.0) {
          by_error[p].emplace_back(-square, cell);
          rest[p] += square;
        }
      });
    }
    PartMarks marks(allowed_.size());
    for (int p = 0; p < part_count_; ++p) {
      if (part_count_ > 1 && sum_[p] <= allowed_[p]) continue;
      marks[p] = worst_half(by_error[p], rest[p], p);
    }
    return marks;
  }

  // The first of the cells (minus the squared error, and the cell), whose squared errors sum to
  // `all`, that are to be split for a part.
  std::vector<int> worst_half(std::vector<std::pair<double, int>>& by_error, double all,
                              int part) const {
    std::sort(by_error.begin(), by_error.end());
    const double allowed = allowed_[part], fixed = sum_[part] - all;
    double rest = all, last = 0.0;
    std::vector<int> marks;
    for (const auto& [minus_square, cell] : by_error) {
      // The last round splits no more than the tolerance takes by expectation. A shortfall takes
      // one more round, which costs less than additional splits in every case.
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

  // Squared error times area. The error that noise may hide in a cell is nothing for the most part,
  // and counts only if it could be a notable share of all that is allowed. Such a cell is split,
  // and its parts are measured. Sides in other parts of the scene do not count, and those that
  // matter less for what somebody looks at count by their importance.
  double counted(int cell, int part) const {
    constexpr double notable = 0.01;
    double known = 0.0, hidden = 0.0;
    for (int side = 0; side < elements_.side_count(cell); ++side) {
      if (part_of(cell, side) != part) continue;
      const Square& square = squares_[elements_.side_number(cell, side)];
      const double importance = importance_of(cell, side);
      known += importance * double{square.known};
      hidden += importance * double{square.hidden};
    }
    known *= elements_.area(cell);
    hidden *= elements_.area(cell);
    return hidden > notable * allowed_[part] ? known + hidden : known;
  }

  // True if cells with smaller errors wait until the worst are split and measured: if refinement
  // may continue later, or if the limit of elements is near. Otherwise all are split at once, in
  // fewer rounds.
  bool may_wait(const std::vector<int>& marks) const {
    const auto made = 3 * static_cast<std::int64_t>(marks.size());
    return may_go_on_ || 2 * (elements_.element_count() + made) > max_elements_;
  }

  // The first of each part's leaves: those above the expected error of the first one's children,
  // and at most `most` in all. The others wait, so that elements go to the largest errors, however
  // few there may be.
  std::vector<int> worst_of(PartMarks by_part, std::size_t most) const {
    constexpr double of_a_child = of_a_split / 4.0;
    for (int p = 0; p < part_count_; ++p) {
      if (by_part[p].empty()) continue;
      const double least = about_equal * of_a_child * counted(by_part[p].front(), p);
      const auto end =
          std::ranges::find_if(by_part[p], [&](int cell) { return counted(cell, p) < least; });
      by_part[p].erase(end, by_part[p].end());
    }
    std::vector<int> marks = joined(by_part);
    if (marks.size() > most) marks.resize(most);
    return marks;
  }

  void report_errors() {
    std::vector<double> left(allowed_.size(), 0.0);
    for (const int cell : elements_.leaves()) {
      for_each_part(cell, [&](int p) { left[p] += share_left(cell) * counted(cell, p); });
    }
    report_.parts.clear();
    double worst = -1.0;
    for (int p = 0; p < options_.parts.judged_count(); ++p) {
      const double area = error_.area(p);
      report_.parts.push_back({.estimate = area > 0.0 ? std::sqrt(left[p] / area) : 0.0,
                               .is_reached = sum_[p] <= allowed_[p]});
      const double tolerance = options_.tolerance_of(p), estimate = report_.parts.back().estimate;
      if (!(estimate > worst * tolerance)) continue;
      worst = estimate / tolerance;
      report_.tolerance = tolerance;
      report_.estimate = estimate;
    }
  }

  double share_left(int cell) const {
    return measured_[cell] || elements_.level(cell) == 0 ? 1.0 : in_the_end_;
  }

  // Measures the cells that are not measured yet; returns whether there were any.
  bool measure(const std::vector<int>& cells) {
    std::vector<int> fresh;
    for (const int cell : cells) {
      if (!measured_[cell]) fresh.push_back(cell);
    }
    const std::vector<InterpolationError::Measured> measured = error_.measure(fresh);
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      set(fresh[i], measured[i]);
      measured_[fresh[i]] = 1;
    }
    return !fresh.empty();
  }

  // Splits all cells, or as many of the first as the limit of elements allows; returns whether all.
  bool split(const std::vector<int>& marks) {
    std::vector<int> done = elements_.split(marks);
    const bool all = elements_.element_count() <= max_elements_;
    if (!all) {
      const auto undo = [&] {
        std::ranges::reverse(done);
        elements_.merge(done);
      };
      undo();
      std::size_t low = 0, high = marks.size();  // low fits, high does not
      while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        done = elements_.split({marks.data(), middle});
        (elements_.element_count() <= max_elements_ ? low : high) = middle;
        undo();
      }
      elements_.split({marks.data(), low});
    }
    resize();
    // Expected errors of the children, until they are measured. (A child may be known already: a
    // cell that was merged is split into the same children again.)
    for (const int cell : elements_.leaves()) {
      if (is_known_[cell]) continue;
      for (int side = 0; side < elements_.side_count(cell); ++side) {
        const Square& whole = squares_[elements_.side_number(elements_.parent(cell), side)];
        squares_[elements_.side_number(cell, side)] = {
            static_cast<float>(whole.known * of_children_),
            static_cast<float>(whole.hidden * of_children_)};
      }
      is_known_[cell] = 1;
    }
    return all;
  }

  RefinedElements& elements_;
  InterpolationError& error_;
  RefineOptions options_;
  double typical_area_;  // of the start's cells
  std::int64_t max_elements_;
  bool is_memory_short_;
  bool may_go_on_;
  double of_children_, in_the_end_;
  RefineReport report_;
  int part_count_;  // of SceneParts::group_of(): each is refined as a part of its own
  std::vector<double> allowed_, sum_;  // of each part: squared error times area, over all leaves
  struct Square {
    float known = 0.0f, hidden = 0.0f;
  };
  std::vector<Square> squares_;            // per side, measured or expected
  std::vector<char> is_known_, measured_;  // per cell
};

}  // namespace

void require_room(const PatchMesh& mesh, const RefineOptions& options) {
  if (options.max_elements == 0 || mesh.element_count() <= options.max_elements) return;
  throw InputError(fmt::format(
      "at most {} elements are allowed, but the scene makes {} before any is refined; allow more, "
      "or use a larger patch size",
      options.max_elements, mesh.element_count()));
}

std::int64_t most_elements(const RefinedElements& elements, const RefineOptions& options) {
  const std::int64_t wanted = wanted_elements(elements, options);
  if (options.room < 0 || options.room >= wanted) return wanted;
  return std::max(options.room, elements.element_count());
}

double typical_leaf_area(const RefinedElements& elements) {
  std::vector<double> areas;
  double total = 0.0;
  for (const int cell : elements.leaves()) {
    areas.push_back(elements.area(cell));
    total += elements.area(cell);
  }
  std::sort(areas.begin(), areas.end(), std::greater<>());
  double typical = 0.0, larger = 0.0;
  for (std::size_t i = 0; i < areas.size() && larger < 0.5 * total; ++i) {
    typical = areas[i];
    larger += areas[i];
  }
  return typical;
}

namespace {

// The entry with the mesh's numbers of vertices in place of those of RefinedElements.
InterpolatedVertex renumbered(const InterpolatedVertex& at, const std::vector<int>& number) {
  InterpolatedVertex result{.vertex = number[at.vertex]};
  for (int i = 0; i < at.end_count(); ++i) result.ends[i] = number[at.ends[i]];
  return result;
}

// Adds the vertices that share gathers. All are the base's, and come before those of splits.
void add_shared(const InterpolationError& error, const PatchMesh& base, RefinedSolution& result) {
  std::vector<int> number(static_cast<std::size_t>(base.vertex_count()), -1);
  for (std::size_t v = 0; v < result.refined.vertex.size(); ++v) {
    const int of_base = result.refined.vertex[v];
    if (of_base < base.vertex_count()) number[of_base] = static_cast<int>(v);
  }
  for (const InterpolatedVertex& at : error.shared().unread) {
    result.unread.push_back(renumbered(at, number));
  }
  for (const int v : error.shared().rough) result.rough.push_back(number[v]);
  std::vector<InterpolatedVertex> first = result.unread;
  std::vector<VertexPrediction> predictions = error.shared_predictions();
  for (VertexPrediction& prediction : predictions) {
    prediction.at = renumbered(prediction.at, number);
    first.push_back(prediction.at);
  }
  result.interpolated.insert(result.interpolated.begin(), first.begin(), first.end());
  result.predictions.insert(result.predictions.begin(), predictions.begin(), predictions.end());
}

}  // namespace

struct SolutionRefinement::Impl {
  Impl(const LitScene& lit, const BandArray& radiosity, const BandArray& caustic,
       RefinedElements& all, const GatherOptions& gather, const RefineOptions& options)
      : elements(all),
        error(lit, radiosity, caustic, all, gather, options),
        refinement(all, error, options,
                   !options.efforts.empty() && options.efforts.front().noise > 0.0) {}

  RefinedElements& elements;
  InterpolationError error;
  Refinement refinement;
};

SolutionRefinement::SolutionRefinement(const LitScene& lit, const BandArray& radiosity,
                                       const BandArray& caustic, RefinedElements& elements,
                                       const GatherOptions& gather, const RefineOptions& options) {
  require_room(elements.base(), options);
  impl_ = std::make_unique<Impl>(lit, radiosity, caustic, elements, gather, options);
}

SolutionRefinement::~SolutionRefinement() = default;

RefinedSolution SolutionRefinement::refine(const RefineOptions& options,
                                           const ChannelLight* by_channel) {
  auto& [elements, error, refinement] = *impl_;
  error.set_tolerance(options);
  RefinedSolution result;
  result.report = refinement.run(options);
  result.refined = elements.mesh();
  elements.shrink_to_fit();
  result.interpolated = error.interpolated(result.refined.vertex);
  if (!by_channel) error.gather(result.refined.vertex, result.interpolated);
  error.shrink_to_fit();
  result.predictions = error.predictions(result.refined.vertex, result.interpolated);
  if (by_channel) {
    result.pilot = error.values_by_channel(result.refined.vertex, result.interpolated, *by_channel);
  } else {
    result.pilot = error.values(result.refined.vertex);
    // A vertex may have been gathered before its cell turned out to be even. As with channels, its
    // ends decide.
    interpolate_vertices(result.interpolated, result.pilot.indirect);
  }
  const PatchMesh& mesh = result.refined.mesh;
  result.error = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int cell = result.refined.cell[e];
    if (cell < 0) continue;
    const bool is_back_of_two = elements.side_count(cell) == 2 && mesh.twin[e] < e;
    result.error[e] = refinement.relative_error(cell, is_back_of_two ? 1 : 0);
  }
  add_shared(error, elements.base(), result);
  result.report.gathers = error.gathers();
  result.gather_rays = error.rays();
  return result;
}

}  // namespace lightwell
