#include "radiosity/paths/squared_indices.h"

#include <algorithm>
#include <compare>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The clear bodies around a patch.
struct Medium {
  float index = 1.0f;  // of refraction
  int body = -1;       // material of the innermost body; -1: none
  auto operator<=>(const Medium&) const = default;
};

class MediumWalks {
 public:
  MediumWalks(const Scene& scene, const ElementCaster& caster) : caster_(caster) {
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
  // True if a body has an index other than 1.
  bool bends() const { return bends_; }
  // True if a body absorbs.
  bool absorbs() const { return absorbs_; }

  // The medium that most walks from a patch find; air for patches of panes and bodies, which
  // neither take nor send diffuse light.
  Medium around(int patch) const {
    const PatchMesh& mesh = caster_.mesh();
    const int facet = mesh.facet[mesh.first_element[patch]];
    if (passes_[static_cast<std::size_t>(facet)] != 0) return {};
    std::map<Medium, int> votes;
    const PatchSampler sampler(mesh, patch);
    for (int walk = 0; walk < walks; ++walk) {
      const std::uint64_t key =
          random_key(static_cast<std::uint64_t>(patch), RandomPurpose::medium_walks,
                     static_cast<std::uint64_t>(walk));
      const PatchPoint from =
          sampler.point(random_uniform(key), random_uniform(random_key(key, 1)));
      if (const auto medium = around(from, key)) ++votes[*medium];
    }
    if (votes.empty()) return {};
    return std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; })->first;
  }

 private:
  // An odd number of walks leaves no ties between two media. Four of nine may pass between
  // polygons.
  static constexpr int walks = 9;
  // Bounds of a walk in a closed room without a body, and between parallel panes.
  static constexpr int most_turns = 8, most_surfaces = 64;

  // The medium around a point, by one walk; nothing if the walk met no body.
  std::optional<Medium> around(PatchPoint at, std::uint64_t key) const {
    const PatchMesh& mesh = caster_.mesh();
    Ray ray = away_from(at, key);
    int entered = 0;
    std::optional<Medium> medium;
    int turns = 0;
    for (int surface = 0; surface < most_surfaces; ++surface) {
      ElementHit hit;
      caster_.closest_elements({&ray, 1}, {&hit, 1});
      if (hit.facet < 0) return medium;
      const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
      const auto facet = static_cast<std::size_t>(hit.facet);
      if (index_[facet] > 0.0f) {
        cross(facet, hit.from_back, entered, medium);
      } else if (passes_[facet] == 0) {
        if (medium || hit.element < 0 || ++turns > most_turns) return medium;
        at = element_center(mesh, hit.element);
        at.position = point;
        ray = away_from(at, random_key(key, static_cast<std::uint64_t>(turns) + 2));
        continue;
      }
      ray = {.origin = point, .direction = ray.direction, .origin_group = hit.facet};
    }
    return medium;
  }

  // Counts a crossing. `entered` is the number of bodies that the walk has entered and not left.
  void cross(std::size_t facet, bool from_back, int& entered, std::optional<Medium>& medium) const {
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

  Ray away_from(const PatchPoint& at, std::uint64_t key) const {
    const std::uint64_t turn = random_key(key, 1);
    return cosine_ray(caster_.mesh(), at, static_cast<float>(random_uniform(random_key(turn, 1))),
                      static_cast<float>(random_uniform(random_key(turn, 2))));
  }

  const ElementCaster& caster_;
  std::vector<float> index_;   // per facet: of the body that it bounds; 0: it bounds none
  std::vector<char> passes_;   // per facet: 1 for panes and bodies
  std::vector<int> material_;  // per facet
  bool bends_ = false, absorbs_ = false;
};

// Calls visit(patch, medium) for all patches, by all threads.
template <class Visit>
void for_each_patch(const MediumWalks& walks, int patches, Visit visit) {
  constexpr int grain = 64;
  parallel_for(patches, grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) visit(p, walks.around(p));
  });
}

}  // namespace

Eigen::ArrayXd squared_indices(const Scene& scene, const ElementCaster& caster) {
  const MediumWalks walks(scene, caster);
  if (!walks.bends()) return {};
  const int patches = caster.mesh().patch_count();
  Eigen::ArrayXd result(patches);
  for_each_patch(walks, patches, [&](int p, const Medium& medium) {
    result[p] = double{medium.index} * double{medium.index};
  });
  return (result != 1.0).any() ? result : Eigen::ArrayXd();
}

std::vector<int> absorbing_bodies_around(const Scene& scene, const ElementCaster& caster) {
  const MediumWalks walks(scene, caster);
  if (!walks.absorbs()) return {};
  const int patches = caster.mesh().patch_count();
  std::vector<int> body(static_cast<std::size_t>(patches));
  for_each_patch(walks, patches, [&](int p, const Medium& medium) {
    body[static_cast<std::size_t>(p)] = medium.body;
  });
  std::set<int> found(body.begin(), body.end());
  std::erase_if(found, [&](int m) {
    return m < 0 ||
           !(scene.materials[static_cast<std::size_t>(m)].dielectric->absorption > 0.0f).any();
  });
  return {found.begin(), found.end()};
}

}  // namespace lightwell
