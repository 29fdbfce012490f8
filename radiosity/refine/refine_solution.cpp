#include "radiosity/refine/refine_solution.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "radiosity/refine/cell_errors.h"
#include "radiosity/refine/even_out_noise.h"
#include "radiosity/refine/interpolation_error.h"
#include "radiosity/refine/marking.h"

namespace lightwell {
namespace {

// Rounds of marking, measuring and splitting.
class Refinement {
 public:
  // A refinement that `may_go_on` continues with other tolerances.
  Refinement(RefinedElements& elements, InterpolationError& error, const RefineOptions& options,
             bool may_go_on)
      : elements_(elements),
        error_(error),
        options_(options),
        max_elements_(most_elements(elements, options)),
        is_memory_short_(is_memory_short(elements, options)),
        may_go_on_(may_go_on),
        cells_(elements, options_.parts, may_go_on),
        marking_(elements, cells_, options.parts.group_count(), options.max_level, may_go_on),
        report_{.elements_at_first = elements.element_count()} {
    for (const int cell : elements.leaves()) {
      std::array<double, 2> expected{0.0, 0.0};
      for (int side = 0; side < elements.side_count(cell); ++side) {
        expected[side] = error.expected(cell, side);
      }
      cells_.expect(cell, expected);
    }
  }

  // Splits until the tolerances or a limit are reached; a further call continues.
  RefineReport run(const RefineOptions& options) {
    options_.tolerance = options.tolerance;
    options_.efforts = options.efforts;
    for (int p = 0; p < options_.parts.group_count(); ++p) {
      marking_.allow(p, std::pow(options.tolerance_of(judged(p)), 2) * error_.area(p));
    }
    for (const int cell : elements_.leaves()) {
      if (error_.is_stale(cell)) cells_.measure_again(cell);
    }
    do {
      split_to_the_end();
      report_errors();
    } while (sharpen_sky());
    report_.elements = elements_.element_count();
    return report_;
  }

  const CellErrors& cells() const { return cells_; }

 private:
  // The part that a group is of.
  int judged(int group) const { return group % options_.parts.judged_count(); }

  // Measures and splits until the tolerances or a limit are reached.
  void split_to_the_end() {
    report_.outcome = RefineOutcome::off;
    while (report_.outcome == RefineOutcome::off) {
      const std::vector<int> marks = cells_to_split();
      if (marking_.are_reached()) {
        report_.outcome = RefineOutcome::tolerance_reached;
      } else if (report_.rounds > 0 && error_.run().is_time_up()) {
        report_.outcome = RefineOutcome::time_limit_reached;
      } else if (marks.empty()) {
        report_.outcome = RefineOutcome::smallest_size_reached;
      } else if (report_.rounds > 0 && room() == 0) {
        report_.outcome = no_more_elements();
      } else if (!measure(marks)) {
        if (!split(marks)) report_.outcome = no_more_elements();
        ++report_.rounds;
      }
    }
  }

  // Elements that may still be made.
  std::int64_t room() const {
    return std::max<std::int64_t>(max_elements_ - elements_.element_count(), 0);
  }
  RefineOutcome no_more_elements() const {
    return is_memory_short_ ? RefineOutcome::memory_limit_reached
                            : RefineOutcome::max_elements_reached;
  }

  // The next cells to split, once all of them are measured: no more than can be, since each split
  // adds at least three elements.
  std::vector<int> cells_to_split() {
    Marking::PartMarks by_part = marking_.mark();
    std::vector<int> marks = marking_.joined(by_part);
    constexpr std::size_t at_once = 4096;
    const std::size_t most = std::max(static_cast<std::size_t>(room() / 3 + 1), at_once);
    if (marks.size() > most) marks.resize(most);
    return may_wait(marks) ? marking_.worst_of(std::move(by_part), most) : marks;
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
      if (!cells_.is_measured(cell)) continue;
      cells_.measure_again(cell);
      again.push_back(cell);
    }
    measure(again);
    return true;
  }

  // True if cells with smaller errors wait until the worst are split and measured: if refinement
  // may continue later, or if the limit of elements is near. Otherwise all are split at once, in
  // fewer rounds.
  bool may_wait(const std::vector<int>& marks) const {
    const auto made = 3 * static_cast<std::int64_t>(marks.size());
    return may_go_on_ || 2 * (elements_.element_count() + made) > max_elements_;
  }

  void report_errors() {
    std::vector<double> left(static_cast<std::size_t>(options_.parts.group_count()), 0.0);
    for (const int cell : elements_.leaves()) {
      cells_.for_each_part(
          cell, [&](int p) { left[p] += cells_.share_left(cell) * marking_.counted(cell, p); });
    }
    report_.parts.clear();
    double worst = -1.0;
    for (int p = 0; p < options_.parts.judged_count(); ++p) {
      const double area = error_.area(p);
      report_.parts.push_back({.estimate = area > 0.0 ? std::sqrt(left[p] / area) : 0.0,
                               .is_reached = marking_.is_reached(p)});
      const double tolerance = options_.tolerance_of(p), estimate = report_.parts.back().estimate;
      if (!(estimate > worst * tolerance)) continue;
      worst = estimate / tolerance;
      report_.tolerance = tolerance;
      report_.estimate = estimate;
    }
  }

  // Measures the cells that are not measured yet; returns whether there were any.
  bool measure(const std::vector<int>& cells) {
    std::vector<int> fresh;
    for (const int cell : cells) {
      if (!cells_.is_measured(cell)) fresh.push_back(cell);
    }
    const std::vector<InterpolationError::Measured> measured = error_.measure(fresh);
    for (std::size_t i = 0; i < fresh.size(); ++i) cells_.set_measured(fresh[i], measured[i]);
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
    cells_.expect_of_parents();
    return all;
  }

  RefinedElements& elements_;
  InterpolationError& error_;
  RefineOptions options_;
  std::int64_t max_elements_;
  bool is_memory_short_, may_go_on_;
  CellErrors cells_;
  Marking marking_;
  RefineReport report_;
};

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

// Lets vertices even out the noise of the sky's light among neighbours. On small elements it would
// show as dots.
void even_out_noisy_sky(const InterpolationError& error, RefinedSolution& result) {
  Eigen::ArrayXf variance = error.noisy_sky_variance(result.refined.vertex);
  if (!(variance > 0.0f).any()) return;
  const PatchMesh& mesh = result.refined.mesh;
  even_out_noise(mesh, {}, static_cast<int>(mesh.reflectance.cols()), result.pilot.direct,
                 variance);
  interpolate_vertices(result.unread, result.pilot.direct);
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

GatheredIrradiance SolutionRefinement::light_at_base() const {
  std::vector<int> vertices(static_cast<std::size_t>(impl_->elements.base().vertex_count()));
  std::iota(vertices.begin(), vertices.end(), 0);
  return impl_->error.values(vertices);
}

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
    result.error[e] = refinement.cells().relative_error(cell, is_back_of_two ? 1 : 0);
  }
  add_shared(error, elements.base(), result);
  even_out_noisy_sky(error, result);
  result.report.gathers = error.gathers();
  result.gather_rays = error.rays();
  return result;
}

}  // namespace lightwell
