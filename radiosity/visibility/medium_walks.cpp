#include "radiosity/visibility/medium_walks.h"

#include <algorithm>
#include <map>

#include "mesh/patches/patch_sampler.h"
#include "scene/random_purpose.h"
#include "scene/rays/surface_ray.h"

namespace lightwell {
namespace {

// An odd number of walks leaves no ties between two media. Four of nine may pass between polygons.
constexpr int walks = 9;
// Bounds of a walk in a closed room without a body, and between parallel panes.
constexpr int most_turns = 8, most_surfaces = 64;

std::uint64_t walk_key(std::uint64_t place, int walk) {
  return random_key(place, RandomPurpose::medium_walks, static_cast<std::uint64_t>(walk));
}

Ray away_from(const PatchMesh& mesh, const PatchPoint& at, std::uint64_t key) {
  const std::uint64_t turn = random_key(key, 1);
  return cosine_ray(mesh, at, static_cast<float>(random_uniform(random_key(turn, 1))),
                    static_cast<float>(random_uniform(random_key(turn, 2))));
}

// The medium that walk(i) returns for most i, of those that met a body; air if none did.
template <class Walk>
Medium most_common(Walk walk) {
  std::map<Medium, int> votes;
  for (int i = 0; i < walks; ++i) {
    if (const std::optional<Medium> medium = walk(i)) ++votes[*medium];
  }
  if (votes.empty()) return {};
  return std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; })->first;
}

}  // namespace

MediumWalks::MediumWalks(const Scene& scene) {
  for (const FacetRef& ref : scene_facets(scene)) {
    const Material& material = scene.materials[scene.surfaces[ref.surface].material];
    const bool is_body = material.dielectric && !material.dielectric->thin;
    index_.push_back(is_body ? material.dielectric->index_of_refraction : 0.0f);
    material_.push_back(scene.surfaces[ref.surface].material);
    passes_.push_back(material.dielectric.has_value());
    bends_ = bends_ || (is_body && index_.back() != 1.0f);
    absorbs_ = absorbs_ || (is_body && (material.dielectric->absorption > 0.0f).any());
  }
}

int MediumWalks::body_of(int facet) const {
  const auto f = static_cast<std::size_t>(facet);
  return index_[f] > 0.0f ? material_[f] : -1;
}

Medium MediumWalks::before(const ElementCaster& caster, int patch) const {
  const PatchMesh& mesh = caster.mesh();
  const PatchSampler sampler(mesh, patch);
  return most_common([&](int i) {
    const std::uint64_t key = walk_key(static_cast<std::uint64_t>(patch), i);
    const PatchPoint from = sampler.point(random_uniform(key), random_uniform(random_key(key, 1)));
    return walk(caster, away_from(mesh, from, key), key);
  });
}

Medium MediumWalks::around(const ElementCaster& caster, const SurfacePoint& at) const {
  return most_common([&](int i) {
    const std::uint64_t key = walk_key(static_cast<std::uint64_t>(at.facet), i);
    return walk(caster, cosine_ray(at, key), key);
  });
}

// The medium around the origin of a ray, by one walk; nothing if the walk met no body.
std::optional<Medium> MediumWalks::walk(const ElementCaster& caster, Ray ray,
                                        std::uint64_t key) const {
  const PatchMesh& mesh = caster.mesh();
  int entered = 0;
  std::optional<Medium> medium;
  int turns = 0;
  for (int surface = 0; surface < most_surfaces; ++surface) {
    ElementHit hit;
    caster.closest_elements({&ray, 1}, {&hit, 1});
    if (hit.facet < 0) return medium;
    const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
    const auto facet = static_cast<std::size_t>(hit.facet);
    if (index_[facet] > 0.0f) {
      cross(facet, hit.from_back, entered, medium);
    } else if (passes_[facet] == 0) {
      if (medium || hit.element < 0 || ++turns > most_turns) return medium;
      PatchPoint at = element_center(mesh, hit.element);
      at.position = point;
      ray = away_from(mesh, at, random_key(key, static_cast<std::uint64_t>(turns) + 2));
      continue;
    }
    ray = {.origin = point, .direction = ray.direction, .origin_group = hit.facet};
  }
  return medium;
}

// Counts a crossing. `entered` is the number of bodies that the walk has entered and not left.
void MediumWalks::cross(std::size_t facet, bool from_back, int& entered,
                        std::optional<Medium>& medium) const {
  if (!medium) medium.emplace();
  if (!from_back) {
    ++entered;
  } else if (entered > 0) {
    --entered;
  } else {
    if (medium->body < 0) medium->body = material_[facet];
    medium->index *= index_[facet];
  }
}

}  // namespace lightwell
