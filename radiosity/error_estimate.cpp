#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/refine/effort.h"
#include "radiosity/refine/error_reference.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Between batches: more than the replicas that the gathers of one solution take (see reconstruct).
constexpr std::uint64_t batch_keys = 10000;
// As usual where no accuracy is asked for.
constexpr ShadowOptions fewest_shadow_rays{.min_rays = 32, .max_rays = 256};
// Half of the difference between a stratified set's two halves is more than the whole set is off
// by, since each half fills the other's gaps: squared, by 1.3 to 2 in rooms of 5 to 500 surfaces
// with 64 to 1024 rays.
constexpr double of_whole_set = 0.5;

// Per element: what interpolation may miss there, up to a factor that all share. (Range of the
// corners' irradiance over its reference, or what a shadow that no corner tells of may be.)
Eigen::ArrayXf indicators(const PatchMesh& mesh, const BandArray& irradiance) {
  const Eigen::ArrayXd reference = error_references(mesh, irradiance);
  Eigen::ArrayXf indicator = Eigen::ArrayXf::Zero(mesh.element_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!(mesh.reflectance.row(mesh.patch[e]) > 0.0f).any() || !(reference[e] > 0.0)) continue;
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
  double weight = 0.0;  // the share of the area over that of places
};

// Draws places on all that reflects and is seen: half of them evenly over its area, half in
// proportion to the squared error that elements are told to have (any multiple of it). That may sit
// in few small ones, along the edges of shadows, which as many places spread evenly would hardly
// meet.
class ErrorSampler {
 public:
  ErrorSampler(const ElementCaster& caster, const Eigen::ArrayXf& indicator)
      : mesh_(caster.mesh()), indicator_(indicator), counts_(mesh_.patch_count(), 0) {
    for (int p = 0; p < mesh_.patch_count(); ++p) {
      // Nobody sees what another surface lies on.
      const bool is_seen = caster.hidden_elements(p) == 0;
      if (!is_seen || !(mesh_.reflectance.row(p) > 0.0f).any()) continue;
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
  // Of elements that count, m^2; and that times what is told, squared.
  double area(int e) const { return counts_[mesh_.patch[e]] ? mesh_.element_area[e] : 0.0; }
  double error(int e) const { return area(e) * std::pow(double{indicator_[e]}, 2); }

  // Share of the places on an element.
  double density(int e) const {
    const double even = area(e) / total_area_;
    return total_error_ > 0.0 ? 0.5 * (even + error(e) / total_error_) : even;
  }

  const PatchMesh& mesh_;
  const Eigen::ArrayXf& indicator_;
  std::vector<char> counts_;  // per patch
  double total_area_ = 0.0, total_error_ = 0.0;
  std::vector<double> up_to_{};  // densities of an element and all before
};

// Those that are in no crack. Where another surface lies a hair above nobody sees a place, and what
// light the crack lets in there the vertices around cannot tell.
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
  constexpr double crack = 1e-4;  // of the scene
  return unenclosed_samples(caster, crack * scene_bounds(scene).diagonal(), drawn);
}

// How much too much light is in what is reflected, of each band, if what is found at places is that
// much off the light that its own reflections and the lamps make there. With e = E - E*, and T E
// what is reflected of E, E - (M + T E) is e - T e: all over a scene T leaves the share of light
// that is reflected, and the rest comes back in e.
Spectrum excess_of_reflected(const Eigen::ArrayXd& weight, const BandArray& found,
                             const BandArray& not_reflected, const BandArray& own) {
  constexpr double least = 0.02;  // of all light: noise would be taken more than fifty times
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

  const auto count = static_cast<Eigen::Index>(drawn.size());
  std::vector<GatherPoint> points;
  BandArray caustic = BandArray::Zero(count, lit.scene.bands.count());
  BandArray interpolated(count, lit.scene.bands.count());
  std::vector<int> element;
  Eigen::ArrayXd weight(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [point, share] = drawn[static_cast<std::size_t>(i)];
    points.push_back({point.position, point.normal, mesh.facet[point.element]});
    const ElementHit hit = point_on_element(mesh, point);
    element.push_back(hit.element);
    interpolated.row(i) = interpolate(mesh, irradiance, hit).transpose();
    if (solution.caustic_irradiance.size() > 0) {
      caustic.row(i) = interpolate(mesh, solution.caustic_irradiance, hit).transpose();
    }
    weight[i] = share;
  }
  weight /= weight.mean();
  GatherOptions gather_options = options.gather;
  ShadowOptions& shadows = gather_options.shadows;
  shadows.min_rays = std::max(shadows.min_rays, fewest_shadow_rays.min_rays);
  shadows.max_rays = std::max(shadows.max_rays, fewest_shadow_rays.max_rays);
  gather_options.rays = estimate_rays(options.gather.rays, mesh.vertex_count(), wanted);
  gather_options.replica =
      options.gather.replica + 1 + batch_keys * static_cast<std::uint64_t>(batch);
  gather_options.run = options.run;
  const BandArray radiosity = gatherable_radiosity(mesh, lit.direct_light, irradiance);
  irradiance.resize(0, 0);
  const GatheredIrradiance independent = gather_irradiance(lit, radiosity, points, gather_options);
  const BandArray not_reflected = independent.direct + caustic;
  BandArray truth = not_reflected + independent.indirect;
  truth -= independent.indirect.rowwise() *
           excess_of_reflected(weight, interpolated, not_reflected, truth).transpose();
  const Eigen::ArrayXd own = truth.cast<double>().rowwise().mean();
  const double mean = (weight * own).mean();
  if (!(mean > 0.0)) return {};
  const Eigen::ArrayXd reference =
      own.unaryExpr([mean](double here) { return error_reference(mean, here); });
  const Eigen::ArrayXd squares = (interpolated - truth).cast<double>().square().rowwise().mean();
  const Eigen::ArrayXd relative = squares / reference.square();
  Eigen::ArrayXd noise(count);  // squared
  for (Eigen::Index i = 0; i < count; ++i) {
    noise[i] = independent.variance[i] / (reference[i] * reference[i]) +
               std::pow(double{solution.gather_noise[element[static_cast<std::size_t>(i)]]}, 2);
  }
  if (of_elements) {
    double square = 0.0;
    for (Eigen::Index i = 0; i < count; ++i) {
      square += weight[i] * std::pow(double{indicator[element[static_cast<std::size_t>(i)]]}, 2);
    }
    const double excess = (weight * (relative - noise)).sum();
    if (square > 0.0) {
      *of_elements = static_cast<float>(std::sqrt(std::max(excess, 0.0) / square)) * indicator;
    }
  }
  const Eigen::ArrayXd squared = weight * relative;
  const double standard_error =
      std::sqrt((squared - squared.mean() * weight).square().mean() /
                static_cast<double>(std::max<Eigen::Index>(count - 1, 1)));
  return {.square = squared.mean(),
          .deviation = standard_error,
          .noise = std::sqrt(of_whole_set * (weight * noise).mean())};
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
