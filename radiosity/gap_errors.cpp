#include "radiosity/gap_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesh/patches/sphere_grid.h"
#include "radiosity/refine/error_reference.h"

namespace lightwell {
namespace {

constexpr int point_count = 4;
constexpr double widest = 0.15;  // width of a gap as a share of a patch, as for GapLight
constexpr int gap_rays = 64;
constexpr std::uint64_t gap_replica = 4000;

// A point inside an element.
struct InnerPoint {
  int element = -1;
  std::array<double, 4> weights{};  // of the corners
};

// Point k of an element: in the middle of a quarter of a quadrilateral, half-way from the centre of
// a triangle to a corner, or in its centre.
InnerPoint inner_point(const PatchMesh& mesh, int element, int k) {
  if (mesh.corner_count(element) == 4) {
    const double u = k % 2 == 0 ? 0.25 : 0.75, v = k < 2 ? 0.25 : 0.75;
    return {element, {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v}};
  }
  constexpr double third = 1.0 / 3.0;
  InnerPoint point{element, {third, third, third, 0.0}};
  if (k == 3) return point;
  for (int c = 0; c < 3; ++c) {
    point.weights[static_cast<std::size_t>(c)] = 0.5 * third + (c == k ? 0.5 : 0.0);
  }
  return point;
}

Eigen::Vector3d position(const PatchMesh& mesh, const InnerPoint& point) {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  for (int c = 0; c < mesh.corner_count(point.element); ++c) {
    at +=
        point.weights[static_cast<std::size_t>(c)] * mesh.position(mesh.corners[point.element][c]);
  }
  return at;
}

// True for elements whose light is interpolated, and whose corners are not all dark.
bool can_err(const PatchMesh& mesh, const BandArray& irradiance, int element) {
  const int p = mesh.patch[element];
  if (!(mesh.reflectance.row(p) > 0.0f).any()) return false;
  for (int c = 0; c < mesh.corner_count(element); ++c) {
    if ((irradiance.row(mesh.corners[element][c]) > 0.0f).any()) {
      return sphere_grid_of(mesh, mesh.facet[element]) == nullptr;
    }
  }
  return false;
}

// The inner points of all elements that have a point in a gap.
std::vector<InnerPoint> points_in_gaps(const ElementCaster& caster, const BandArray& irradiance) {
  const PatchMesh& mesh = caster.mesh();
  constexpr double narrowest = 1e-4;  // nearer surfaces lie on each other
  std::vector<InnerPoint> found;
  std::array<Ray, point_count> rays;
  std::array<ElementHit, point_count> hits;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (!can_err(mesh, irradiance, e)) continue;
    const double size = std::sqrt(mesh.area[mesh.patch[e]]);
    const Eigen::Vector3d normal = element_center(mesh, e).normal;
    for (int k = 0; k < point_count; ++k) {
      rays[static_cast<std::size_t>(k)] = {.origin = position(mesh, inner_point(mesh, e, k)),
                                           .direction = normal,
                                           .t_max = widest * size,
                                           .origin_group = mesh.facet[e]};
    }
    caster.closest_elements(rays, hits);
    const bool is_in_gap = std::ranges::any_of(
        hits, [&](const ElementHit& hit) { return hit.facet >= 0 && hit.t > narrowest * size; });
    if (!is_in_gap) continue;
    for (int k = 0; k < point_count; ++k) found.push_back(inner_point(mesh, e, k));
  }
  return found;
}

// Squared difference of interpolated from gathered irradiance, mean of the bands.
double squared_error(const PatchMesh& mesh, const BandArray& irradiance, const InnerPoint& point,
                     const Spectrum& gathered) {
  Spectrum E = Spectrum::Zero(irradiance.cols());
  for (int c = 0; c < mesh.corner_count(point.element); ++c) {
    const auto weight = static_cast<float>(point.weights[static_cast<std::size_t>(c)]);
    E += weight * irradiance.row(mesh.corners[point.element][c]).transpose();
  }
  return (E - gathered).cast<double>().square().mean();
}

}  // namespace

void add_gap_errors(const LitScene& lit, const GatherOptions& gather, RadiositySolution& solution) {
  const PatchMesh& mesh = lit.mesh();
  if (solution.interpolation_error.size() != mesh.element_count()) return;
  // Caustics are in the mesh alone, and no gather at a point finds them.
  BandArray irradiance = solution.irradiance();
  const BandArray radiosity = gatherable_radiosity(mesh, lit.direct_light, irradiance);
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, solution.parts);
  const std::vector<InnerPoint> inner = points_in_gaps(lit.caster, irradiance);
  if (inner.empty()) return;
  if (solution.caustic_irradiance.size() > 0) irradiance -= solution.caustic_irradiance;
  GatherOptions options = gather;
  options.rays = gap_rays;
  options.shadows.max_rays = std::min(options.shadows.max_rays, gap_rays);
  options.shadows.min_rays = std::min(options.shadows.min_rays, options.shadows.max_rays);
  options.replica += gap_replica;
  const GatherPoints points(static_cast<int>(inner.size()), [&](int i) {
    const int e = inner[static_cast<std::size_t>(i)].element;
    return GatherPoint{.position = position(mesh, inner[static_cast<std::size_t>(i)]),
                       .normal = element_center(mesh, e).normal,
                       .facet = mesh.facet[e]};
  });
  const GatheredIrradiance found = gather_irradiance(lit, radiosity, points, options);
  for (std::size_t i = 0; i < inner.size(); i += point_count) {
    double square = 0.0;
    for (std::size_t k = i; k < i + point_count; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const Spectrum E = (found.direct.row(row) + found.indirect.row(row)).transpose();
      square += squared_error(mesh, irradiance, inner[k], E) / point_count;
    }
    const int e = inner[i].element;
    if (!(reference[e] > 0.0)) continue;
    float& error = solution.interpolation_error[e];
    error = std::max(error, static_cast<float>(std::sqrt(square) / reference[e]));
  }
}

}  // namespace lightwell
