#include "radiosity/pilot_gathers.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "radiosity/accuracy.h"
#include "radiosity/even_caustics.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/gather/vertex_points.h"
#include "radiosity/journal/pace.h"
#include "radiosity/patch_light.h"
#include "radiosity/point_lists.h"
#include "radiosity/refine/refine_solution.h"
#include "radiosity/refine/shared_gathers.h"
#include "scene/errors.h"
#include "scene/stopwatch.h"

namespace lightwell {
namespace {

constexpr std::uint64_t pilot_replica = 1000;

// Indirect light at all vertices where rays read it; elsewhere 0.
BandArray read_indirect(const LitScene& lit, const BandArray& radiosity,
                        const GatherOptions& options) {
  const GatherPoints all = vertex_points(lit.caster);
  const std::vector<char> unread = unread_patches(lit.scene, lit.mesh());
  const std::vector<int> patch = vertex_patches(lit.mesh());
  std::vector<int> vertices;
  for (int v = 0; v < all.size(); ++v) {
    if (unread[patch[v]] == 0) vertices.push_back(v);
  }
  return spread_rows(
      gather_indirect(lit, radiosity, points_of_vertices(all, vertices), options).indirect,
      vertices, all.size());
}

}  // namespace

GatherOptions gather_options(const SolveOptions& options) {
  GatherOptions gather = options.gather;
  gather.run = options.run;
  return gather;
}

std::vector<int> rays_by_part(const SolveOptions& options) {
  std::vector<int> rays(static_cast<std::size_t>(options.refine.parts.judged_count()),
                        options.gather.rays);
  for (std::size_t p = 0; p < options.refine.efforts.size(); ++p) {
    rays[p] = options.refine.efforts[p].rays;
  }
  return rays;
}

struct PilotGathers::Impl {
  Impl(const Scene& of, PatchMesh mesh, const DirectLight& direct)
      : scene(of), base(std::move(mesh)), caster(base), direct_light(direct) {}

  PilotGather unrefined(const SolveOptions& options);
  RunControl in_haste(const SolveOptions& options) const;
  PilotGather at_patches(const SolveOptions& options);
  PilotGather at_base(const SolveOptions& options);
  void prepare(const SolveOptions& options);
  bool prepares_in_time(const SolveOptions& options);
  PilotGather refined(const SolveOptions& options);

  const Scene& scene;
  PatchMesh base;
  ElementCaster caster;
  const DirectLight& direct_light;
  double seconds_of_patches = 0.0;
  BandArray radiosity{};     // at the base's vertices, with columns of every channel
  BandArray of_all_light{};  // the sum of all channels; empty if light is not kept apart
  BandArray caustic{};       // at the base's vertices
  std::optional<DirectLight> all_light{};  // empty if light is not kept apart
  std::optional<RefinedElements> elements{};
  std::optional<EvenCaustics> even_caustics{};
  std::optional<SolutionRefinement> refinement{};
};

PilotGathers::PilotGathers(const Scene& scene, PatchMesh base, const DirectLight& direct_light,
                           const RadiositySolution& solution)
    : impl_(new Impl(scene, std::move(base), direct_light)) {
  const PatchMesh& mesh = impl_->base;
  for (const PhaseSeconds& phase : solution.seconds) impl_->seconds_of_patches += phase.seconds;
  impl_->radiosity = patch_to_vertex(mesh, direct_light, unscaled_radiosity(solution));
  if (direct_light.channel_count() == 1) return;
  impl_->all_light.emplace(scene, mesh, EmitterChannels{}, &direct_light);
  impl_->of_all_light = patch_to_vertex(mesh, *impl_->all_light, solution.patch_radiosity);
}

PilotGathers::~PilotGathers() = default;

PatchMesh& PilotGathers::base() {
  return impl_->base;
}

std::optional<PilotGather> PilotGathers::gather(const SolveOptions& options) {
  if (!(options.refine.tolerance > 0.0)) return impl_->unrefined(options);
  if (!impl_->refinement && !impl_->prepares_in_time(options)) return std::nullopt;
  return impl_->refined(options);
}

PilotGather PilotGathers::gather_in_haste(const SolveOptions& options) {
  const bool has_light = impl_->refinement && !impl_->all_light;
  return has_light ? impl_->at_base(options) : impl_->at_patches(options);
}

ElementCaster PilotGathers::caster(const PatchMesh& mesh, const PilotGather& pilot) const {
  return {mesh, impl_->caster, pilot.tree};
}

PilotGather PilotGathers::Impl::unrefined(const SolveOptions& options) {
  const LitScene lit{scene, caster, direct_light};
  GatherOptions gather = gather_options(options);
  PilotGather pilot{.shadows = gather.shadows, .gather_rays = rays_by_part(options)};
  SharedGathers shared = find_shared_gathers(scene, base);
  pilot.unread = std::move(shared.unread);
  pilot.rough = std::move(shared.rough);
  pilot.interpolated = pilot.unread;
  pilot.direct = direct_beside(lit, pilot.unread, gather);
  gather.rays = std::max(1, gather.rays / 4);
  gather.replica += pilot_replica;
  pilot.indirect = read_indirect(lit, radiosity, gather);
  pilot.caustic = caustics({scene, caster, direct_light}, options);
  return pilot;
}

// The run with the time that is left, or an eighth of the time that the patches took, if that is
// more: an early end takes some time in any case.
RunControl PilotGathers::Impl::in_haste(const SolveOptions& options) const {
  RunControl run = options.run;
  if (!run.has_limit()) return run;
  constexpr double overtime = 1.0 / 8.0;
  const double allowed = std::max(options.run.time_left(), overtime * seconds_of_patches);
  run.seconds_left = [allowed, watch = Stopwatch()] { return allowed - watch.seconds(); };
  return run;
}

PilotGather PilotGathers::Impl::at_patches(const SolveOptions& options) {
  // 1/sqrt(32) = 18 % of the spread of light among rays, as rough as one point of a patch is.
  constexpr int few_rays = 32;
  GatherOptions gather = gather_options(options);
  gather.rays = std::min(few_rays, gather.rays);
  gather.shadows = Effort{.gather_rays = gather.rays}.shadows(gather.shadows.many_lights);
  gather.replica += pilot_replica;
  const LitScene lit{scene, caster, direct_light};
  std::vector<int> patches(static_cast<std::size_t>(base.patch_count()));
  std::iota(patches.begin(), patches.end(), 0);
  const auto points = points_on_patches(base, patches);
  PilotGather pilot{.shadows = gather.shadows, .gather_rays = rays_by_part(options)};
  // Beside a window the light of the sky changes within a patch more than its noise by few rays.
  GatherOptions few = gather;
  few.shadows.min_rays /= 2;
  few.shadows.max_rays /= 4;
  SharedGathers shared = find_shared_gathers(scene, base);
  std::vector<InterpolatedVertex> interpolated = std::move(shared.unread);
  interpolated.insert(interpolated.end(), shared.read.begin(), shared.read.end());
  const bool is_finished = finishes_in_time(in_haste(options), [&](const RunControl& in_time) {
    few.run = in_time;
    pilot.direct = direct_beside(lit, interpolated, few);
    pilot.shadows = few.shadows;
  });
  if (!is_finished) pilot.direct = to_vertices(base, gather_direct(lit, points, gather));
  pilot.indirect = to_vertices(base, gather_indirect(lit, radiosity, points, gather).indirect);
  return pilot;
}

// Precondition: refinement has begun.
PilotGather PilotGathers::Impl::at_base(const SolveOptions& options) {
  GatheredIrradiance found = refinement->light_at_base();
  return {.direct = std::move(found.direct),
          .indirect = std::move(found.indirect),
          .shadows = gather_options(options).shadows,
          .caustic = caustic,
          .lacks_unread = true,
          .gather_rays = rays_by_part(options)};
}

void PilotGathers::Impl::prepare(const SolveOptions& options) {
  report(options.run.progress, "refine", 0.0);
  elements.emplace(base);
  report(options.run.progress, "refine", 0.0);
  even_caustics.emplace(LitScene{scene, caster, direct_light}, options, *elements);
  std::vector<int> base_vertices(static_cast<std::size_t>(base.vertex_count()));
  std::iota(base_vertices.begin(), base_vertices.end(), 0);
  caustic = even_caustics->at(*elements, base_vertices);
  const GatherOptions gather = gather_options(options);
  if (all_light) {
    refinement.emplace(LitScene{scene, caster, *all_light}, of_all_light,
                       channel_sum(caustic, scene.bands.count()), *elements, gather,
                       options.refine);
  } else {
    refinement.emplace(LitScene{scene, caster, direct_light}, radiosity, caustic, *elements, gather,
                       options.refine);
  }
}

// Returns false if the pace of a gather tells that there is not enough time.
bool PilotGathers::Impl::prepares_in_time(const SolveOptions& options) {
  if (!options.run.has_limit()) {
    prepare(options);
    return true;
  }
  // There are three gathers at least: direct light, and indirect light twice.
  constexpr double most_of_time = 0.5;
  const double allowed = most_of_time * options.run.time_left();
  struct Watch {
    Pace pace;
    double before = 0.0;
    bool is_on = true, gave_up = false;
  };
  // The refinement keeps its progress, and with it the watch.
  const auto watch = std::make_shared<Watch>(Watch{Pace(allowed)});
  SolveOptions watched = options;
  watched.run.progress = [allowed, watch, progress = options.run.progress](std::string_view phase,
                                                                           double share) {
    if (share < watch->before) watch->pace = Pace(allowed);  // the next gather
    watch->before = share;
    watch->gave_up = watch->gave_up || (watch->is_on && watch->pace.is_too_slow(share));
    return !watch->gave_up && (!progress || progress(phase, share));
  };
  try {
    prepare(watched);
  } catch (const Interrupted&) {
    if (!watch->gave_up) throw;
    return false;
  }
  watch->is_on = false;
  return true;
}

PilotGather PilotGathers::Impl::refined(const SolveOptions& options) {
  const ChannelLight by_channel{direct_light, radiosity, caustic};
  RefinedSolution found = refinement->refine(options.refine, all_light ? &by_channel : nullptr);
  BandArray at_vertices = even_caustics->at(*elements, found.refined.vertex);
  return {.refined = std::move(found.refined.mesh),
          .tree = std::move(found.refined.tree),
          .direct = std::move(found.pilot.direct),
          .indirect = std::move(found.pilot.indirect),
          .caustic = std::move(at_vertices),
          .lacks_unread = true,
          .interpolation_error = std::move(found.error),
          .refinement = found.report,
          .interpolated = std::move(found.interpolated),
          .predictions = std::move(found.predictions),
          .unread = std::move(found.unread),
          .rough = std::move(found.rough),
          .number = std::move(found.refined.vertex),
          .gather_rays = found.gather_rays};
}

}  // namespace lightwell
