#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/gather/body_exits.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/refine/gather_noise.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"
#include "scene/scenery_box.h"

namespace lightwell {
namespace {

// Distance of batches' keys: more than the replicas of one solution's gathers (see reconstruct).
constexpr std::uint64_t batch_keys = 10000;
// The shadow rays of a solution without a requested accuracy.
constexpr ShadowOptions fewest_shadow_rays{.min_rays = 32, .max_rays = 256};
// The ratio of_whole_set for the noise that the solution has from gathers at vertices, whose errors
// are partly alike at neighbours, and from the light that these gathers read. Solves with other
// random numbers differ by 0.56 (Cornell box, accuracy 2 %), 0.57 (hall of 4634 patches), 0.69
// (glossy room) and 0.79 (room with a mirror) of the estimate.
constexpr double of_whole_solution = 0.7;

// Per element, a number proportional to the error that interpolation may leave: the range of the
// corners' irradiance over the reference, plus (in the square) unseen_range.
Eigen::ArrayXf indicators(const PatchMesh& mesh, const BandArray& irradiance,
                          const SceneParts& parts) {
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, parts);
  const std::vector<char> judged = judged_patches(mesh, parts);
  Eigen::ArrayXf indicator = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (judged[static_cast<std::size_t>(mesh.patch[e])] == 0 || !(reference[e] > 0.0)) continue;
    const double square = squared_range(mesh, irradiance, e);
    indicator[e] = static_cast<float>(
        std::sqrt(square / (reference[e] * reference[e]) + unseen_range * unseen_range));
  }
  return indicator;
}

struct ErrorSample {
  PatchPoint point{};
  double weight = 0.0;  // inverse of the density of sample points, relative to a uniform one
};

// Draws points on the area of a part that counts (see judged_patches), is not covered, and is
// looked at: half of them uniformly, half in proportion to the squared indicator of the elements.
// Errors may sit in few small elements along the edges of shadows, which uniform points would
// hardly meet.
class ErrorSampler {
 public:
  ErrorSampler(const ElementCaster& caster, const Eigen::ArrayXf& indicator,
               const SceneParts& parts, int part)
      : mesh_(caster.mesh()), indicator_(indicator), counts_(mesh_.patch_count(), 0) {
    const std::vector<char> judged = judged_patches(mesh_, parts);
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      if (parts.judged_with(p) != part) continue;
      const bool is_seen = caster.hidden_elements(p) == 0 && parts.is_looked_at(p);
      if (!is_seen || judged[static_cast<std::size_t>(p)] == 0) continue;
      counts_[p] = 1;
      for (int e = mesh_.first_element[p]; e < mesh_.first_element[p + 1]; ++e) {
        total_area_ += area(e);
        total_error_ += error(e);
      }
    }
    double sum = 0.0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (counts_[mesh_.patch[e]] == 0) continue;
      elements_.push_back(e);
      up_to_.push_back(sum += density(e));
    }
  }

  double area() const { return total_area_; }

  ErrorSample draw(const Eigen::Array4f& u) const {
    const auto at = std::upper_bound(up_to_.begin(), up_to_.end() - 1, u[0] * up_to_.back());
    const int e = elements_[static_cast<std::size_t>(at - up_to_.begin())];
    return {PatchSampler(mesh_, mesh_.patch[e], e).point(u[1], u[2]),
            area(e) / total_area_ / density(e)};
  }

 private:
  // Area of an element that counts, m^2, else 0; and the area times the squared indicator.
  double area(int e) const { return counts_[mesh_.patch[e]] ? mesh_.element_area[e] : 0.0; }
  double error(int e) const { return area(e) * std::pow(double{indicator_[e]}, 2); }

  // Probability that a sample point lies on the element.
  double density(int e) const {
    const double even = area(e) / total_area_;
    return total_error_ > 0.0 ? 0.5 * (even + error(e) / total_error_) : even;
  }

  const PatchMesh& mesh_;
  const Eigen::ArrayXf& indicator_;
  std::vector<char> counts_;  // per patch
  double total_area_ = 0.0, total_error_ = 0.0;
  std::vector<int> elements_{};  // that count
  std::vector<double> up_to_{};  // running sum of their densities, the element's included
};

// The samples that lie in no crack: no other surface is nearer than `width`, metres, above them.
// Such points are invisible, and the vertices around them do not sample the light in the crack.
std::vector<ErrorSample> unenclosed_samples(const ElementCaster& caster, double width,
                                            const std::vector<ErrorSample>& samples) {
  std::vector<Ray> rays;
  for (const auto& [point, weight] : samples) {
    rays.push_back({.origin = point.position,
                    .direction = width * point.normal,
                    .t_max = 1.0,
                    .origin_group = caster.mesh().facet[point.element]});
  }
  std::vector<std::uint8_t> blocked(rays.size());
  caster.occluded(rays, blocked);
  std::vector<ErrorSample> open;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (blocked[i] == 0) open.push_back(samples[i]);
  }
  return open;
}

std::vector<ErrorSample> draw_samples(const LitScene& lit, const BodyExits& exits,
                                      const ErrorSampler& sampler, int wanted, int batch) {
  const SobolPoints sobol(wanted);
  std::vector<ErrorSample> drawn;
  const std::uint64_t key = static_cast<std::uint64_t>(RandomPurpose::error_points) +
                            batch_keys * static_cast<std::uint64_t>(batch);
  for (int i = 0; i < wanted; ++i) drawn.push_back(sampler.draw(sobol.point(i, key)));
  // Points within bodies are invisible, and vertices around them may have the light outside.
  std::erase_if(drawn, [&](const ErrorSample& at) { return exits.covers(at.point); });
  constexpr double crack = 1e-4;  // share of scenery_length()
  return unenclosed_samples(lit.caster, crack * scenery_length(lit.scene), drawn);
}

// The sample points of each part: `all` shared by area, with a least number for each part.
std::vector<int> share_points(std::span<const ErrorSampler> samplers, int all) {
  if (samplers.size() == 1) return {all};
  constexpr int least = 16, enough = 128;
  const auto parts = static_cast<int>(samplers.size());
  const int fewest = std::min(all, std::clamp(2 * all / parts, least, enough));
  double area = 0.0;
  for (const ErrorSampler& sampler : samplers) area += sampler.area();
  std::vector<int> points;
  for (const ErrorSampler& sampler : samplers) {
    const double share = area > 0.0 ? sampler.area() / area : 0.0;
    points.push_back(std::max(fewest, static_cast<int>(std::lround(all * share))));
  }
  return points;
}

// Sample points of all parts; those of part p are drawn[begin[p]] to drawn[begin[p + 1] - 1].
struct PartSamples {
  std::vector<ErrorSample> drawn{};
  std::vector<int> begin{0};
};

PartSamples draw_samples(const LitScene& lit, const Eigen::ArrayXf& indicator,
                         const SceneParts& parts, int points, int batch,
                         std::span<const char> wanted) {
  const BodyExits exits(lit);
  std::vector<ErrorSampler> samplers;
  for (int p = 0; p < parts.judged_count(); ++p) {
    samplers.emplace_back(lit.caster, indicator, parts, p);
  }
  const std::vector<int> shares = share_points(samplers, points);
  PartSamples samples;
  for (std::size_t p = 0; p < samplers.size(); ++p) {
    if ((wanted.empty() || wanted[p] != 0) && shares[p] > 0 && samplers[p].area() > 0.0) {
      const auto drawn = draw_samples(lit, exits, samplers[p], shares[p], batch);
      samples.drawn.insert(samples.drawn.end(), drawn.begin(), drawn.end());
    }
    samples.begin.push_back(static_cast<int>(samples.drawn.size()));
  }
  return samples;
}

// Relative excess of reflected light in the solution, per band. With the solution E, the truth E*,
// the error e = E - E* and the reflected light T E of E, the difference from a gather in the
// solution's own light is E - (M + T E) = e - T e. Averaged over a scene T is the reflected share
// of all light, so e is that difference times all light over the light straight from lamps. `found`
// is E, `own` the gathered light, and `not_reflected` its part straight from lamps; points x bands.
Spectrum excess_of_reflected(const Eigen::ArrayXd& weight, const BandArray& found,
                             const BandArray& not_reflected, const BandArray& own) {
  constexpr double least = 0.02;  // share of all light; less would amplify noise above fifty times
  Spectrum excess(found.cols());
  for (Eigen::Index k = 0; k < found.cols(); ++k) {
    const auto mean = [&](const BandArray& of) {
      return (weight * of.col(k).cast<double>()).mean();
    };
    const double all = mean(own), from_lamps = std::max(mean(not_reflected), least * all);
    excess[k] = all > 0.0 ? static_cast<float>((mean(found) - all) / from_lamps) : 0.0f;
  }
  return excess;
}

// The solution at sample points: points x bands, W/m^2.
struct SampledSolution {
  std::vector<GatherPoint> points{};
  std::vector<int> element{};
  BandArray interpolated{}, caustic{};
  Eigen::ArrayXd weight{};  // mean 1 over the points of each part
};

SampledSolution sample_solution(const PatchMesh& mesh, const RadiositySolution& solution,
                                const BandArray& irradiance, const PartSamples& samples) {
  const auto count = static_cast<Eigen::Index>(samples.drawn.size());
  SampledSolution sampled{.interpolated = BandArray(count, irradiance.cols()),
                          .caustic = BandArray::Zero(count, irradiance.cols()),
                          .weight = Eigen::ArrayXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [point, share] = samples.drawn[static_cast<std::size_t>(i)];
    sampled.points.push_back({point.position, point.normal, mesh.facet[point.element]});
    const ElementHit hit = point_on_element(mesh, point);
    sampled.element.push_back(hit.element);
    sampled.interpolated.row(i) = interpolate(mesh, irradiance, hit).transpose();
    if (solution.caustic_irradiance.size() > 0) {
      sampled.caustic.row(i) = interpolate(mesh, solution.caustic_irradiance, hit).transpose();
    }
    sampled.weight[i] = share;
  }
  for (std::size_t p = 0; p + 1 < samples.begin.size(); ++p) {
    const int first = samples.begin[p], n = samples.begin[p + 1] - first;
    if (n > 0) sampled.weight.segment(first, n) /= sampled.weight.segment(first, n).mean();
  }
  return sampled;
}

// The rows `first` to `first` + `n` - 1.
SampledSolution rows(const SampledSolution& all, int first, int n) {
  return {.element = {all.element.begin() + first, all.element.begin() + first + n},
          .interpolated = all.interpolated.middleRows(first, n),
          .caustic = all.caustic.middleRows(first, n),
          .weight = all.weight.segment(first, n)};
}

// Options of a gather with more rays than the solution's and other random numbers.
GatherOptions independent_gather(const SolveOptions& options, int batch) {
  GatherOptions gather = options.gather;
  ShadowOptions& shadows = gather.shadows;
  shadows.min_rays = std::max(shadows.min_rays, fewest_shadow_rays.min_rays);
  shadows.max_rays = std::max(shadows.max_rays, fewest_shadow_rays.max_rays);
  gather.replica = options.gather.replica + 1 + batch_keys * static_cast<std::uint64_t>(batch);
  gather.run = options.run;
  return gather;
}

// Squared errors at sample points, relative to `reference`, and the squares of half the differences
// that tell the noise of the gathers at these points and of the solution.
struct RelativeErrors {
  Eigen::ArrayXd squares{}, of_points{}, of_solution{};

  Eigen::ArrayXd noise() const { return of_points + of_solution; }
};

RelativeErrors relative_errors(const SampledSolution& sampled, const RadiositySolution& solution,
                               const BandArray& truth, const Eigen::ArrayXf& variance,
                               const Eigen::ArrayXd& reference) {
  const Eigen::ArrayXd squares =
      (sampled.interpolated - truth).cast<double>().square().rowwise().mean();
  RelativeErrors errors{.squares = squares / reference.square(),
                        .of_points = variance.cast<double>() / reference.square(),
                        .of_solution = Eigen::ArrayXd(squares.size())};
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const int element = sampled.element[static_cast<std::size_t>(i)];
    errors.of_solution[i] = std::pow(double{solution.gather_noise[element]}, 2);
  }
  return errors;
}

// The factor by which the mean square of the errors beyond noise exceeds that of the indicator.
// Empty if the indicator is 0 at all sample points.
std::optional<float> indicator_scale(const Eigen::ArrayXf& indicator,
                                     const SampledSolution& sampled, const RelativeErrors& errors) {
  double square = 0.0;
  for (Eigen::Index i = 0; i < sampled.weight.size(); ++i) {
    const int element = sampled.element[static_cast<std::size_t>(i)];
    square += sampled.weight[i] * std::pow(double{indicator[element]}, 2);
  }
  if (!(square > 0.0)) return std::nullopt;
  const double excess = (sampled.weight * (errors.squares - errors.noise())).sum();
  return static_cast<float>(std::sqrt(std::max(excess, 0.0) / square));
}

ErrorEstimate mean_estimate(const Eigen::ArrayXd& weight, const RelativeErrors& errors) {
  const Eigen::ArrayXd squared = weight * errors.squares;
  const double standard_error =
      std::sqrt((squared - squared.mean() * weight).square().mean() /
                static_cast<double>(std::max<Eigen::Index>(weight.size() - 1, 1)));
  const Eigen::ArrayXd noise =
      of_whole_set * errors.of_points + of_whole_solution * errors.of_solution;
  return {.square = squared.mean(),
          .deviation = standard_error,
          .noise = std::sqrt((weight * noise).mean()),
          .batches = 1};
}

// Share of the light at the points of a part that comes from outside the part or from its lamps, by
// band; the rest was reflected within, at the points' reflectances. At least the share of light
// straight from lamps.
Eigen::ArrayXd share_from_outside(const PatchMesh& mesh, const SampledSolution& sampled,
                                  const BandArray& own) {
  Eigen::ArrayXd reflected = Eigen::ArrayXd::Zero(own.cols()), all = reflected;
  for (Eigen::Index i = 0; i < own.rows(); ++i) {
    const int patch = mesh.patch[sampled.element[static_cast<std::size_t>(i)]];
    const Eigen::ArrayXd E = sampled.weight[i] * own.row(i).cast<double>().transpose();
    reflected += mesh.reflectance.row(patch).cast<double>().transpose() * E;
    all += E;
  }
  return (all > 0.0).select(1.0 - reflected / all.max(1e-300), 1.0);
}

// The independent gather at the points of a part, freed of the error that it shares with the
// solution. `not_reflected` is its part straight from lamps.
BandArray corrected_truth(const PatchMesh& mesh, const SceneParts& parts,
                          const SampledSolution& sampled, const GatheredIrradiance& independent) {
  if (sampled.element.empty()) return independent.direct;
  BandArray not_reflected = independent.direct + sampled.caustic;
  BandArray truth = not_reflected + independent.indirect;
  if (parts.judged_count() > 1) {
    // Light from other parts counts as light from lamps.
    const Eigen::ArrayXd from_outside = share_from_outside(mesh, sampled, truth);
    not_reflected = not_reflected.max(truth.rowwise() * from_outside.cast<float>().transpose());
  }
  truth -=
      independent.indirect.rowwise() *
      excess_of_reflected(sampled.weight, sampled.interpolated, not_reflected, truth).transpose();
  return truth;
}

GatheredIrradiance rows(const GatheredIrradiance& all, int first, int n) {
  return {.direct = all.direct.middleRows(first, n),
          .indirect = all.indirect.middleRows(first, n),
          .variance = all.variance.segment(first, n)};
}

// Rays at each sample point, by the rays of the solution in the point's part.
// The noise of the sky's light is 0.3 of the target there.
void choose_rays(const SolveOptions& options, const PatchMesh& mesh, const PartSamples& samples,
                 int points, const PartMeans& means, SampledSolution& sampled) {
  constexpr double of_noise_share = 0.55;
  const auto& efforts = options.refine.efforts;
  for (std::size_t p = 0; p + 1 < samples.begin.size(); ++p) {
    const int rays = efforts.empty() ? options.gather.rays : efforts[p].rays;
    const double noise = efforts.empty() ? 0.0 : of_noise_share * efforts[p].sky_noise;
    for (int i = samples.begin[p]; i < samples.begin[p + 1]; ++i) {
      sampled.points[i].sky_noise = noise_goal(means.of_part(static_cast<int>(p)), noise);
      sampled.points[i].rays = estimate_rays(rays, mesh.vertex_count(), points);
    }
  }
}

// Irradiance by which errors are judged in each part, from the light at the sample points, but at
// least `least`; 0: the part is dark.
std::vector<double> sampled_means(const PartSamples& samples, const SampledSolution& sampled,
                                  const std::vector<BandArray>& truth, double least) {
  std::vector<double> means;
  for (std::size_t p = 0; p < truth.size(); ++p) {
    const int first = samples.begin[p], n = samples.begin[p + 1] - first;
    const Eigen::ArrayXd own = truth[p].cast<double>().rowwise().mean();
    means.push_back(n > 0 ? (sampled.weight.segment(first, n) * own).mean() : 0.0);
  }
  for (double& mean : means) mean = mean > 0.0 ? std::max(mean, least) : 0.0;
  return means;
}

}  // namespace

std::vector<ErrorEstimate> estimate_errors(const LitScene& lit, const SolveOptions& options,
                                           const RadiositySolution& solution,
                                           const EstimateTask& task) {
  const PatchMesh& mesh = lit.mesh();
  const SceneParts& parts = solution.parts;
  std::vector<ErrorEstimate> estimates(static_cast<std::size_t>(parts.judged_count()));
  BandArray irradiance = solution.irradiance();
  const bool has_indicator = solution.interpolation_error.size() > 0;
  const Eigen::ArrayXf guessed =
      has_indicator ? Eigen::ArrayXf() : indicators(mesh, irradiance, parts);
  const Eigen::ArrayXf& indicator = has_indicator ? solution.interpolation_error : guessed;
  const int points = estimate_points(options.error_points, mesh.vertex_count());
  const PartSamples samples = draw_samples(lit, indicator, parts, points, task.batch, task.wanted);
  if (samples.drawn.empty()) return estimates;

  SampledSolution sampled = sample_solution(mesh, solution, irradiance, samples);
  const PartMeans means_of_mesh = part_means(mesh, irradiance, parts);
  choose_rays(options, mesh, samples, points, means_of_mesh, sampled);
  BandArray own;
  if (!task.radiosity) own = gatherable_radiosity(lit, irradiance, solution.direct_irradiance);
  const BandArray& radiosity = task.radiosity ? *task.radiosity : own;
  irradiance.resize(0, 0);
  const GatheredIrradiance gathered =
      gather_irradiance(lit, radiosity, sampled.points, independent_gather(options, task.batch));
  std::vector<BandArray> truth;
  for (std::size_t p = 0; p < estimates.size(); ++p) {
    const int first = samples.begin[p], n = samples.begin[p + 1] - first;
    truth.push_back(
        corrected_truth(mesh, parts, rows(sampled, first, n), rows(gathered, first, n)));
  }
  const std::vector<double> means = sampled_means(samples, sampled, truth, means_of_mesh.least());
  Eigen::ArrayXf scaled;
  for (std::size_t p = 0; p < estimates.size(); ++p) {
    const int first = samples.begin[p], n = samples.begin[p + 1] - first;
    if (n == 0 || !(means[p] > 0.0)) continue;
    const SampledSolution here = rows(sampled, first, n);
    const Eigen::ArrayXd light = truth[p].cast<double>().rowwise().mean();
    const Eigen::ArrayXd reference =
        light.unaryExpr([mean = means[p]](double E) { return error_reference(mean, E); });
    const RelativeErrors errors =
        relative_errors(here, solution, truth[p], gathered.variance.segment(first, n), reference);
    estimates[p] = mean_estimate(here.weight, errors);
    const auto scale = task.of_elements ? indicator_scale(indicator, here, errors) : std::nullopt;
    if (!scale) continue;
    if (scaled.size() == 0) scaled = indicator;
    for (int e = 0; e < mesh.element_count(); ++e) {
      if (parts.judged_with(mesh.patch[e]) == static_cast<int>(p))
        scaled[e] = *scale * indicator[e];
    }
  }
  if (scaled.size() > 0) *task.of_elements = scaled;
  return estimates;
}

double ErrorEstimate::error() const {
  return std::sqrt(square + deviation);
}

double ErrorEstimate::least() const {
  return std::sqrt(std::max(square - deviation, 0.0));
}

ErrorEstimate joined(const ErrorEstimate& a, const ErrorEstimate& b) {
  const int batches = a.batches + b.batches;
  if (batches == 0) return a;
  const double share = static_cast<double>(b.batches) / batches;
  const auto mean = [share](double of_a, double of_b) {
    return (1.0 - share) * of_a + share * of_b;
  };
  return {.square = mean(a.square, b.square),
          .deviation = std::hypot((1.0 - share) * a.deviation, share * b.deviation),
          .noise = std::sqrt(mean(a.noise * a.noise, b.noise * b.noise)),
          .batches = batches};
}

}  // namespace lightwell
