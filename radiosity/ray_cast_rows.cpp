#include "radiosity/ray_cast_rows.h"

#include <algorithm>
#include <array>
#include <map>

#include "scene/hemisphere_sets.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

constexpr std::uint64_t form_factor_rays = 1;  // purposes of random keys
constexpr std::uint64_t form_factor_branches = 2;
constexpr int batch = 64;

// Scratch that a piece of the parallel loop reuses from patch to patch.
class Counter {
 public:
  explicit Counter(int patches) : count(patches, 0) {}
  void add(int patch) {
    if (count[patch]++ == 0) touched.push_back(patch);
  }
  std::vector<RayCastRow::Count> take() {
    put_in_order();
    std::vector<RayCastRow::Count> counts;
    counts.reserve(touched.size());
    for (int patch : touched) {
      counts.push_back({patch, count[patch]});
      count[patch] = 0;
    }
    touched.clear();
    return counts;
  }

 private:
  // Where many of all patches were touched, looking through all is quicker than sorting.
  void put_in_order() {
    constexpr std::size_t few = 32;
    if (touched.size() * few < count.size()) {
      std::sort(touched.begin(), touched.end());
      return;
    }
    touched.clear();
    for (std::size_t i = 0; i < count.size(); ++i) {
      if (count[i] > 0) touched.push_back(static_cast<int>(i));
    }
  }

  std::vector<int> count;
  std::vector<int> touched;
};

RayCastRow cast_row(const ElementCaster& caster, const LightPaths& paths,
                    const HemisphereSets& sets, int patch, int rays, Counter& counter) {
  const PatchMesh& mesh = caster.mesh();
  const int bands = static_cast<int>(mesh.reflectance.cols());
  RayCastRow row{.rays = rays,
                 .specular_escaped = Spectrum::Zero(bands),
                 .absorbed = Spectrum::Zero(bands),
                 .cut = Spectrum::Zero(bands)};
  std::map<int, Spectrum> by_way_of_specular;
  const std::uint64_t key = random_key(static_cast<std::uint64_t>(patch), form_factor_rays);
  const PatchSampler sampler(mesh, patch);
  std::array<Ray, batch> ray;
  std::array<ElementHit, batch> hit;
  const HemisphereSets::Draw draw = sets.draw(key);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Eigen::Matrix3d frame = Eigen::Matrix3d::Identity();
  for (int begin = 0; begin < rays; begin += batch) {
    const int count = std::min(batch, rays - begin);
    const auto n = static_cast<std::size_t>(count);
    const auto points = draw.points(begin, count);
    for (int r = 0; r < count; ++r) {
      const Eigen::Vector2d place = draw.place(points[r]);
      const PatchPoint from = sampler.point(place.x(), place.y());
      if (from.normal != normal) {  // the same all over a flat patch
        normal = from.normal;
        frame = draw.frame(normal);
      }
      ray[r] = {.origin = from.position,
                .direction = frame * Eigen::Vector3d(points[r].x, points[r].y, points[r].z),
                .origin_group = mesh.facet[patch]};
    }
    caster.closest_hits({ray.data(), n}, {hit.data(), n});
    for (int r = 0; r < count; ++r) {
      const ElementHit& h = hit[r];
      const bool specular = h.facet >= 0 && paths.is_specular(h.facet);
      if (!specular) {
        if (h.element >= 0) {
          counter.add(mesh.patch[h.element]);
        } else {
          ++row.escaped;
        }
        continue;
      }
      if (paths.is_diffuse(h.facet) && h.element >= 0) {
        counter.add(mesh.patch[h.element]);
      } else {
        ++row.specular;
      }
      const PathLosses losses = paths.follow(
          ray[r], h, random_key(key, form_factor_branches, static_cast<std::uint64_t>(begin + r)),
          [&](const ElementHit& end, const Spectrum& throughput) {
            auto [at, is_new] = by_way_of_specular.try_emplace(mesh.patch[end.element], throughput);
            if (!is_new) at->second += throughput;
          });
      row.specular_escaped += losses.escaped;
      row.absorbed += losses.absorbed;
      row.cut += losses.cut;
    }
  }
  row.counts = counter.take();
  row.specular_weight.resize(static_cast<Eigen::Index>(by_way_of_specular.size()), bands);
  for (const auto& [to, weight] : by_way_of_specular) {
    row.specular_weight.row(static_cast<Eigen::Index>(row.specular_patch.size())) =
        weight.transpose();
    row.specular_patch.push_back(to);
  }
  return row;
}

}  // namespace

std::vector<RayCastRow> cast_rows(const ElementCaster& caster, const LightPaths& paths,
                                  const std::vector<int>& rays_of, const Progress& progress) {
  const PatchMesh& mesh = caster.mesh();
  const int patches = mesh.patch_count();
  const int most_rays = *std::max_element(rays_of.begin(), rays_of.end());
  const HemisphereSets sets(std::max(most_rays, 1));
  std::vector<RayCastRow> rows(patches);
  // Slices keep progress and interruption on this thread: each a fraction of a second of rays.
  constexpr int rays_per_slice = 1 << 20;
  const int slice =
      std::clamp(rays_per_slice / std::max(most_rays, 1), 2, std::max(64, patches / 100));
  const int grain = std::clamp(slice / 16, 1, 16);
  for (int begin = 0; begin < patches; begin += slice) {
    report(progress, "form factors", static_cast<double>(begin) / patches);
    parallel_for(std::min(slice, patches - begin), grain, [&](int low, int high) {
      Counter counter(patches);
      for (int i = begin + low; i < begin + high; ++i) {
        if (paths.is_diffuse(mesh.facet[i])) {
          rows[i] = cast_row(caster, paths, sets, i, rays_of[i], counter);
        }
      }
    });
  }
  report(progress, "form factors", 1.0);
  return rows;
}

}  // namespace lightwell
