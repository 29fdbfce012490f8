#include "radiosity/refine_solution.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "radiosity/interpolation_error.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// About as many as elements of a quarter of the edge everywhere would be, both sides; those that
// are small already, leaves and crumbs, would stay what they are.
std::int64_t default_room(const RefinedElements& elements) {
  std::vector<double> areas;
  double total = 0.0;
  for (const int cell : elements.leaves()) {
    areas.push_back(elements.area(cell));
    total += elements.area(cell);
  }
  std::sort(areas.begin(), areas.end(), std::greater<>());
  double typical = 0.0, larger = 0.0;  // half of all area lies in elements as large
  for (std::size_t i = 0; i < areas.size() && larger < 0.5 * total; ++i) {
    typical = areas[i];
    larger += areas[i];
  }
  std::int64_t count = elements.element_count();
  for (const int cell : elements.leaves()) {
    if (elements.area(cell) > 0.25 * typical) count += 15 * elements.side_count(cell);
  }
  return count;
}

class Refinement {
 public:
  Refinement(RefinedElements& elements, InterpolationError& error, const RefineOptions& options)
      : elements_(elements),
        error_(error),
        options_(options),
        max_elements_(options.max_elements > 0 ? options.max_elements : default_room(elements)),
        allowed_(std::pow(options.tolerance, 2) * error.area()) {
    resize();
    for (const int cell : elements.leaves()) {
      std::array<double, 2> expected{0.0, 0.0};
      for (int side = 0; side < elements.side_count(cell); ++side) {
        expected[side] = error.expected(cell, side);
      }
      set(cell, expected);
    }
  }

  RefineReport run() {
    RefineReport report{.tolerance = options_.tolerance,
                        .elements_at_first = elements_.element_count()};
    while (report.outcome == RefineOutcome::off) {
      std::vector<int> marks = cells_to_split();
      // No more than there may be elements for, each split making three of them or more. (Bounds
      // fall when they are measured, and others come to the front.)
      const std::int64_t room =
          std::max<std::int64_t>(max_elements_ - elements_.element_count(), 0);
      constexpr std::size_t at_once = 4096;
      const std::size_t most = std::max(static_cast<std::size_t>(room / 3 + 1), at_once);
      if (marks.size() > most) marks.resize(most);
      if (sum_ <= allowed_) {
        report.outcome = RefineOutcome::tolerance_reached;
      } else if (marks.empty()) {
        report.outcome = RefineOutcome::smallest_size_reached;
      } else if (!measure(marks)) {
        if (!split(marks)) report.outcome = RefineOutcome::max_elements_reached;
        ++report.rounds;
      }
    }
    expect_of_unmeasured();
    cells_to_split();
    report.estimate = error_.area() > 0.0 ? std::sqrt(sum_ / error_.area()) : 0.0;
    report.elements = elements_.element_count();
    return report;
  }

  /// With what noise may hide.
  float relative_error(int cell, int side) const {
    return static_cast<float>(std::sqrt(squares_[cell][side] + hidden_[cell][side]));
  }

 private:
  void resize() {
    squares_.resize(elements_.cell_count(), {0.0, 0.0});
    hidden_.resize(elements_.cell_count(), {0.0, 0.0});
    is_known_.resize(elements_.cell_count(), 0);
    measured_.resize(elements_.cell_count(), 0);
  }
  void set(int cell, const std::array<double, 2>& squares,
           const std::array<double, 2>& hidden = {0.0, 0.0}) {
    squares_[cell] = squares;
    hidden_[cell] = hidden;
    is_known_[cell] = 1;
  }

  // The leaves with most of the squared error, the others holding at most half of what is allowed
  // or being as small as may be; also finds the sum over all.
  std::vector<int> cells_to_split() {
    std::vector<std::pair<double, int>> by_error;
    sum_ = 0.0;
    double rest = 0.0;
    for (const int cell : elements_.leaves()) {
      const double square = elements_.area(cell) * (squares_[cell][0] + squares_[cell][1]);
      sum_ += square;
      if (elements_.level(cell) < options_.max_level && square > 0.0) {
        by_error.emplace_back(-square, cell);
        rest += square;
      }
    }
    std::sort(by_error.begin(), by_error.end());
    std::vector<int> marks;
    double last = 0.0;
    for (const auto& [minus_square, cell] : by_error) {
      // Cells of equal error, by a scene's symmetry, are split together: rounding must not choose.
      constexpr double about_equal = 0.999;
      if (rest <= 0.5 * allowed_ && (marks.empty() || -minus_square < about_equal * last)) break;
      rest += minus_square;
      last = -minus_square;
      marks.push_back(cell);
    }
    return marks;
  }

  // A split leaves a sixteenth of the squared error where light is smooth, half of it along an
  // edge: for those that nobody has measured since, something between.
  void expect_of_unmeasured() {
    for (const int cell : elements_.leaves()) {
      if (measured_[cell] || elements_.level(cell) == 0) continue;
      for (double& square : squares_[cell]) square *= 0.25;
      for (double& square : hidden_[cell]) square *= 0.25;
    }
  }

  // Whether any of them had not been measured yet.
  bool measure(const std::vector<int>& cells) {
    std::vector<int> fresh;
    for (const int cell : cells) {
      if (!measured_[cell]) fresh.push_back(cell);
    }
    const std::vector<InterpolationError::Measured> measured = error_.measure(fresh);
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      set(fresh[i], measured[i].error, measured[i].hidden);
      measured_[fresh[i]] = 1;
    }
    return !fresh.empty();
  }

  // Splits them all, or as many of the first as there may be elements for.
  bool split(std::vector<int> marks) {
    const auto fits = [&](std::size_t count) {
      RefinedElements trial = elements_;
      trial.split({marks.data(), count});
      return trial.element_count() <= max_elements_;
    };
    const bool all = fits(marks.size());
    if (!all) {
      std::size_t low = 0, high = marks.size();  // low fits, high does not
      while (high - low > 1) {
        const std::size_t middle = low + (high - low) / 2;
        (fits(middle) ? low : high) = middle;
      }
      marks.resize(low);
    }
    elements_.split(marks);
    resize();
    // Until they are measured, children are as bad as what they were split from. (Their numbers may
    // be old: what was merged is split into the same again.)
    for (const int cell : elements_.leaves()) {
      if (is_known_[cell]) continue;
      set(cell, squares_[elements_.parent(cell)], hidden_[elements_.parent(cell)]);
    }
    return all;
  }

  RefinedElements& elements_;
  InterpolationError& error_;
  const RefineOptions& options_;
  std::int64_t max_elements_;
  double allowed_;
  double sum_ = 0.0;  // squared error times area, over all leaves
  // Per cell and side; of those split since nobody measured, as of what they were split from.
  std::vector<std::array<double, 2>> squares_, hidden_;
  std::vector<char> is_known_, measured_;
};

}  // namespace

void require_room(const PatchMesh& mesh, const RefineOptions& options) {
  if (options.max_elements == 0 || mesh.element_count() <= options.max_elements) return;
  throw InputError(fmt::format(
      "at most {} elements are allowed, but the scene makes {} before any is refined; allow more, "
      "or use a larger patch size",
      options.max_elements, mesh.element_count()));
}

std::string sentence(const RefineReport& report) {
  const auto percent = [](double share) { return fmt::format("{:.3g} %", 100.0 * share); };
  std::string end;
  switch (report.outcome) {
    case RefineOutcome::off:
      return "nothing was refined";
    case RefineOutcome::tolerance_reached:
      end = fmt::format("the tolerance of {} is reached", percent(report.tolerance));
      break;
    case RefineOutcome::max_elements_reached:
      end = fmt::format("stopped at the most elements allowed, before the tolerance of {}",
                        percent(report.tolerance));
      break;
    case RefineOutcome::smallest_size_reached:
      end = fmt::format("stopped at the smallest elements allowed, before the tolerance of {}",
                        percent(report.tolerance));
      break;
  }
  return fmt::format("{} ({} estimated; {} elements became {} in {} rounds)", end,
                     percent(report.estimate), report.elements_at_first, report.elements,
                     report.rounds);
}

RefinedSolution refine_solution(const Scene& scene, const ElementCaster& caster,
                                const DirectLight& direct_light, const BandArray& radiosity,
                                const BandArray& caustic, RefinedElements& elements,
                                const GatherOptions& gather, const RefineOptions& options,
                                const ChannelLight* by_channel) {
  require_room(elements.base(), options);
  InterpolationError error(scene, caster, direct_light, radiosity, caustic, elements, gather,
                           options.max_level);
  Refinement refinement(elements, error, options);
  RefinedSolution result;
  result.report = refinement.run();
  result.refined = elements.mesh();
  if (by_channel) {
    result.draft = error.values_by_channel(result.refined.vertex, *by_channel);
  } else {
    error.gather(result.refined.vertex);
    result.draft = error.values(result.refined.vertex);
  }
  const PatchMesh& mesh = result.refined.mesh;
  result.error = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int cell = result.refined.cell[e];
    if (cell < 0) continue;
    const bool is_back_of_two = elements.side_count(cell) == 2 && mesh.twin[e] < e;
    result.error[e] = refinement.relative_error(cell, is_back_of_two ? 1 : 0);
  }
  result.report.gathers = error.gathers();
  return result;
}

}  // namespace lightwell
