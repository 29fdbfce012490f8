#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "mesh/patch_sampler.h"
#include "radiosity/effort.h"
#include "radiosity/interpolation_error.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t error_point_key = 20;  // purposes of random keys
// As usual where no accuracy is asked for: see estimate_rays.
constexpr ShadowOptions fewest_shadow_rays{.min_rays = 32, .max_rays = 256};

// Per element: what interpolation may miss there, up to a factor that all share. (Range of the
// corners' irradiance over its reference, or what a shadow that no corner tells of may be.)
Eigen::ArrayXd indicators(const PatchMesh& mesh, const BandArray& irradiance) {
  const Eigen::ArrayXd reference = error_references(mesh, irradiance);
  Eigen::ArrayXd indicator = Eigen::ArrayXd::Zero(mesh.element_count());
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
    indicator[e] = std::sqrt(square / (reference[e] * reference[e]) + unseen * unseen);
  }
  return indicator;
}

}  // namespace

ErrorEstimate estimate_error(const Scene& scene, const ElementCaster& caster,
                             const DirectLight& direct_light, const SolveOptions& options,
                             const RadiositySolution& solution, Eigen::ArrayXf* of_elements) {
  const PatchMesh& mesh = caster.mesh();
  std::vector<double> area_to(mesh.patch_count());
  double total = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    // Nobody sees what another surface lies on; looking from above would find that surface.
    const bool is_seen = caster.hidden_elements(p) == 0;
    if (is_seen && (mesh.reflectance.row(p) > 0.0f).any()) total += mesh.area[p];
    area_to[p] = total;
  }
  if (!(total > 0.0) || options.error_points < 1) return {};

  std::vector<GatherPoint> points(options.error_points);
  BandArray caustic = BandArray::Zero(options.error_points, scene.bands.count());
  BandArray interpolated(options.error_points, scene.bands.count());
  std::vector<int> element(points.size());
  const BandArray irradiance = solution.irradiance();
  const SobolPoints sobol(options.error_points);
  for (int i = 0; i < options.error_points; ++i) {
    const Eigen::Array4f u = sobol.point(i, error_point_key);
    const auto at = std::upper_bound(area_to.begin(), area_to.end() - 1, u[0] * total);
    const int p = static_cast<int>(at - area_to.begin());
    const PatchPoint point = PatchSampler(mesh, p).point(u[1], u[2]);
    points[i] = {point.position, point.normal, mesh.facet[point.element]};
    // The element's own interpolation: look at the point from just above it.
    const double above = 1e-3 * std::sqrt(mesh.element_area[point.element]);
    const Ray ray{.origin = point.position + above * point.normal, .direction = -point.normal};
    ElementHit hit;
    caster.closest_hits({&ray, 1}, {&hit, 1});
    if (hit.element < 0)
      hit = {.facet = mesh.facet[point.element], .element = point.element, .weights = {1, 0, 0, 0}};
    element[i] = hit.element;
    interpolated.row(i) = interpolate(mesh, irradiance, hit).transpose();
    if (solution.caustic_irradiance.size() > 0) {
      caustic.row(i) = interpolate(mesh, solution.caustic_irradiance, hit).transpose();
    }
  }
  GatherOptions gather_options = options.gather;
  gather_options.rays =
      estimate_rays(options.gather.rays, mesh.vertex_count(), options.error_points);
  ShadowOptions& shadows = gather_options.shadows;
  shadows.min_rays = std::max(shadows.min_rays, fewest_shadow_rays.min_rays);
  shadows.max_rays = std::max(shadows.max_rays, fewest_shadow_rays.max_rays);
  gather_options.replica = options.gather.replica + 1;
  gather_options.progress = options.progress;
  gather_options.journal = options.journal;
  const GatheredIrradiance independent = gather_irradiance(
      scene, caster, direct_light, gatherable_radiosity(mesh, direct_light, irradiance), points,
      gather_options);
  const BandArray truth = independent.direct + independent.indirect + caustic;
  const double mean = truth.cast<double>().mean();
  if (!(mean > 0.0)) return {};
  const Eigen::ArrayXd reference = truth.cast<double>().rowwise().mean().unaryExpr(
      [mean](double own) { return error_reference(mean, own); });
  const Eigen::ArrayXd squares = (interpolated - truth).cast<double>().square().rowwise().mean();
  const Eigen::ArrayXd relative = squares / reference.square();
  Eigen::ArrayXd noise(options.error_points);  // squared
  for (int i = 0; i < options.error_points; ++i) {
    noise[i] = independent.variance[i] / (reference[i] * reference[i]) +
               std::pow(double{solution.gather_noise[element[i]]}, 2);
  }
  if (of_elements) {
    const Eigen::ArrayXd indicator = indicators(mesh, irradiance);
    double told = 0.0;
    for (const int e : element) told += std::pow(indicator[e], 2);
    const double excess = (relative - noise).sum();
    if (told > 0.0) {
      *of_elements = (std::sqrt(std::max(excess, 0.0) / told) * indicator).cast<float>();
    }
  }
  return {.error = std::sqrt(relative.mean()), .noise = std::sqrt(noise.mean())};
}

}  // namespace lightwell
