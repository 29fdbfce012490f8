#include "radiosity/form_factors/facet_view_factors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>

#include "mesh/build_patches.h"
#include "radiosity/form_factors/view_factor_scene.h"

namespace lightwell {
namespace {

// Mesh options for one row per facet. Ray casting samples a whole facet, so a facet is one patch.
// A hemicube has one centre per patch, and a closed form few shadow rays per pair of patches: both
// are summed over smaller patches. Every method cuts facets where other facets touch them.
constexpr int patches_of_hemicubes = 2048, patches_of_closed_forms = 512;
MeshOptions mesh_for_facets(FormFactorMethod method, const Scene& scene) {
  MeshOptions options{.elements_per_patch_edge = 1};
  if (method == FormFactorMethod::hemicube) {
    options.auto_patch_count = patches_of_hemicubes;
  } else if (method == FormFactorMethod::analytic) {
    options.auto_patch_count = patches_of_closed_forms;
  } else {
    options.max_patch_size = 2.0 * scene_bounds(scene).diagonal();
  }
  return options;
}

// Facets that cross each other by the dozen are cut into very many patches. Pairs of these with
// partly hidden patches are too many for closed forms; but a facet's factors are means over its
// patches, whose rays are independent, so few rays for each of them suffice. A facet that a few
// others stand on or cut is in fewer than eight patches.
bool are_facets_shredded(const PatchMesh& mesh, const ViewFactorRows& rows) {
  constexpr int many = patches_of_closed_forms, of_each = 8;
  return mesh.patch_count() > many && mesh.patch_count() / of_each > rows.count();
}

// Standard error of a patch's rays that gives a row the target error: rows with one large patch
// need most rays.
double target_of_patches(double target, const PatchMesh& mesh, const ViewFactorRows& rows) {
  const auto count = static_cast<std::size_t>(rows.count());
  std::vector<double> area(count, 0.0), squares(count, 0.0);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const int row = rows.of_patch[static_cast<std::size_t>(i)];
    if (row < 0) continue;
    area[static_cast<std::size_t>(row)] += mesh.area[i];
    squares[static_cast<std::size_t>(row)] += mesh.area[i] * mesh.area[i];
  }
  double least_even = 0.0;
  for (std::size_t row = 0; row < count; ++row) {
    if (area[row] > 0.0) least_even = std::max(least_even, std::sqrt(squares[row]) / area[row]);
  }
  return least_even > 0.0 ? target / least_even : target;
}

// Options of rays alone for shredded facets: as many as any share of them needs for the target, or
// those of a minute or two.
void take_rays_alone(double target, const PatchMesh& mesh, const ViewFactorRows& rows,
                     FormFactorOptions& options) {
  constexpr unsigned all_rays = 1u << 26;
  const double error = target_of_patches(target, mesh, rows);
  const auto most = std::bit_floor(all_rays / static_cast<unsigned>(mesh.patch_count()));
  const double needed = std::clamp(0.25 / (error * error), 1.0, static_cast<double>(most));
  options.method = FormFactorMethod::ray_cast;
  options.target_error = error;
  options.rays_per_patch =
      std::clamp(static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(needed)))),
                 options.rays_per_patch, options.most_rays_per_patch);
  options.most_rays_per_patch = options.rays_per_patch;
}

// Facets of a file, and their scene as pure geometry.
struct Facets {
  const NumberedScene& numbered;
  ViewFactorScene view;
};

PatchMesh mesh_of(FormFactorMethod method, const Facets& facets,
                  const FacetViewFactorOptions& asked) {
  MeshOptions options = mesh_for_facets(method, facets.view.scene);
  if (asked.max_patch_size > 0.0) options.max_patch_size = asked.max_patch_size;
  return build_patches(facets.view.scene, options, asked.progress);
}

// Computes the factors on the mesh that suits `method`.
FacetViewFactors computed_as(FormFactorMethod method, const Facets& facets,
                             const FacetViewFactorOptions& asked) {
  const auto& [numbered, view] = facets;
  const auto done = [&](const char* phase) {
    if (asked.phase_done) asked.phase_done(phase);
  };
  const bool per_patch = asked.max_patch_size > 0.0;
  FacetViewFactors found;
  found.mesh = mesh_of(method, facets, asked);
  done("mesh");
  found.rows =
      per_patch ? patch_rows(numbered, view, found.mesh) : facet_rows(numbered, view, found.mesh);
  if (asked.rows_found) asked.rows_found(found.rows);
  const ElementCaster caster(found.mesh);
  const DirectLight no_light(view.scene, found.mesh);
  FormFactorOptions options;
  options.method = method;
  options.target_error = asked.target_error;
  options.hemicube_resolution = asked.hemicube_resolution;
  options.memory = std::make_shared<MemoryBudget>(asked.memory);
  options.run = {.progress = asked.progress, .processes = asked.processes};
  found.has_rays_alone = method == FormFactorMethod::automatic && !per_patch &&
                         are_facets_shredded(found.mesh, found.rows);
  if (found.has_rays_alone) {
    take_rays_alone(asked.target_error, found.mesh, found.rows, options);
  }
  const auto form_factors =
      compute_form_factors({view.scene, caster, no_light}, options, &found.report);
  if (!found.report.row_error.empty()) {
    found.error = error_estimate(found.report, *form_factors, found.mesh, found.rows.of_patch);
  }
  found.factors = sum_form_factors(*form_factors, found.mesh, found.rows.of_patch,
                                   found.rows.count(), options.memory);
  found.storage = options.memory->report();
  done("form_factors");
  return found;
}

}  // namespace

FacetViewFactors facet_view_factors(const NumberedScene& numbered, const FacetCheck& check,
                                    const FacetViewFactorOptions& options) {
  const Facets facets{numbered, make_view_factor_scene(numbered, check, options.two_sided)};
  FacetViewFactors found = computed_as(options.method, facets, options);
  // Few whole facets may be too large for exact visibility of many corners, and for the rays of one
  // row. Closed forms of their parts come nearer to the target.
  const bool is_coarse = options.method == FormFactorMethod::automatic &&
                         !(options.max_patch_size > 0.0) &&
                         found.mesh.patch_count() < patches_of_closed_forms;
  if (is_coarse && found.is_short(options.target_error)) {
    FacetViewFactors finer = computed_as(FormFactorMethod::analytic, facets, options);
    if (*finer.error < *found.error) found = std::move(finer);
  }
  return found;
}

}  // namespace lightwell
