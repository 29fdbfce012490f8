#include "radiosity/reconstruct.h"
#include "radiosity/gather/caustic_irradiance.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/accuracy.h"
#include "radiosity/gather/gap_light.h"
#include "radiosity/gather/patch_power.h"
#include "radiosity/part_balance.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/refine/join_neighbours.h"
#include "radiosity/refine/refine_solution.h"
#include "radiosity/refine/shared_gathers.h"

namespace lightwell {
namespace {

// The gather points of all vertices.
GatherPoints vertex_points(const ElementCaster& caster) {
  const auto all = std::make_shared<VertexGatherPoints>(caster.mesh());
  return {caster.mesh().vertex_count(), [all, &caster](int v) {
            constexpr double inset = 0.02;  // of vertex_gather_points
            return moved_into_gap(caster, caster.mesh().position(v), inset, (*all)[v]);
          }};
}

// The points of some vertices, with the random numbers that they have among all.
GatherPoints points_of(const GatherPoints& all, const std::vector<int>& vertices) {
  return {static_cast<int>(vertices.size()), [&all, &vertices](int i) {
            const int v = vertices[static_cast<std::size_t>(i)];
            GatherPoint point = all[v];
            point.key = static_cast<std::uint64_t>(v);
            return point;
          }};
}

// Direct light at all vertices; those of unread crumbs take the mean of their records.
BandArray direct_beside(const LitScene& lit, const std::vector<InterpolatedVertex>& unread,
                        const GatherOptions& options) {
  const GatherPoints all = vertex_points(lit.caster);
  const std::vector<int> others = indices_without(unread, static_cast<std::size_t>(all.size()));
  BandArray direct =
      spread_rows(gather_direct(lit, points_of(all, others), options), others, all.size());
  interpolate_vertices(unread, direct);
  return direct;
}

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
  return spread_rows(gather_indirect(lit, radiosity, points_of(all, vertices), options).indirect,
                     vertices, all.size());
}

constexpr std::uint64_t pilot_replica = 1000, later_replicas = 2000, first_replicas = 3000;

// Patch radiosities without the emission that `direct_light` owns, patches x columns.
BandArray without_owned_emission(const PatchMesh& mesh, const DirectLight& direct_light,
                                 const BandArray& patch_radiosity) {
  BandArray B = patch_radiosity;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    const int facet = mesh.facet[mesh.first_element[p]];  // emitters' patches lie on one facet each
    if (!direct_light.owns(facet, mesh.is_back[p] != 0)) continue;
    B.row(p).segment(direct_light.first_column(facet), mesh.emission.cols()) -=
        mesh.emission.row(p);
  }
  return B;
}

// The mean of the patches around each vertex, weighted by the area of their elements there.
BandArray to_vertices(const PatchMesh& mesh, const BandArray& of_patches) {
  BandArray sum = BandArray::Zero(mesh.vertex_count(), of_patches.cols());
  Eigen::ArrayXf weight = Eigen::ArrayXf::Zero(mesh.vertex_count());
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto area = static_cast<float>(mesh.element_area[e]);
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      sum.row(mesh.corners[e][c]) += area * of_patches.row(mesh.patch[e]);
      weight[mesh.corners[e][c]] += area;
    }
  }
  return sum.colwise() / weight.max(1e-30f);
}

// The radiosity that the first gather reads: that of patches, smoothed to vertices.
BandArray patch_to_vertex(const PatchMesh& mesh, const DirectLight& direct_light,
                          const BandArray& patch_radiosity) {
  return to_vertices(mesh, without_owned_emission(mesh, direct_light, patch_radiosity));
}

// Scales the radiosity that gathers read (W/m^2, vertices x columns) to the power that the patches'
// equations balanced. Interpolation between vertices that are far apart cuts peaks off, and their
// power would be lost at each reflection.
//
// - One factor per band serves the whole scene. A factor for each patch would be worse: in corners
//   and beside objects that stand on a patch, the error of the patch's own value exceeds the power
//   that the factor restores.
// - A patch whose power is off by a notable share of the scene's light (see notable_share), such as
//   the place that a spotlight falls on, has a factor of its own. Its light would otherwise be
//   spread over all other surfaces.
//
// The factors follow from all channels together, so that channels still add up.
void keep_power(const PatchMesh& mesh, const DirectLight& direct_light,
                const BandArray& patch_radiosity, BandArray& radiosity) {
  const Eigen::Index bands = mesh.reflectance.cols();
  const BandArray balanced = channel_sum(
      without_owned_emission(mesh, direct_light, patch_radiosity), static_cast<int>(bands));
  const BandArray read = channel_sum(radiosity, static_cast<int>(bands));
  Eigen::ArrayXXd wanted(mesh.patch_count(), bands);  // W
  for (int p = 0; p < mesh.patch_count(); ++p) {
    wanted.row(p) = mesh.area[p] * balanced.row(p).cast<double>();
  }
  const Eigen::ArrayXXd found = patch_integral(mesh, read);
  constexpr double most = 1.25;  // a larger factor means that elements are too large to trust it
  const auto ratio = [most](const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) -> Eigen::ArrayXd {
    return (b > 0.0).select(a / b.max(1e-300), 1.0).max(1.0 / most).min(most);
  };
  const double least = notable_share(mesh) * wanted.sum();
  const auto is_peak = [&](int p) {
    return std::abs(wanted.row(p).sum() - found.row(p).sum()) > least;
  };
  Eigen::ArrayXd other_wanted = Eigen::ArrayXd::Zero(bands), other_found = other_wanted;
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (is_peak(p)) continue;
    other_wanted += wanted.row(p).transpose();
    other_found += found.row(p).transpose();
  }
  const Eigen::ArrayXf of_others = ratio(other_wanted, other_found).cast<float>();
  BandArray factor(mesh.patch_count(), bands);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    factor.row(p) = of_others.transpose();
    if (!is_peak(p)) continue;
    factor.row(p) =
        ratio(wanted.row(p).transpose(), found.row(p).transpose()).cast<float>().transpose();
  }
  const BandArray at_vertices = to_vertices(mesh, factor);
  for (Eigen::Index k = 0; k < radiosity.cols(); k += bands) {
    radiosity.middleCols(k, bands) *= at_vertices;
  }
}

BandArray caustics(const LitScene& lit, const SolveOptions& options) {
  return caustic_irradiance(lit, options.caustic_rays, options.form_factors.max_specular_depth,
                            options.run);
}

// The leaves that are not much smaller than most of the area is cut into.
std::vector<int> large_leaves(const RefinedElements& elements) {
  const double typical = typical_leaf_area(elements);
  constexpr double small = 1.0 / 64.0;  // as crumbs are small
  std::vector<int> large;
  for (const int cell : elements.leaves()) {
    if (elements.area(cell) > small * typical) large.push_back(cell);
  }
  return large;
}

// Caustics on elements of even size; vertices of refined elements interpolate them. Refined
// elements would be too small for the number of rays, and so are those of crumbs.
class EvenCaustics {
 public:
  EvenCaustics(const Scene& scene, const DirectLight& direct_light, const SolveOptions& options,
               RefinedElements& elements) {
    const LightPaths paths(scene, ElementCaster(elements.base()), 1);
    if (!paths.has_specular()) return;
    const std::vector<int> large = large_leaves(elements);
    if (starts_coarse(options) && options.mesh.elements_per_patch_edge > 1) elements.split(large);
    const RefinedMesh even = elements.mesh();
    elements.merge(large);
    values_ = BandArray::Zero(elements.vertex_count(), direct_light.column_count());
    const BandArray found = caustics({scene, ElementCaster(even.mesh), direct_light}, options);
    if (found.size() == 0) return;
    known_ = elements.vertex_count();
    for (std::size_t v = 0; v < even.vertex.size(); ++v) {
      values_.row(even.vertex[v]) = found.row(static_cast<Eigen::Index>(v));
    }
  }

  BandArray at(const RefinedElements& elements, const std::vector<int>& vertices) {
    if (known_ == 0) return {};
    values_.conservativeResize(elements.vertex_count(), values_.cols());
    for (int v = known_; v < elements.vertex_count(); ++v) {
      values_.row(v).setZero();
      int count = 0;
      for (const int end : elements.ends(v)) {
        if (end < 0) continue;
        values_.row(v) += values_.row(end);
        ++count;
      }
      values_.row(v) /= static_cast<float>(count);
    }
    BandArray result(static_cast<Eigen::Index>(vertices.size()), values_.cols());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      result.row(static_cast<Eigen::Index>(v)) = values_.row(vertices[v]);
    }
    return result;
  }

 private:
  BandArray values_{};
  int known_ = 0;  // vertices of the even elements; 0: there are no caustics
};

// Patch radiosities, with columns of every channel at full scale.
BandArray unscaled_radiosity(const RadiositySolution& solution) {
  if (solution.channels.empty()) return solution.patch_radiosity;
  return side_by_side(solution.channels, &LightChannel::patch_radiosity);
}

GatherOptions gather_options(const SolveOptions& options) {
  GatherOptions gather = options.gather;
  gather.run = options.run;
  return gather;
}

// Rays of the final gather in each part.
std::vector<int> rays_by_part(const SolveOptions& options) {
  std::vector<int> rays(static_cast<std::size_t>(options.refine.parts.judged_count()),
                        options.gather.rays);
  for (std::size_t p = 0; p < options.refine.efforts.size(); ++p) {
    rays[p] = options.refine.efforts[p].rays;
  }
  return rays;
}

// Replaces row v by the old row[v], or by nothing gathered if that is -1.
void take_rows(const std::vector<int>& row, KeptGather& kept) {
  if (kept.rays.empty()) return;
  const auto count = static_cast<Eigen::Index>(row.size());
  KeptGather taken{.rays = std::vector<int>(row.size(), 0),
                   .indirect = BandArray::Zero(count, kept.indirect.cols()),
                   .variance = Eigen::ArrayXf::Zero(count),
                   .count = kept.count};
  for (Eigen::Index v = 0; v < count; ++v) {
    if (row[v] < 0) continue;
    taken.rays[v] = kept.rays[row[v]];
    taken.indirect.row(v) = kept.indirect.row(row[v]);
    taken.variance[v] = kept.variance[row[v]];
  }
  kept = std::move(taken);
}

// Brings kept gathers over to the vertices of another pilot gather, by their numbers.
void carry_over(const std::vector<int>& number, KeptGathers& kept) {
  if (kept.number == number) return;
  int numbers = 0;
  for (const int n : kept.number) numbers = std::max(numbers, n + 1);
  std::vector<int> row_of(numbers, -1), row;
  for (std::size_t v = 0; v < kept.number.size(); ++v) row_of[kept.number[v]] = static_cast<int>(v);
  for (const int n : number) row.push_back(n < numbers ? row_of[n] : -1);
  take_rows(row, kept.of_pilot);
  take_rows(row, kept.last);
  kept.number = number;
}

// A gather of indirect light at the vertices of a pilot gather.
struct VertexGatherTask {
  const LitScene& lit;
  const PilotGather& pilot;
  GatherOptions options{};
  const SceneParts& parts;
  std::vector<int> rays{};  // in each part
  int one_in = 1;           // the gather casts one in so many of the rays
  int cast_of(int all) const { return all > 0 ? std::max(1, all / one_in) : 0; }
};

// The vertices at which rays are missing, and how many.
struct MissingRays {
  std::vector<int> vertex{}, rays{};
};

// Rays of each vertex: those that share_rays() gives it, or fewer where no ray reads the light. A
// pilot gather has none there, and the final gather few at the records of crumbs.
std::vector<int> rays_of_vertices(const VertexGatherTask& task) {
  const PatchMesh& mesh = task.lit.mesh();
  std::vector<int> rays = share_rays(mesh, task.pilot.interpolated, task.parts, task.rays);
  constexpr int few = 32;
  for (const int v : task.pilot.rough) {
    rays[v] = std::min(rays[v], std::max(1, task.options.rays / few));
  }
  if (task.one_in == 1) return rays;
  const std::vector<char> unread = unread_patches(task.lit.scene, mesh);
  const std::vector<int> patch = vertex_patches(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) rays[v] = unread[patch[v]] != 0 ? 0 : rays[v];
  return rays;
}

// Each vertex wants one in `one_in` of its rays, less those already kept; interpolated vertices
// want none.
MissingRays missing_rays(const VertexGatherTask& task, const KeptGather& kept) {
  const PatchMesh& mesh = task.lit.mesh();
  MissingRays missing;
  const std::vector<int> share_of = rays_of_vertices(task);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int wanted = task.cast_of(share_of[v]);
    const int more = wanted - (kept.rays.empty() ? 0 : kept.rays[v]);
    if (more <= 0) continue;
    missing.vertex.push_back(v);
    missing.rays.push_back(more);
  }
  return missing;
}

// Adds a gather to those kept: means weighted by rays.
void add_gather(const MissingRays& cast, const GatheredIrradiance& found, KeptGather& kept) {
  for (std::size_t i = 0; i < cast.vertex.size(); ++i) {
    const int row = cast.vertex[i];
    const auto of_found = static_cast<Eigen::Index>(i);
    const int sum = kept.rays[row] + cast.rays[i];
    const float share = static_cast<float>(cast.rays[i]) / static_cast<float>(sum);
    kept.indirect.row(row) =
        (1.0f - share) * kept.indirect.row(row) + share * found.indirect.row(of_found);
    kept.variance[row] = (1.0f - share) * (1.0f - share) * kept.variance[row] +
                         share * share * found.variance[of_found];
    kept.rays[row] = sum;
  }
}

// Gathers indirect light with the rays that are missing, with random numbers of their own.
void gather_more(const VertexGatherTask& task, const BandArray& radiosity, KeptGather& kept) {
  const PatchMesh& mesh = task.lit.mesh();
  const MissingRays missing = missing_rays(task, kept);
  const GatherPoints all = vertex_points(task.lit.caster);
  const GatherPoints fresh(static_cast<int>(missing.vertex.size()), [&](int i) {
    GatherPoint at = all[missing.vertex[i]];
    at.key = static_cast<std::uint64_t>(missing.vertex[i]);
    at.rays = missing.rays[i];
    return at;
  });
  GatherOptions options = task.options;
  if (kept.count > 0) options.replica += later_replicas + kept.count;
  ++kept.count;
  const GatheredIrradiance found = gather_indirect(task.lit, radiosity, fresh, options);
  if (kept.rays.empty()) {
    const int count = mesh.vertex_count();
    kept.rays.assign(count, 0);
    kept.indirect.setZero(count, radiosity.cols());
    kept.variance.setZero(count);
  }
  add_gather(missing, found, kept);
}

// Indirect light at vertices, with the variance of one of a vertex's rays; `rays` is how many rays
// each vertex stands for, with what predictions add to its own.
struct VertexGather {
  GatheredIrradiance found{};
  Eigen::ArrayXf rays{};
};

// Gives interpolated vertices the means of their ends, and the rays that leave the same noise.
void fill_interpolated(const std::vector<InterpolatedVertex>& interpolated, VertexGather& gather) {
  interpolate_vertices(interpolated, gather.found.indirect);
  for (const InterpolatedVertex& t : interpolated) {
    float inverse = 0.0f, variance = 0.0f;
    for (int i = 0; i < t.end_count(); ++i) {
      inverse += 1.0f / gather.rays[t.ends[i]];
      variance += gather.found.variance[t.ends[i]];
    }
    const auto ends = static_cast<float>(t.end_count());
    gather.rays[t.vertex] = ends / inverse;
    gather.found.variance[t.vertex] = variance / ends;
  }
}

// Lets neighbours even out their noise, except that of vertices which share gathers: their errors
// are alike. (Elements that are not refined stay as they are, so that relight() gives them the
// light of a solve to rounding.)
void even_out_noise(const LitScene& lit, const PilotGather& pilot, BandArray& indirect,
                    Eigen::ArrayXf& variance) {
  Eigen::ArrayXf own = variance;
  for (const int v : pilot.rough) own[v] = 0.0f;
  for (const VertexPrediction& b : pilot.predictions) {
    if (b.is_shared) own[b.at.vertex] = 0.0f;
  }
  Eigen::ArrayXf left = own;
  join_neighbours(lit.mesh(), pilot.predictions, lit.scene.bands.count(), indirect, left);
  interpolate_vertices(pilot.unread, indirect);
  variance = (own > 0.0f).select(left, variance);
}

// Joins each vertex's gather with the prediction of the pilot gather and with its neighbours, and
// counts the rays that leave the noise of all together.
void join_predictions(const LitScene& lit, const PilotGather& pilot, VertexGather& gather) {
  const PatchMesh& mesh = lit.mesh();
  const int count = mesh.vertex_count();
  // Half of the difference between a stratified set's two halves is more than the error of the
  // whole set (see estimate_error). The variance found at one vertex is little more than a guess,
  // so all vertices of a patch take the patch's mean.
  constexpr double share_of_whole_set = 0.5;
  const std::vector<int> patch = vertex_patches(mesh);
  const Eigen::ArrayXd of_patch = patch_integral(mesh, gather.found.variance).col(0);
  Eigen::ArrayXf before(count);
  for (int v = 0; v < count; ++v) {
    const double area = mesh.area[patch[v]],
                 of_a_ray = area > 0.0 ? of_patch[patch[v]] / area : 0.0;
    before[v] = static_cast<float>(share_of_whole_set * of_a_ray / double{gather.rays[v]});
  }
  Eigen::ArrayXf after = before;
  combine_with_predictions(pilot.predictions, pilot.indirect, patch, lit.scene.bands.count(),
                           gather.found.indirect, after);
  if (pilot.tree) even_out_noise(lit, pilot, gather.found.indirect, after);
  // Without noise there is nothing to compare.
  gather.rays *= (before > 0.0f && after > 0.0f).select(before / after.max(1e-30f), 1.0f);
}

// Adds the missing rays to those kept, and joins the predictions of the pilot gather.
VertexGather gather_once(const VertexGatherTask& task, const BandArray& radiosity,
                         KeptGather& kept) {
  gather_more(task, radiosity, kept);
  VertexGather gather{.found = {.indirect = kept.indirect, .variance = kept.variance}};
  const int count = task.lit.mesh().vertex_count();
  // Vertices that cast no rays have no noise.
  gather.rays = Eigen::Map<const Eigen::ArrayXi>(kept.rays.data(), count).cast<float>().max(1.0f);
  gather.found.variance *= gather.rays;
  fill_interpolated(task.pilot.interpolated, gather);
  join_predictions(task.lit, task.pilot, gather);
  return gather;
}

}  // namespace

struct PilotGathers::Impl {
  Impl(const Scene& of, PatchMesh mesh, const DirectLight& direct)
      : scene(of), base(std::move(mesh)), caster(base), direct_light(direct) {}

  PilotGather unrefined(const SolveOptions& options);
  PilotGather at_patches(const SolveOptions& options);
  void prepare(const SolveOptions& options);
  PilotGather refined(const SolveOptions& options);

  const Scene& scene;
  PatchMesh base;
  ElementCaster caster;
  const DirectLight& direct_light;
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
  impl_->radiosity = patch_to_vertex(mesh, direct_light, unscaled_radiosity(solution));
  if (direct_light.channel_count() == 1) return;
  impl_->all_light.emplace(scene, mesh, EmitterChannels{}, &direct_light);
  impl_->of_all_light = patch_to_vertex(mesh, *impl_->all_light, solution.patch_radiosity);
}

PilotGathers::~PilotGathers() = default;

PatchMesh& PilotGathers::base() {
  return impl_->base;
}

PilotGather PilotGathers::gather(const SolveOptions& options) {
  return options.refine.tolerance > 0.0 ? impl_->refined(options) : impl_->unrefined(options);
}

PilotGather PilotGathers::gather_at_patches(const SolveOptions& options) {
  return impl_->at_patches(options);
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

namespace {

// One point of each of the `patches`.
GatherPoints points_on(const PatchMesh& mesh, const std::vector<int>& patches) {
  return {static_cast<int>(patches.size()), [&mesh, &patches](int i) {
            const PatchPoint at =
                PatchSampler(mesh, patches[static_cast<std::size_t>(i)]).point(0.5, 0.5);
            return GatherPoint{at.position, at.normal, mesh.facet[at.element]};
          }};
}

}  // namespace

PilotGather PilotGathers::Impl::at_patches(const SolveOptions& options) {
  // 1/sqrt(32) = 18 % of the spread of light among rays, as rough as one point of a patch is.
  constexpr int few_rays = 32;
  GatherOptions gather = gather_options(options);
  gather.rays = std::min(few_rays, gather.rays);
  gather.shadows = Effort{.gather_rays = gather.rays}.shadows();
  gather.replica += pilot_replica;
  std::vector<int> patches(static_cast<std::size_t>(base.patch_count()));
  std::iota(patches.begin(), patches.end(), 0);
  const GatheredIrradiance found =
      gather_irradiance({scene, caster, direct_light}, radiosity, points_on(base, patches), gather);
  return {.direct = to_vertices(base, found.direct),
          .indirect = to_vertices(base, found.indirect),
          .shadows = gather.shadows,
          .gather_rays = rays_by_part(options)};
}

void PilotGathers::Impl::prepare(const SolveOptions& options) {
  report(options.run.progress, "refine", 0.0);
  elements.emplace(base);
  report(options.run.progress, "refine", 0.0);
  even_caustics.emplace(scene, direct_light, options, *elements);
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

PilotGather PilotGathers::Impl::refined(const SolveOptions& options) {
  if (!refinement) prepare(options);
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

namespace {

BandArray with_indirect(const PilotGather& pilot, const BandArray& indirect) {
  BandArray irradiance = pilot.direct + indirect;
  if (pilot.caustic.size() > 0) irradiance += pilot.caustic;
  return irradiance;
}

// Gathers in the light that `irradiance`, at vertices, makes; for refined elements with the power
// that the patches' equations balanced.
VertexGather gather_in(const VertexGatherTask& task, BandArray irradiance,
                       const RadiositySolution& solution, KeptGather& kept) {
  const PatchMesh& mesh = task.lit.mesh();
  BandArray radiosity =
      gatherable_radiosity(mesh, task.lit.direct_light, irradiance, task.pilot.direct);
  irradiance.resize(0, 0);
  if (task.pilot.tree) {
    keep_power(mesh, task.lit.direct_light, unscaled_radiosity(solution), radiosity);
  }
  PartBalance balance{.parts = task.parts, .gather = task.options};
  for (const int rays : task.rays) balance.rays.push_back(task.cast_of(rays));
  balance_parts(task.lit, balance, radiosity);
  return gather_once(task, radiosity, kept);
}

// The pilot gather's direct light, or a new gather if that one cast fewer shadow rays.
BandArray final_direct(const LitScene& lit, const GatherOptions& options,
                       const PilotGather& pilot) {
  if (pilot.tree || (pilot.shadows.min_rays >= options.shadows.min_rays &&
                     pilot.shadows.max_rays >= options.shadows.max_rays)) {
    return pilot.direct;
  }
  return direct_beside(lit, pilot.unread, options);
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
  solution.direct_irradiance = final_direct(lit, gather, pilot);
  BandArray irradiance = with_indirect(pilot, pilot.indirect);
  if (pilot.tree) {
    // The final gather averages the noise of the second pilot gather over all directions, so few
    // rays suffice. With a sixteenth to a half of the rays, the error of indirect light in the hall
    // of 100 boxes (see docs/figures.md) is 0.67 to 0.65 %; if the final gather reads the first
    // pilot gather, 0.85 %.
    constexpr int few = 8;
    VertexGatherTask second{lit, pilot, gather, solution.parts, rays, few};
    second.options.replica += first_replicas;
    const VertexGather found = gather_in(second, std::move(irradiance), solution, so_far.of_pilot);
    irradiance = with_indirect(pilot, found.found.indirect);
  }
  VertexGather last = gather_in({lit, pilot, gather, solution.parts, rays}, std::move(irradiance),
                                solution, so_far.last);
  irradiance = with_indirect(pilot, last.found.indirect);
  solution.indirect_irradiance = std::move(last.found.indirect);
  solution.indirect_irradiance = solution.indirect_irradiance.max(0.0f);
  solution.gather_noise =
      gather_noise(lit.mesh(), channel_sum(std::move(irradiance), lit.scene.bands.count()),
                   last.found.variance, last.rays, solution.parts);
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
  const BandArray of_patch =
      spread_rows(gather_indirect(lit, radiosity, points_on(mesh, patches), gather).indirect,
                  patches, mesh.patch_count());
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
