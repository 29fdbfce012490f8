#include "radiosity/kept_gathers.h"

#include <utility>

#include "radiosity/gather/vertex_points.h"
#include "radiosity/refine/even_out_noise.h"
#include "radiosity/refine/gather_noise.h"
#include "radiosity/refine/shared_gathers.h"

namespace lightwell {
namespace {

constexpr std::uint64_t later_replicas = 2000;

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

}  // namespace

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

namespace {

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

// Gives interpolated vertices the means of their ends, and the rays that leave the same noise.
// `found.variance` is that of one ray.
void fill_interpolated(const std::vector<InterpolatedVertex>& interpolated,
                       GatheredIrradiance& found, Eigen::ArrayXf& rays) {
  interpolate_vertices(interpolated, found.indirect);
  for (const InterpolatedVertex& t : interpolated) {
    float inverse = 0.0f, variance = 0.0f;
    for (int i = 0; i < t.end_count(); ++i) {
      inverse += 1.0f / rays[t.ends[i]];
      variance += found.variance[t.ends[i]];
    }
    const auto ends = static_cast<float>(t.end_count());
    rays[t.vertex] = ends / inverse;
    found.variance[t.vertex] = variance / ends;
  }
}

// Lets neighbours even out their noise, except that of vertices which share gathers: their errors
// are alike. (Elements that are not refined stay as they are, so that relight() gives them the
// light of a solve to rounding.)
void even_out_own_noise(const LitScene& lit, const PilotGather& pilot, BandArray& indirect,
                        Eigen::ArrayXf& variance) {
  Eigen::ArrayXf own = variance;
  for (const int v : pilot.rough) own[v] = 0.0f;
  for (const VertexPrediction& b : pilot.predictions) {
    if (b.is_shared) own[b.at.vertex] = 0.0f;
  }
  Eigen::ArrayXf left = own;
  even_out_noise(lit.mesh(), pilot.predictions, lit.scene.bands.count(), indirect, left);
  interpolate_vertices(pilot.unread, indirect);
  variance = (own > 0.0f).select(left, variance);
}

// Joins each vertex's gather with the prediction of the pilot gather and with its neighbours.
void join_predictions(const LitScene& lit, const PilotGather& pilot, GatheredIrradiance& gather) {
  constexpr auto share = static_cast<float>(of_whole_set);
  const Eigen::ArrayXf before = share * gather.variance;
  Eigen::ArrayXf after = before;
  combine_with_predictions(pilot.predictions, pilot.indirect, vertex_patches(lit.mesh()),
                           lit.scene.bands.count(), gather.indirect, after);
  if (pilot.tree) even_out_own_noise(lit, pilot, gather.indirect, after);
  // Without noise there is nothing to compare.
  gather.variance = (before > 0.0f && after > 0.0f).select(after / share, gather.variance);
}

}  // namespace

GatheredIrradiance gather_once(const VertexGatherTask& task, const BandArray& radiosity,
                               KeptGather& kept) {
  gather_more(task, radiosity, kept);
  GatheredIrradiance found{.indirect = kept.indirect, .variance = kept.variance};
  const PatchMesh& mesh = task.lit.mesh();
  // Vertices that cast no rays have no noise.
  Eigen::ArrayXf rays = Eigen::Map<const Eigen::ArrayXi>(kept.rays.data(), mesh.vertex_count())
                            .cast<float>()
                            .max(1.0f);
  found.variance *= rays;
  fill_interpolated(task.pilot.interpolated, found, rays);
  found.variance = vertex_variance(mesh, found.variance, rays);
  join_predictions(task.lit, task.pilot, found);
  return found;
}

}  // namespace lightwell
