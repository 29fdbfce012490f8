#include "radiosity/reconstruct.h"

#include <algorithm>
#include <utility>

#include "radiosity/gather/body_exits.h"
#include "radiosity/gather/gatherable_radiosity.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/part_balance.h"
#include "radiosity/patch_light.h"
#include "radiosity/point_lists.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/refine/shared_gathers.h"

namespace lightwell {
namespace {

constexpr std::uint64_t first_replicas = 3000;

BandArray with_indirect(const PilotGather& pilot, const BandArray& indirect) {
  BandArray irradiance = pilot.direct + indirect;
  if (pilot.caustic.size() > 0) irradiance += pilot.caustic;
  return irradiance;
}

// The light that rays read where `irradiance` arrives at vertices; for refined elements with the
// power that the patches' equations balanced.
BandArray light_to_read(const VertexGatherTask& task, BandArray irradiance,
                        const RadiositySolution& solution) {
  const PatchMesh& mesh = task.lit.mesh();
  BandArray radiosity = gatherable_radiosity(task.lit, irradiance, task.pilot.direct);
  irradiance.resize(0, 0);
  if (task.pilot.tree) {
    keep_power(mesh, task.lit.direct_light, unscaled_radiosity(solution), radiosity);
  }
  PartBalance balance{.parts = task.parts, .gather = task.options, .caustic = task.pilot.caustic};
  for (const int rays : task.rays) balance.rays.push_back(task.cast_of(rays));
  balance_parts(task.lit, balance, radiosity);
  return radiosity;
}

// The pilot gather's direct light, or a new gather if that one cast fewer shadow rays.
BandArray final_direct(const LitScene& lit, const SolveOptions& of_solve, const PilotGather& pilot,
                       const RadiositySolution& solution) {
  const GatherOptions options = gather_options(of_solve);
  if (pilot.tree || (pilot.shadows.min_rays >= options.shadows.min_rays &&
                     pilot.shadows.max_rays >= options.shadows.max_rays)) {
    return pilot.direct;
  }
  BandArray direct = direct_beside(lit, pilot.unread, options);
  spread_pools(lit, unscaled_radiosity(solution), pilot.beside_direct(), of_solve.free_rays,
               direct);
  return direct;
}

GatherOptions with_most_rays(GatherOptions options, const std::vector<int>& of_parts) {
  options.rays = *std::ranges::max_element(of_parts);
  return options;
}

void split_by_channel(RadiositySolution& solution) {
  if (solution.channels.empty()) return;
  split_columns(solution.direct_irradiance, &LightChannel::direct_irradiance, solution.channels);
  split_columns(solution.indirect_irradiance, &LightChannel::indirect_irradiance,
                solution.channels);
  split_columns(solution.caustic_irradiance, &LightChannel::caustic_irradiance, solution.channels);
}

}  // namespace

void reconstruct(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                 RadiositySolution& solution, KeptGathers* kept) {
  for (BandArray* before : {&solution.direct_irradiance, &solution.indirect_irradiance}) {
    before->resize(0, before->cols());
  }
  const GatherOptions gather = gather_options(options);
  const std::vector<int> rays = rays_by_part(options);
  KeptGathers none;
  KeptGathers& so_far = kept ? *kept : none;
  carry_over(pilot.number, so_far);
  solution.direct_irradiance = final_direct(lit, options, pilot, solution);
  const std::vector<BodyExit> exits = BodyExits(lit).all();
  BandArray irradiance = with_indirect(pilot, pilot.indirect);
  if (pilot.tree) {
    // The final gather averages the noise of the second pilot gather over all directions, so few
    // rays suffice. With a sixteenth to a half of the rays, the error of indirect light in the hall
    // of 100 boxes (see docs/figures.md) is 0.67 to 0.65 %; if the final gather reads the first
    // pilot gather, 0.85 %.
    constexpr int few = 8;
    VertexGatherTask second{lit, pilot, gather, solution.parts, rays, few};
    second.options.replica += first_replicas;
    BandArray read = light_to_read(second, std::move(irradiance), solution);
    copy_from_outside(exits, read);
    const GatheredIrradiance found = gather_once(second, read, so_far.of_pilot);
    irradiance = with_indirect(pilot, found.indirect);
  }
  const VertexGatherTask task{lit, pilot, gather, solution.parts, rays};
  BandArray read = light_to_read(task, std::move(irradiance), solution);
  copy_from_outside(exits, read);
  GatheredIrradiance last = gather_once(task, read, so_far.last);
  last.direct = std::move(solution.direct_irradiance);
  light_covered_vertices(lit, exits, read, with_most_rays(gather, rays), last);
  solution.direct_irradiance = std::move(last.direct);
  irradiance = with_indirect(pilot, last.indirect);
  solution.indirect_irradiance = std::move(last.indirect);
  solution.indirect_irradiance = solution.indirect_irradiance.max(0.0f);
  solution.gather_noise =
      gather_noise(lit.mesh(), channel_sum(std::move(irradiance), lit.scene.bands.count()),
                   last.variance, solution.parts);
  if (pilot.caustic.size() > 0) solution.indirect_irradiance += pilot.caustic;
  solution.caustic_irradiance = pilot.caustic;
  solution.interpolation_error = pilot.interpolation_error;
  if (pilot.tree) {
    add_record_errors(lit.mesh(), pilot.unread,
                      channel_sum(solution.irradiance(), lit.scene.bands.count()), solution.parts,
                      solution.interpolation_error);
  }
  split_by_channel(solution);
}

namespace {

// Gives the vertices of unread patches the light at one point of the patch.
void light_unread_patches(const LitScene& lit, const SolveOptions& options,
                          const PilotGather& pilot, BandArray& indirect) {
  const PatchMesh& mesh = lit.mesh();
  const std::vector<char> unread = unread_patches(lit.scene, mesh);
  std::vector<int> patches;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (unread[p] != 0) patches.push_back(p);
  }
  if (patches.empty()) return;
  // Nothing but displays and probes on the surface itself show this light.
  constexpr int few_rays = 16;
  GatherOptions gather = gather_options(options);
  gather.rays = std::min(few_rays, gather.rays);
  const BandArray radiosity =
      gatherable_radiosity(mesh, lit.direct_light, with_indirect(pilot, indirect), pilot.direct);
  const BandArray of_patch = spread_rows(
      gather_indirect(lit, radiosity, points_on_patches(mesh, patches), gather).indirect, patches,
      mesh.patch_count());
  const std::vector<int> patch = vertex_patches(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (unread[patch[v]] != 0) indirect.row(v) = of_patch.row(patch[v]);
  }
}

}  // namespace

void take_pilot_light(const LitScene& lit, const SolveOptions& options, const PilotGather& pilot,
                      KeptGathers* kept, RadiositySolution& solution) {
  BandArray indirect = pilot.indirect;
  if (pilot.lacks_unread) light_unread_patches(lit, options, pilot, indirect);
  if (kept) {
    carry_over(pilot.number, *kept);
    const KeptGather& last = kept->last;
    for (std::size_t v = 0; v < last.rays.size(); ++v) {
      const auto row = static_cast<Eigen::Index>(v);
      if (last.rays[v] > 0) indirect.row(row) = last.indirect.row(row);
    }
    interpolate_vertices(pilot.interpolated, indirect);
  }
  solution.direct_irradiance = pilot.direct;
  solution.indirect_irradiance = indirect.max(0.0f);
  if (pilot.caustic.size() > 0) solution.indirect_irradiance += pilot.caustic;
  solution.caustic_irradiance = pilot.caustic;
  solution.interpolation_error.resize(0);
  solution.gather_noise = Eigen::ArrayXf::Zero(lit.mesh().element_count());
  split_by_channel(solution);
}

}  // namespace lightwell
