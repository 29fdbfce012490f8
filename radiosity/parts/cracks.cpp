#include "radiosity/parts/cracks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "radiosity/emitters/free_source.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Adds what arrives in each part of the light of a lamp, as a share, to `shares`.
void add_lamp(const FreeSource& lamp, const ElementCaster& caster, const LightPaths& paths,
              const SceneParts& parts, std::vector<double>& shares) {
  constexpr int rays = 64;
  const PatchMesh& mesh = caster.mesh();
  const std::uint64_t key = random_key(static_cast<std::uint64_t>(mesh.patch_count() + lamp.number),
                                       RandomPurpose::part_rays);
  const SobolPoints sobol(rays);
  const auto arrive = [&](const ElementHit& at, double share) {
    const int part = at.element < 0 ? -1 : parts.of_patch[mesh.patch[at.element]];
    if (part >= 0) shares[part] += share / rays;
  };
  for (int r = 0; r < rays; ++r) {
    const SourceRay sent = source_ray(lamp, sobol.point(r, key));
    std::array<ElementHit, 1> hit;
    caster.closest_elements({&sent.ray, 1}, hit);
    if (hit[0].facet < 0) continue;
    if (paths.is_diffuse(hit[0].facet)) arrive(hit[0], 1.0);
    if (!paths.is_specular(hit[0].facet)) continue;
    const std::uint64_t branch =
        random_key(key, RandomPurpose::part_rays, static_cast<std::uint64_t>(r));
    paths.follow(sent.ray, hit[0], branch, [&](const ElementHit& at, const Spectrum& throughput) {
      arrive(at, double{throughput.mean()});
    });
  }
}

// 1 for each part with light of its own: surfaces that shine, lamps, and sky or sun for parts that
// are not enclosed.
std::vector<char> parts_with_light(const Scene& scene, const ElementCaster& caster,
                                   const LightPaths& paths, const std::vector<ClusterSums>& sums,
                                   const SceneParts& parts) {
  // A lamp in one room sends a few of its rays through a crack into another.
  constexpr double most_by_cracks = 1.0 / 8.0;
  const PatchMesh& mesh = caster.mesh();
  std::vector<char> has_light(sums.size(), 0);
  for (int p = 0; p < mesh.patch_count(); ++p) {
    if (parts.of_patch[p] >= 0 && (mesh.emission.row(p) > 0.0f).any()) {
      has_light[parts.of_patch[p]] = 1;
    }
  }
  for (const FreeSource& source : free_sources(scene, mesh.source_scale, {})) {
    std::vector<double> shares(sums.size(), 0.0);
    if (!source.is_distant()) add_lamp(source, caster, paths, parts, shares);
    const double arrived = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (std::size_t part = 0; part < sums.size(); ++part) {
      const bool is_lit =
          source.is_distant() ? !sums[part].is_enclosed() : shares[part] > most_by_cracks * arrived;
      if (is_lit) has_light[part] = 1;
    }
  }
  return has_light;
}

// The exchange of each part with those that are no cavities, m^2: the mean of what its rays and
// those of the others find. Rays that leave the scene count for a part that light of the sky could
// enter there.
std::vector<double> passages(const PatchMesh& mesh, const std::vector<PartRayEnds>& arrivals,
                             bool is_sky_lit, const SceneParts& parts,
                             const std::vector<char>& is_cavity) {
  std::vector<double> passed(parts.parts.size(), 0.0);
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const int from = parts.of_patch[i];
    if (from < 0) continue;
    if (is_sky_lit) passed[from] += mesh.area[i] * arrivals[i].escaped;
    for (const RayArrivals& at : arrivals[i].at) {
      const int to = parts.of_patch[at.patch];
      if (to < 0 || to == from) continue;
      const double exchange = 0.5 * mesh.area[i] * double{at.share};
      if (is_cavity[to] == 0) passed[from] += exchange;
      if (is_cavity[from] == 0) passed[to] += exchange;
    }
  }
  return passed;
}

}  // namespace

void mark_lit_by_cracks(const Scene& scene, const ElementCaster& caster, const LightPaths& paths,
                        const std::vector<PartRayEnds>& arrivals, SceneParts& parts) {
  if (parts.count() < 2) return;
  // Through a crack of a 200th of its area, a part of reflectance 0.5 gets a hundredth of the light
  // of the room beside it. The mean length of rays is 2.6 m in a living room, 1.3 m in a bathroom,
  // 0.6 m in a wardrobe, and 0.2 m between the two shells of a wall.
  constexpr double crack = 1.0 / 200.0, shallow = 1.0 / 3.0;
  const PatchMesh& mesh = caster.mesh();
  const std::vector<ClusterSums> sums = sums_of_clusters(mesh, arrivals, parts.of_patch);
  const auto room = std::ranges::find_if(sums, &ClusterSums::is_enclosed);
  std::vector<char> is_cavity;
  for (const ClusterSums& of : sums) {
    const bool is_room = of.is_enclosed() && of.mean_length() >= shallow * room->mean_length();
    is_cavity.push_back(is_room ? 0 : 1);
  }
  if (std::ranges::count(is_cavity, 1) == 0) return;
  const std::vector<char> has_light = parts_with_light(scene, caster, paths, sums, parts);
  for (std::size_t p = 0; p < sums.size(); ++p) {
    if (has_light[p] != 0) is_cavity[p] = 0;
  }
  const std::vector<double> passed =
      passages(mesh, arrivals, scene.sky.has_value(), parts, is_cavity);
  const double all = std::accumulate(sums.begin(), sums.end(), 0.0,
                                     [](double sum, const auto& of) { return sum + of.area; });
  for (std::size_t p = 0; p < sums.size(); ++p) {
    const double smaller = std::min(sums[p].area, all - sums[p].area);
    parts.parts[p].is_lit_by_cracks = is_cavity[p] != 0 && passed[p] < crack * smaller;
  }
}

}  // namespace lightwell
