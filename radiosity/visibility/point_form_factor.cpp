#include "radiosity/visibility/point_form_factor.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "mesh/patches/patch_sampler.h"
#include "radiosity/closed_forms/polygon_form_factor.h"
#include "radiosity/visibility/shadow_rays.h"
#include "radiosity/visibility/shadowed_polygon.h"
#include "radiosity/visibility/visible_exchange.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Vector3d;

constexpr int points_at_once = 128;
// Smaller F is rounding: the shooter is edge-on or at the horizon.
constexpr double negligible_factor = 1e-12;

// Stratified sample points of one shooter.
class ShooterSamples {
 public:
  ShooterSamples(const PatchMesh& mesh, int patch, int most_samples)
      : mesh_(mesh), patch_(patch), sampler_(mesh, patch), sobol_(most_samples) {}

  // The shadow ray from a receiving point to sample s, weighted by cos cos / (pi r^2 + disc).
  ShadowSample sample(const ReceivingPoint& from, int s, double disc) const {
    const auto key =
        random_key(static_cast<std::uint64_t>(patch_), from.key, RandomPurpose::shooter_points);
    const Eigen::Array4f u = sobol_.point(s, key);
    const PatchPoint to = sampler_.point(u[0], u[1]);
    const Vector3d way = to.position - from.position;
    const double squared = way.squaredNorm();
    const double cosines = std::max(0.0, from.normal.dot(way)) * std::max(0.0, -to.normal.dot(way));
    return {
        .ray = {.origin = from.position,
                .direction = way,
                .t_max = 1.0,
                .origin_group = from.facet,
                .target_group = mesh_.facet[to.element]},
        .weight = squared > 0.0 ? cosines / (squared * (std::numbers::pi * squared + disc)) : 0.0};
  }

 private:
  const PatchMesh& mesh_;
  int patch_;
  PatchSampler sampler_;
  SobolPoints sobol_;
};

}  // namespace

ReceivingPoint receiving_corner(const PatchMesh& mesh, int element, int corner) {
  constexpr double inwards = 1e-4;
  const PatchPoint middle = element_center(mesh, element);
  const int vertex = mesh.corners[element][corner];
  const Vector3d at = mesh.position(vertex);
  return {.position = at + inwards * (middle.position - at),
          .normal = mesh.vertex_normal[vertex],
          .facet = mesh.facet[element],
          .key = static_cast<std::uint64_t>(vertex)};
}

PointFormFactors::PointFormFactors(const ElementCaster& caster)
    : caster_(caster), shafts_(caster.mesh()) {}

void PointFormFactors::by_discs(int shooter, int n, std::span<const ReceivingPoint> points,
                                std::span<double> F) const {
  assert(points.size() == F.size());
  const PatchMesh& mesh = caster_.mesh();
  const ShooterSamples samples(mesh, shooter, n);
  const ShaftEnd end = shafts_.end(patch_outline(mesh, shooter), mesh.facet_of(shooter));
  const double disc = mesh.area[shooter] / n;
  parallel_for(static_cast<int>(points.size()), points_at_once, [&](int begin, int stop) {
    std::array<ShadowTally, points_at_once> tallies{};
    ShadowBatch batch(caster_, tallies);
    for (int p = begin; p < stop; ++p) {
      const bool is_behind = !end.parts.empty() && !(end.plane.height(points[p].position) >
                                                     shafts_.occluders().tolerance);
      for (int s = 0; s < n && !is_behind; ++s) {
        batch.add(p - begin, samples.sample(points[p], s, disc));
      }
    }
    batch.flush();
    for (int p = begin; p < stop; ++p) F[p] = std::min(1.0, disc * tallies[p - begin].seen);
  });
}

// F, without its visibility where shadow rays are needed.
PointFormFactors::Unsampled PointFormFactors::without_rays(const ShaftEnd& target,
                                                           const ReceivingPoint& point) const {
  const Occluders& occluders = shafts_.occluders();
  if (!(target.plane.height(point.position) > occluders.tolerance)) return {};
  Unsampled result;
  for (const ConvexPolygon& part : target.parts) {
    result.F += point_to_polygon(point.position, point.normal, part.corners());
  }
  if (!(result.F > negligible_factor)) return {};
  result.F = std::min(result.F, 1.0);
  const ShaftEnd from = shafts_.end({point.position, point.normal, point.facet});
  Between between;
  shafts_.find(from, target, between);
  result.needs_rays = between.may_be_round || between.pieces.size() > most_pieces_between ||
                      shafts_.is_covered(from);
  if (result.needs_rays) return result;
  std::vector<Blocker> blockers;
  for (const int piece : between.pieces) {
    const Occluder& occluder = occluders.pieces[piece];
    const int side = occluder.plane.height(point.position) > 0.0 ? 1 : -1;
    Blocker blocker;
    if (make_blocker(occluder, side, from, target, occluders.tolerance, blocker)) {
      blockers.push_back(blocker);
    }
  }
  if (blockers.empty()) return result;
  const auto view = ShadowedPolygon(target.parts, blockers).view_from(point.position, point.normal);
  result.F = view.all - view.hidden;
  return result;
}

void PointFormFactors::by_closed_form(int shooter, std::span<const ReceivingPoint> points,
                                      std::span<double> F,
                                      const PointFormFactorOptions& options) const {
  assert(points.size() == F.size());
  const PatchMesh& mesh = caster_.mesh();
  const ShaftEnd target = shafts_.end(patch_outline(mesh, shooter), mesh.facet_of(shooter));
  const int most = std::max(1, options.max_rays), least = std::clamp(options.min_rays, 1, most);
  if (target.parts.empty()) {
    by_discs(shooter, most, points, F);
    return;
  }
  const ShooterSamples samples(mesh, shooter, most);
  const bool is_covered = shafts_.is_covered(target);
  parallel_for(static_cast<int>(points.size()), points_at_once, [&](int begin, int stop) {
    std::vector<int> sampled;
    for (int p = begin; p < stop; ++p) {
      const Unsampled found = without_rays(target, points[p]);
      F[p] = found.F;
      if (found.F > 0.0 && (found.needs_rays || is_covered)) sampled.push_back(p);
    }
    std::array<ShadowTally, points_at_once> tallies{};
    ShadowBatch batch(caster_, tallies);
    for (int done = 0, goal = least; !sampled.empty();) {
      for (const int p : sampled) {
        for (int s = done; s < goal; ++s) batch.add(p - begin, samples.sample(points[p], s, 0.0));
      }
      batch.flush();
      done = goal;
      goal = goal > most / 4 ? most : 4 * goal;
      std::erase_if(sampled, [&](int p) {
        const ShadowTally& tally = tallies[p - begin];
        const double error = F[p] * std::sqrt(tally.variance());
        if (done < most && tally.is_mixed() && error > options.target_error) return false;
        F[p] *= tally.share();
        return true;
      });
    }
  });
}

}  // namespace lightwell
