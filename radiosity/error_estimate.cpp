#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "mesh/patch_sampler.h"
#include "mesh/sphere_grid.h"
#include "radiosity/effort.h"
#include "radiosity/interpolation_error.h"
#include "scene/facet_textures.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t error_point_key = 20, told_point_key = 21;  // purposes of random keys
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

// Whom there is an error to ask of: nobody sees what another surface lies on.
std::vector<char> patches_that_count(const ElementCaster& caster) {
  const PatchMesh& mesh = caster.mesh();
  std::vector<char> counts(static_cast<std::size_t>(mesh.patch_count()));
  for (int p = 0; p < mesh.patch_count(); ++p) {
    counts[p] = caster.hidden_elements(p) == 0 && (mesh.reflectance.row(p) > 0.0f).any();
  }
  return counts;
}

std::size_t drawn(const std::vector<double>& up_to, double u) {
  const auto at = std::upper_bound(up_to.begin(), up_to.end() - 1, u * up_to.back());
  return static_cast<std::size_t>(at - up_to.begin());
}

// Uniform over a flat element, a little inside as all samples are (see PatchSampler).
PatchPoint point_on_element(const PatchMesh& mesh, int element, double u, double v) {
  const auto [number, middle, normal] = element_center(mesh, element);
  const auto& c = mesh.corners[element];
  const Eigen::Vector3d a = mesh.position(c[0]);
  int second = 1;
  if (mesh.corner_count(element) == 4) {
    const Eigen::Vector3d diagonal = mesh.position(c[2]) - a;
    const double first = (mesh.position(c[1]) - a).cross(diagonal).norm();
    const double share = first / (first + diagonal.cross(mesh.position(c[3]) - a).norm());
    second = u < share ? 1 : 2;
    u = second == 1 ? u / share : (u - share) / (1.0 - share);
  }
  const Eigen::Vector3d w = triangle_point(u, v);
  const Eigen::Vector3d at =
      w[0] * a + w[1] * mesh.position(c[second]) + w[2] * mesh.position(c[second + 1]);
  constexpr double inset = 1e-4;
  return {.element = number, .position = at + inset * (middle - at), .normal = normal};
}

struct Place {
  PatchPoint point{};
  double weight = 1.0;  // of it in a mean over area
};

// Half of them anywhere, the others where elements are told to be off, in proportion to the square
// of that: what few elements hold would else be met by luck. (Defensive importance sampling,
// Hesterberg 1995, "Weighted average importance sampling and defensive mixture distributions": no
// weight is above 2.) Nothing if nothing counts.
std::vector<Place> places_to_look_at(const ElementCaster& caster, const RadiositySolution& solution,
                                     int count) {
  const PatchMesh& mesh = caster.mesh();
  const std::vector<char> counts = patches_that_count(caster);
  std::vector<double> area_to(mesh.patch_count());
  double area = 0.0;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    area_to[p] = area += counts[p] != 0 ? mesh.area[p] : 0.0;
  }
  if (!(area > 0.0) || count < 1) return {};

  // Squared, times area. Those of spheres, and with holes, are left to chance.
  const auto told = [&](int e) {
    const bool is_flat = sphere_grid_of(mesh, mesh.facet[e]) == nullptr;
    const bool has_holes = mesh.textures && mesh.textures->has_holes(mesh.facet[e]);
    if (counts[mesh.patch[e]] == 0 || !is_flat || has_holes) return 0.0;
    return mesh.element_area[e] * (std::pow(double{solution.interpolation_error[e]}, 2) +
                                   std::pow(double{solution.gather_noise[e]}, 2));
  };
  std::vector<double> told_to(mesh.element_count(), 0.0);
  double all_told = 0.0;
  for (int e = 0; e < mesh.element_count() && solution.interpolation_error.size() > 0; ++e) {
    told_to[e] = all_told += told(e);
  }
  const int by_told = all_told > 0.0 ? count / 2 : 0, by_area = count - by_told;
  const double share_of_area = static_cast<double>(by_area) / count;
  std::vector<Place> places;
  const SobolPoints sobol(std::max(1, by_area));
  for (int i = 0; i < count; ++i) {
    Place place;
    if (i < by_area) {
      const Eigen::Array4d u = sobol.point(i, error_point_key).cast<double>();
      place.point = PatchSampler(mesh, static_cast<int>(drawn(area_to, u[0]))).point(u[1], u[2]);
    } else {
      const Eigen::Array4d u = sobol.point(i - by_area, told_point_key).cast<double>();
      place.point = point_on_element(mesh, static_cast<int>(drawn(told_to, u[0])), u[1], u[2]);
    }
    if (by_told > 0) {
      const int e = place.point.element;
      const double of_told = told(e) / all_told, of_area = mesh.element_area[e] / area;
      place.weight = of_area / (share_of_area * of_area + (1.0 - share_of_area) * of_told);
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace

ErrorEstimate estimate_error(const Scene& scene, const ElementCaster& caster,
                             const DirectLight& direct_light, const SolveOptions& options,
                             const RadiositySolution& solution, Eigen::ArrayXf* of_elements) {
  const PatchMesh& mesh = caster.mesh();
  const std::vector<Place> places = places_to_look_at(caster, solution, options.error_points);
  if (places.empty()) return {};

  std::vector<GatherPoint> points(places.size());
  Eigen::ArrayXd weight(options.error_points);
  BandArray caustic = BandArray::Zero(options.error_points, scene.bands.count());
  BandArray interpolated(options.error_points, scene.bands.count());
  std::vector<int> element(points.size());
  const BandArray irradiance = solution.irradiance();
  for (int i = 0; i < options.error_points; ++i) {
    const PatchPoint& point = places[i].point;
    points[i] = {point.position, point.normal, mesh.facet[point.element]};
    weight[i] = places[i].weight;
    const ElementHit hit = place_on_element(mesh, point);
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
  const Eigen::ArrayXd own = truth.cast<double>().rowwise().mean();
  const double mean = (weight * own).sum() / weight.sum();
  if (!(mean > 0.0)) return {};
  const Eigen::ArrayXd reference =
      own.unaryExpr([mean](double E) { return error_reference(mean, E); });
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
  return {.error = std::sqrt((weight * relative).mean()),
          .noise = std::sqrt((weight * noise).mean())};
}

}  // namespace lightwell
