#include "radiosity/gap_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mesh/patches/round_grid.h"
#include "mesh/patches/translucency.h"
#include "radiosity/gather/gap_sizes.h"
#include "radiosity/inner_errors.h"
#include "radiosity/refine/error_reference.h"
#include "scene/parallel.h"

namespace lightwell {
namespace {

// Number of corners without light.
int dark_corners(const PatchMesh& mesh, const BandArray& irradiance, int element) {
  int count = 0;
  for (int c = 0; c < mesh.corner_count(element); ++c) {
    count += (irradiance.row(mesh.corners[element][c]) > 0.0f).any() ? 0 : 1;
  }
  return count;
}

// True if another surface is near above a point of the element.
bool lies_in_gap(const ElementCaster& caster, int element, double size) {
  const PatchMesh& mesh = caster.mesh();
  constexpr double narrowest = 1e-4;  // nearer surfaces lie on each other
  const Eigen::Vector3d normal = element_center(mesh, element).normal;
  std::array<Ray, inner_point_count> rays;
  std::array<ElementHit, inner_point_count> hits;
  for (int k = 0; k < inner_point_count; ++k) {
    rays[static_cast<std::size_t>(k)] = {.origin = inner_position(mesh, element, k),
                                         .direction = normal,
                                         .t_max = widest_gap * size,
                                         .origin_group = mesh.facet[element]};
  }
  caster.closest_elements(rays, hits);
  return std::ranges::any_of(
      hits, [&](const ElementHit& hit) { return hit.facet >= 0 && hit.t > narrowest * size; });
}

// The reflecting elements that lie in gaps; round shapes are left out.
std::vector<int> elements_in_gaps(const ElementCaster& caster) {
  const PatchMesh& mesh = caster.mesh();
  const std::vector<float> sizes = gap_sizes(mesh);
  std::vector<char> is_in_gap(static_cast<std::size_t>(mesh.element_count()), 0);
  parallel_for(mesh.element_count(), 1024, [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const bool reflects = scatters(mesh, mesh.patch[e]);
      if (!reflects || round_grid_of(mesh, mesh.facet[e])) continue;
      is_in_gap[static_cast<std::size_t>(e)] =
          lies_in_gap(caster, e, double{sizes[static_cast<std::size_t>(e)]}) ? 1 : 0;
    }
  });
  std::vector<int> found;
  for (int e = 0; e < mesh.element_count(); ++e) {
    if (is_in_gap[static_cast<std::size_t>(e)]) found.push_back(e);
  }
  return found;
}

void raise_to(float& value, double to) {
  value = std::max(value, static_cast<float>(to));
}

}  // namespace

void add_gap_errors(const LitScene& lit, const GatherOptions& gather, RadiositySolution& solution,
                    int most, const BandArray* radiosity) {
  const PatchMesh& mesh = lit.mesh();
  if (solution.interpolation_error.size() != mesh.element_count()) return;
  const BandArray irradiance = solution.irradiance();
  const Eigen::ArrayXd reference = error_references(mesh, irradiance, solution.parts);
  std::vector<InnerError> lit_elements;
  for (const int e : elements_in_gaps(lit.caster)) {
    const int corners = mesh.corner_count(e), dark = dark_corners(mesh, irradiance, e);
    // If none of N rays found light, light from less than 3 / N of the directions may be missed
    // (rule of three, odds of 19 to 1), and the error is half of the bound.
    const double rays = static_cast<double>(corners) * gather.rays;
    if (dark > 0) raise_to(solution.interpolation_error[e], 0.5 * 3.0 / rays);
    if (dark != corners && reference[e] > 0.0) lit_elements.push_back({e});
  }
  measure_inside(lit, gather, solution, {.most = most, .radiosity = radiosity}, lit_elements);
  raise_to_measured(lit_elements, solution);
}

}  // namespace lightwell
