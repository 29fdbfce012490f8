#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/error_reference.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Distance of batches' keys: more than the replicas of one solution's gathers (see reconstruct).
constexpr std::uint64_t batch_keys = 10000;
// The shadow rays of a solution without a requested accuracy.
constexpr ShadowOptions fewest_shadow_rays{.min_rays = 32, .max_rays = 256};
// Variance of a stratified set over the square of half the difference between its two halves. Each
// half fills the other's gaps, so the whole is better than two independent halves: measured, the
// ratio is 1/1.3 to 1/2 in rooms of 5 to 500 surfaces with 64 to 1024 rays.
constexpr double of_whole_set = 0.5;

// Per element, a number proportional to the error that interpolation may leave: the range of the
// corners' irradiance over the reference, plus (in the square) 5 % for shadows that no corner sees.
Eigen::ArrayXf indicators(const PatchMesh& mesh, const BandArray& irradiance) {
  const Eigen::ArrayXd reference = error_references(mesh, irradiance);
  const std::vector<char> judged = judged_patches(mesh);
  Eigen::ArrayXf indicator = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (judged[static_cast<std::size_t>(mesh.patch[e])] == 0 || !(reference[e] > 0.0)) continue;
    Spectrum low = irradiance.row(mesh.corners[e][0]).transpose(), high = low;
    for (int c = 1; c < mesh.corner_count(e); ++c) {
      const Spectrum E = irradiance.row(mesh.corners[e][c]).transpose();
      low = low.min(E);
      high = high.max(E);
    }
    constexpr double unseen = 0.05;
    const double square = (high - low).cast<double>().square().mean();
    indicator[e] =
        static_cast<float>(std::sqrt(square / (reference[e] * reference[e]) + unseen * unseen));
  }
  return indicator;
}

struct ErrorSample {
  PatchPoint point{};
  double weight = 0.0;  // inverse of the density of sample points, relative to a uniform one
};

// Draws points on the area that counts (see judged_patches) and is not covered: half of them
// uniformly, half in proportion to the squared indicator of the elements. Errors may sit in few
// small elements along the edges of shadows, which uniform points would hardly meet.
class ErrorSampler {
 public:
  ErrorSampler(const ElementCaster& caster, const Eigen::ArrayXf& indicator)
      : mesh_(caster.mesh()), indicator_(indicator), counts_(mesh_.patch_count(), 0) {
    const std::vector<char> judged = judged_patches(mesh_);
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      const bool is_seen = caster.hidden_elements(p) == 0;
      if (!is_seen || judged[static_cast<std::size_t>(p)] == 0) continue;
      counts_[p] = 1;
      for (int e = mesh_.first_element[p]; e < mesh_.first_element[p + 1]; ++e) {
        total_area_ += area(e);
        total_error_ += error(e);
      }
    }
    up_to_.reserve(mesh_.element_count());
    double sum = 0.0;
    for (int e = 0; e < mesh_.element_count(); ++e) up_to_.push_back(sum += density(e));
  }

  bool is_empty() const { return !(total_area_ > 0.0); }

  ErrorSample draw(const Eigen::Array4f& u) const {
    const auto at = std::upper_bound(up_to_.begin(), up_to_.end() - 1, u[0] * up_to_.back());
    const auto e = static_cast<int>(at - up_to_.begin());
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
  std::vector<double> up_to_{};  // running sum of densities, the element's included
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

std::vector<ErrorSample> draw_samples(const Scene& scene, const ElementCaster& caster,
                                      const Eigen::ArrayXf& indicator, int wanted, int batch) {
  const ErrorSampler sampler(caster, indicator);
  if (sampler.is_empty() || wanted < 1) return {};
  const SobolPoints sobol(wanted);
  std::vector<ErrorSample> drawn;
  const std::uint64_t key = static_cast<std::uint64_t>(RandomPurpose::error_points) +
                            batch_keys * static_cast<std::uint64_t>(batch);
  for (int i = 0; i < wanted; ++i) drawn.push_back(sampler.draw(sobol.point(i, key)));
  constexpr double crack = 1e-4;  // share of the scene's diagonal
  return unenclosed_samples(caster, crack * scene_bounds(scene).diagonal(), drawn);
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
  Eigen::ArrayXd weight{};  // mean 1
};

SampledSolution sample_solution(const PatchMesh& mesh, const RadiositySolution& solution,
                                const BandArray& irradiance,
                                const std::vector<ErrorSample>& drawn) {
  const auto count = static_cast<Eigen::Index>(drawn.size());
  SampledSolution sampled{.interpolated = BandArray(count, irradiance.cols()),
                          .caustic = BandArray::Zero(count, irradiance.cols()),
                          .weight = Eigen::ArrayXd(count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [point, share] = drawn[static_cast<std::size_t>(i)];
    sampled.points.push_back({point.position, point.normal, mesh.facet[point.element]});
    const ElementHit hit = point_on_element(mesh, point);
    sampled.element.push_back(hit.element);
    sampled.interpolated.row(i) = interpolate(mesh, irradiance, hit).transpose();
    if (solution.caustic_irradiance.size() > 0) {
      sampled.caustic.row(i) = interpolate(mesh, solution.caustic_irradiance, hit).transpose();
    }
    sampled.weight[i] = share;
  }
  sampled.weight /= sampled.weight.mean();
  return sampled;
}

// Options of a gather with more rays than the solution's and other random numbers; `wanted` is the
// result of estimate_points().
GatherOptions independent_gather(const SolveOptions& options, const PatchMesh& mesh, int wanted,
                                 int batch) {
  GatherOptions gather = options.gather;
  ShadowOptions& shadows = gather.shadows;
  shadows.min_rays = std::max(shadows.min_rays, fewest_shadow_rays.min_rays);
  shadows.max_rays = std::max(shadows.max_rays, fewest_shadow_rays.max_rays);
  gather.rays = estimate_rays(options.gather.rays, mesh.vertex_count(), wanted);
  gather.replica = options.gather.replica + 1 + batch_keys * static_cast<std::uint64_t>(batch);
  gather.run = options.run;
  return gather;
}

// Squared errors at sample points, relative to `reference`, and the squared noise of both gathers
// in them.
struct RelativeErrors {
  Eigen::ArrayXd squares{}, noise{};
};

RelativeErrors relative_errors(const SampledSolution& sampled, const RadiositySolution& solution,
                               const BandArray& truth, const Eigen::ArrayXf& variance,
                               const Eigen::ArrayXd& reference) {
  const Eigen::ArrayXd squares =
      (sampled.interpolated - truth).cast<double>().square().rowwise().mean();
  RelativeErrors errors{.squares = squares / reference.square(),
                        .noise = Eigen::ArrayXd(squares.size())};
  for (Eigen::Index i = 0; i < squares.size(); ++i) {
    const int element = sampled.element[static_cast<std::size_t>(i)];
    errors.noise[i] = variance[i] / (reference[i] * reference[i]) +
                      std::pow(double{solution.gather_noise[element]}, 2);
  }
  return errors;
}

// The indicator times the factor by which its mean square is that of the errors beyond noise. Empty
// if the indicator is 0 at all sample points.
std::optional<Eigen::ArrayXf> scaled_indicator(const Eigen::ArrayXf& indicator,
                                               const SampledSolution& sampled,
                                               const RelativeErrors& errors) {
  double square = 0.0;
  for (Eigen::Index i = 0; i < sampled.weight.size(); ++i) {
    const int element = sampled.element[static_cast<std::size_t>(i)];
    square += sampled.weight[i] * std::pow(double{indicator[element]}, 2);
  }
  if (!(square > 0.0)) return std::nullopt;
  const double excess = (sampled.weight * (errors.squares - errors.noise)).sum();
  return static_cast<float>(std::sqrt(std::max(excess, 0.0) / square)) * indicator;
}

ErrorEstimate mean_estimate(const Eigen::ArrayXd& weight, const RelativeErrors& errors) {
  const Eigen::ArrayXd squared = weight * errors.squares;
  const double standard_error =
      std::sqrt((squared - squared.mean() * weight).square().mean() /
                static_cast<double>(std::max<Eigen::Index>(weight.size() - 1, 1)));
  return {.square = squared.mean(),
          .deviation = standard_error,
          .noise = std::sqrt(of_whole_set * (weight * errors.noise).mean())};
}

}  // namespace

ErrorEstimate estimate_error(const LitScene& lit, const SolveOptions& options,
                             const RadiositySolution& solution, Eigen::ArrayXf* of_elements,
                             int batch) {
  const PatchMesh& mesh = lit.mesh();
  BandArray irradiance = solution.irradiance();
  const bool has_indicator = solution.interpolation_error.size() > 0;
  const Eigen::ArrayXf guessed = has_indicator ? Eigen::ArrayXf() : indicators(mesh, irradiance);
  const Eigen::ArrayXf& indicator = has_indicator ? solution.interpolation_error : guessed;
  const int wanted = estimate_points(options.error_points, mesh.vertex_count());
  const std::vector<ErrorSample> drawn =
      draw_samples(lit.scene, lit.caster, indicator, wanted, batch);
  if (drawn.empty()) return {};

  const SampledSolution sampled = sample_solution(mesh, solution, irradiance, drawn);
  const BandArray radiosity = gatherable_radiosity(mesh, lit.direct_light, irradiance);
  irradiance.resize(0, 0);
  const GatheredIrradiance independent = gather_irradiance(
      lit, radiosity, sampled.points, independent_gather(options, mesh, wanted, batch));
  const Eigen::ArrayXd& weight = sampled.weight;
  const BandArray not_reflected = independent.direct + sampled.caustic;
  BandArray truth = not_reflected + independent.indirect;
  truth -= independent.indirect.rowwise() *
           excess_of_reflected(weight, sampled.interpolated, not_reflected, truth).transpose();
  const Eigen::ArrayXd own = truth.cast<double>().rowwise().mean();
  const double mean = (weight * own).mean();
  if (!(mean > 0.0)) return {};
  const Eigen::ArrayXd reference =
      own.unaryExpr([mean](double here) { return error_reference(mean, here); });
  const RelativeErrors errors =
      relative_errors(sampled, solution, truth, independent.variance, reference);
  if (of_elements) {
    if (auto scaled = scaled_indicator(indicator, sampled, errors)) *of_elements = *scaled;
  }
  return mean_estimate(weight, errors);
}

double ErrorEstimate::error() const {
  return std::sqrt(square + deviation);
}

double ErrorEstimate::least() const {
  return std::sqrt(std::max(square - deviation, 0.0));
}

ErrorEstimate joined(const ErrorEstimate& a, const ErrorEstimate& b) {
  const int batches = a.batches + b.batches;
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
