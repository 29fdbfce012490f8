#include "raytrace/picture_records.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mesh/patches/patch_sampler.h"
#include "raytrace/seen_places.h"
#include "raytrace/shading/pixel_gather.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Places and records that a thread takes at a time.
constexpr int records_together = 16;
// Weight of a record at a place that needs no other one: three quarters of its radius away, so that
// records overlap and a plane can be fitted between them.
constexpr double least_coverage = 0.25;
// Step of the widest grid, in steps of the narrowest one.
constexpr int widest_step = 16;
// Step that stands for the last round, which fills what the narrowest grid leaves.
constexpr int filling = 0;

// Relative RMS error of the solution's light, by its own estimate: over what the picture shows, or,
// for light of patches, whose elements have no estimates, over the worst part.
double error_of_solution(const PatchMesh& mesh, const RadiositySolution& solution,
                         const SeenPlaces& seen) {
  if (solution.interpolation_error.size() != mesh.element_count()) return solution.error_estimate;
  const bool has_noise = solution.gather_noise.size() == mesh.element_count();
  constexpr int step = 8;
  double squares = 0.0, count = 0.0;
  for (const auto& place : seen.on_grid(step)) {
    if (!place) continue;
    squares += std::pow(double{solution.interpolation_error[place->element]}, 2);
    if (has_noise) squares += std::pow(double{solution.gather_noise[place->element]}, 2);
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

// The least radius at which records of the narrowest grid cover every place between its points, at
// most sqrt(1/2) of a step away. In a furnished room a radius of 1.5 steps blurs bright mouldings:
// the picture's error was 4.0 %, and 3.0 % with 0.8.
double least_radius(const SeenPlace& place) {
  constexpr double share_of_spacing = 0.8;
  return share_of_spacing * place.spacing;
}

// Radius of a record over the harmonic mean distance to what its place sees. Twice the share raised
// the error of a furnished room's picture from 3.0 to 3.5 %.
constexpr double share_of_distance = 0.05;

// The share of that distance, as far as the grid finds records in time.
double radius_by_distance(const ElementCaster& caster, const SeenPlace& place) {
  // 32 rays tell the mean of 1 / t to some 10 %, as well as the share is known.
  constexpr std::size_t count = 32;
  // Four steps of the widest grid: a record that serves farther is found no sooner.
  constexpr double most_steps = 4.0 * widest_step;
  const SobolPoints points(count);
  const PatchPoint from{place.element, place.at.position, place.at.normal};
  std::array<Ray, count> rays;
  std::array<ElementHit, count> hits;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Array4f u = points.point(static_cast<int>(i), place.key);
    rays[i] = cosine_ray(caster.mesh(), from, u[0], u[1]);
  }
  caster.closest_elements(rays, hits);
  double nearness = 0.0;
  for (const ElementHit& hit : hits) {
    if (hit.facet >= 0) nearness += 1.0 / (hit.t * count);
  }
  const double most = most_steps * place.spacing;
  return nearness > 0.0 ? std::min(share_of_distance / nearness, most) : most;
}

// A record without light at a place.
IrradianceRecord empty_record(const SeenPlace& place, double radius) {
  return {.position = place.at.position, .normal = place.at.smooth_normal, .radius = radius};
}

class PictureRecords {
 public:
  PictureRecords(const LitScene& lit, const RadiositySolution& solution, const SeenPlaces& seen,
                 const RenderOptions& options)
      : lit_(lit),
        seen_(seen),
        run_(options.run),
        gather_(lit.scene, lit.caster, lit.direct_light, solution, options.gather_rays,
                options.max_depth) {}

  // Returns no records if their relative noise is more than `most_noise`, and those of wider grids
  // if there is not enough time for all.
  std::vector<IrradianceRecord> find(double most_noise) {
    bool is_finished = true;
    for (int step = widest_step; step >= 1; step /= 2) {
      const SeenGrid grid(seen_.on_grid(step));
      follow_detail(grid);
      std::vector<Candidate> candidates = uncovered(grid);
      clamp(candidates);
      is_finished = add_in_time(candidates, step);
      if (!is_finished) break;
      if (step == widest_step && noise() > most_noise) return {};
      narrow();
    }
    if (is_finished) fill();
    even_out(records_);
    return std::move(records_);
  }

 private:
  // A place, and its record before its light is known.
  struct Candidate {
    SeenPlace place{};
    double by_distance = 0.0;  // m, radius_by_distance()
    double least = 0.0;        // m, least radius
    IrradianceRecord record{};
  };

  // Places of a grid, and the least radii that a record may have there.
  struct SeenGrid {
    explicit SeenGrid(std::vector<std::optional<SeenPlace>> all)
        : places(std::move(all)), detail(records_of(places), one_for_one) {}

    // The least radius of a record at a place, or less where the picture shows places around in
    // finer detail, as those that a mirror shows at a grazing angle and the picture itself from
    // nearby: such a record reaches no farther than to those places.
    double least_radius_at(const IrradianceRecord& place, double least) const {
      return detail.allowed_radius(
          {.position = place.position, .normal = place.normal, .radius = least});
    }

    static std::vector<IrradianceRecord> records_of(
        const std::vector<std::optional<SeenPlace>>& places) {
      std::vector<IrradianceRecord> records;
      for (const auto& place : places) {
        if (place) records.push_back(empty_record(*place, least_radius(*place)));
      }
      return records;
    }

    static constexpr double one_for_one = 1.0;  // metre of radius for a metre of distance
    std::vector<std::optional<SeenPlace>> places;
    RecordNeighbours detail;
  };

  // Lowers the least radii of the records so far to what a grid shows.
  void follow_detail(const SeenGrid& grid) {
    parallel_for(static_cast<int>(records_.size()), records_together, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const auto k = static_cast<std::size_t>(i);
        least_radii_[k] = grid.least_radius_at(records_[k], least_radii_[k]);
        const double most = std::max(least_radii_[k], by_distance_[k]);
        at_first_[k].radius = std::min(at_first_[k].radius, most);
        records_[k].radius = std::min(records_[k].radius, most);
      }
    });
  }

  // Gathers for places that were covered until their records were narrowed, by themselves or by
  // what the narrowest grid saw. The solution's light would show there as a dark or bright crumb.
  void fill() {
    std::vector<Candidate> candidates = uncovered(SeenGrid(seen_.on_grid(1)));
    limit(candidates);
    add_in_time(candidates, filling);
  }

  // Adds the candidates that are needed; none and false if there is not enough time.
  bool add_in_time(const std::vector<Candidate>& candidates, int step) {
    const std::size_t before = records_.size();
    const bool is_finished = finishes_in_time(
        run_, [&](const RunControl& in_time) { add(thinned(candidates), step, in_time); });
    if (!is_finished) records_.resize(before);
    return is_finished;
  }

  // Places of a grid that no record covers well.
  std::vector<Candidate> uncovered(const SeenGrid& grid) const {
    const IrradianceRecords known(records_);
    std::vector<std::optional<Candidate>> found(grid.places.size());
    parallel_for(static_cast<int>(grid.places.size()), records_together, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!grid.places[k]) continue;
        const SeenPlace& place = *grid.places[k];
        if (known.coverage(place.at.position, place.at.smooth_normal) >= least_coverage) continue;
        Candidate& candidate = found[k].emplace();
        candidate.place = place;
        candidate.by_distance = radius_by_distance(lit_.caster, place);
        candidate.record = empty_record(place, 0.0);
        candidate.least = grid.least_radius_at(candidate.record, least_radius(place));
        candidate.record.radius = std::max(candidate.least, candidate.by_distance);
      }
    });
    std::vector<Candidate> left;
    for (auto& candidate : found) {
      if (candidate) left.push_back(std::move(*candidate));
    }
    return left;
  }

  // Lowers the radii of candidates and of the records so far to what all of them allow. Narrowed
  // records count by the radius that they had at first: light changes there, and not what a place
  // sees.
  void clamp(std::vector<Candidate>& candidates) {
    const RecordNeighbours neighbours = limit(candidates);
    parallel_for(static_cast<int>(records_.size()), records_together, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const auto k = static_cast<std::size_t>(i);
        IrradianceRecord& record = records_[k];
        const double allowed = neighbours.allowed_radius(at_first_[k]);
        record.radius = std::min(record.radius, std::max(least_radii_[k], allowed));
      }
    });
  }

  // Lowers the radii of candidates alone. Returns the limits that hold for all records.
  RecordNeighbours limit(std::vector<Candidate>& candidates) const {
    // Twice the share, since the 32 rays of a place tell the distance to some 10 % alone.
    constexpr double growth = 2.0 * share_of_distance;
    std::vector<IrradianceRecord> all = at_first_;
    for (const Candidate& candidate : candidates) all.push_back(candidate.record);
    RecordNeighbours neighbours(std::move(all), growth);
    parallel_for(static_cast<int>(candidates.size()), records_together, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        Candidate& candidate = candidates[static_cast<std::size_t>(i)];
        candidate.record.radius =
            std::max(candidate.least, neighbours.allowed_radius(candidate.record));
      }
    });
    return neighbours;
  }

  // The candidates that those before them leave uncovered.
  static std::vector<Candidate> thinned(const std::vector<Candidate>& candidates) {
    std::vector<BoxTree::Box> boxes;
    for (const Candidate& candidate : candidates) boxes.push_back(reach(candidate.record));
    const BoxTree tree(std::move(boxes));
    std::vector<char> is_kept(candidates.size(), 0);
    std::vector<int> around;
    std::vector<Candidate> kept;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const IrradianceRecord& own = candidates[i].record;
      tree.find_overlaps(BoxTree::Box(own.position, own.position), around);
      const bool is_covered = std::ranges::any_of(around, [&](int j) {
        const auto k = static_cast<std::size_t>(j);
        return is_kept[k] != 0 &&
               record_weight(candidates[k].record, own.position, own.normal) >= least_coverage;
      });
      if (is_covered) continue;
      is_kept[i] = 1;
      kept.push_back(candidates[i]);
    }
    return kept;
  }

  // Gathers the light of candidates, which become records.
  void add(const std::vector<Candidate>& candidates, int step, const RunControl& run) {
    constexpr int between_reports = 1024;
    const auto count = static_cast<int>(candidates.size());
    const std::size_t first = records_.size();
    for (const Candidate& candidate : candidates) {
      records_.push_back(candidate.record);
      at_first_.push_back(candidate.record);
      by_distance_.push_back(candidate.by_distance);
      least_radii_.push_back(candidate.least);
    }
    for (int done = 0; done < count; done += between_reports) {
      report(run.progress, "records", share_done(step, static_cast<double>(done) / count));
      parallel_for(std::min(between_reports, count - done), 1, [&](int begin, int end) {
        for (int i = done + begin; i < done + end; ++i) {
          const auto k = static_cast<std::size_t>(i);
          set_light(candidates[k].place, records_[first + k]);
        }
      });
    }
  }

  // The mean of two gathers of half the rays; their difference tells the noise.
  void set_light(const SeenPlace& place, IrradianceRecord& record) const {
    const std::uint64_t key = random_key(place.key, RandomPurpose::ray_tree_gathers);
    const auto half = [&](std::uint64_t number) {
      constexpr float half_the_rays = 0.5f;
      return gather_.indirect_irradiance(lit_.caster, place.at, random_key(key, number),
                                         half_the_rays);
    };
    const Spectrum first = half(0), second = half(1);
    record.irradiance = 0.5f * (first + second);
    record.variance = 0.25 * std::pow(static_cast<double>(first.mean() - second.mean()), 2);
  }

  // RMS noise of all records over their RMS light.
  double noise() const {
    double variance = 0.0, square = 0.0;
    for (const IrradianceRecord& record : records_) {
      variance += record.variance;
      square += std::pow(static_cast<double>(record.irradiance.mean()), 2);
    }
    return square > 0.0 ? std::sqrt(variance / square) : 0.0;
  }

  // A narrower grid has about twice the records of the one before.
  static double share_done(int step, double of_step) {
    if (step == filling) return 1.0;
    const double before = static_cast<double>(widest_step) / step - 1.0;
    return (before + of_step * (before + 1.0)) / (2.0 * widest_step - 1.0);
  }

  // Narrows records that their neighbours tell badly, so that narrower grids fill in the light
  // between: what differs from a plane grows with the square of the radius.
  void narrow() {
    // Less than three times the noise of a record would narrow records for their noise alone.
    constexpr float most_difference = 3.0f * static_cast<float>(IrradianceRecords::usual_error);
    // A narrower grid has half the step, and a record is narrowed once more there.
    constexpr float narrowest = 0.35f;
    const IrradianceRecords known(records_);
    parallel_for(static_cast<int>(records_.size()), records_together, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const auto k = static_cast<std::size_t>(i);
        IrradianceRecord& record = records_[k];
        const auto found = known.fit(record.position, record.normal, i);
        if (!found) continue;
        const float E = record.irradiance.mean();
        const float difference = std::abs(found->irradiance.mean() - E);
        if (!(difference > most_difference * E)) continue;
        const float share = std::max(narrowest, std::sqrt(most_difference * E / difference));
        record.radius = std::max(least_radii_[k], record.radius * static_cast<double>(share));
      }
    });
  }

  LitScene lit_;
  const SeenPlaces& seen_;
  RunControl run_;
  PixelGather gather_;
  std::vector<IrradianceRecord> records_{};
  std::vector<IrradianceRecord> at_first_{};  // without light, and as wide as they were at first
  std::vector<double> by_distance_{};         // m, radii by the distances to what places see
  std::vector<double> least_radii_{};         // m, to which records may be narrowed
};

}  // namespace

std::shared_ptr<const IrradianceRecords> find_records(const LitScene& lit,
                                                      const RadiositySolution& solution,
                                                      const Camera& camera, const CameraRays& rays,
                                                      const RenderOptions& options) {
  if (options.pass != Pass::automatic || !options.has_records) return nullptr;
  const SeenPlaces seen(lit, camera, rays, options.max_depth);
  const double error = error_of_solution(lit.mesh(), solution, seen);
  if (!(error > IrradianceRecords::usual_error)) return nullptr;
  std::vector<IrradianceRecord> records = PictureRecords(lit, solution, seen, options).find(error);
  if (records.empty()) return nullptr;
  return std::make_shared<const IrradianceRecords>(std::move(records));
}

}  // namespace lightwell
