#include "radiosity/unjudged_errors.h"

#include <vector>

#include "mesh/patches/round_grid.h"
#include "radiosity/inner_errors.h"
#include "radiosity/refine/error_reference.h"
#include "radiosity/refine/shared_gathers.h"

namespace lightwell {
namespace {

// The elements on patches that do not count. A side that another surface covers has no light that
// could be measured.
std::vector<InnerError> unjudged_elements(const LitScene& lit, const SceneParts& parts) {
  const PatchMesh& mesh = lit.mesh();
  const std::vector<char> judged = judged_patches(mesh, parts), crumbs = crumb_patches(mesh),
                          unread = unread_patches(lit.scene, mesh);
  std::vector<InnerError> found;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    const bool is_back = mesh.is_back[p] != 0;
    const int front = is_back && mesh.twin[e] >= 0 ? mesh.twin[e] : e;
    const auto patch = static_cast<std::size_t>(p);
    const bool has_records = crumbs[patch] != 0 && unread[patch] != 0;
    if (judged[patch] != 0 || has_records || round_grid_of(mesh, mesh.facet[e]) ||
        lit.caster.is_hidden(front, is_back)) {
      continue;
    }
    found.push_back({e});
  }
  return found;
}

}  // namespace

void add_unjudged_errors(const LitScene& lit, const GatherOptions& gather,
                         RadiositySolution& solution, const BandArray* radiosity) {
  if (solution.interpolation_error.size() != lit.mesh().element_count()) return;
  std::vector<InnerError> elements = unjudged_elements(lit, solution.parts);
  // Light on these surfaces is even in most places, and the noise of 256 rays is a few percent of
  // the light before it is taken off.
  const InnerEffort effort{
      .most = 1024, .rays = 256, .counts_noise = false, .replica = 4500, .radiosity = radiosity};
  measure_inside(lit, gather, solution, effort, elements);
  raise_to_measured(elements, solution);
}

}  // namespace lightwell
