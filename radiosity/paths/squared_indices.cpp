#include "radiosity/paths/squared_indices.h"

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

class MediumWalks {
 public:
  MediumWalks(const Scene& scene, const ElementCaster& caster) : caster_(caster) {
    for (const FacetRef& ref : scene_facets(scene)) {
      const Material& material = scene.materials[scene.surfaces[ref.surface].material];
      const bool is_body = material.dielectric && !material.dielectric->thin;
      index_.push_back(is_body ? material.dielectric->index_of_refraction : 0.0f);
      passes_.push_back(material.dielectric.has_value());
      bends_ = bends_ || (is_body && index_.back() != 1.0f);
    }
  }
  /// True if a body has an index other than 1.
  bool bends() const { return bends_; }

  double squared_index(int patch) const {
    std::map<float, int> votes;
    const PatchSampler sampler(caster_.mesh(), patch);
    for (int walk = 0; walk < walks; ++walk) {
      const std::uint64_t key =
          random_key(static_cast<std::uint64_t>(patch), RandomPurpose::medium_walks,
                     static_cast<std::uint64_t>(walk));
      const PatchPoint from =
          sampler.point(random_uniform(key), random_uniform(random_key(key, 1)));
      if (const auto index = index_around(from, key)) ++votes[*index];
    }
    if (votes.empty()) return 1.0;
    const auto most = std::ranges::max_element(
        votes, [](const auto& a, const auto& b) { return a.second < b.second; });
    return double{most->first} * double{most->first};
  }

 private:
  static constexpr int walks = 9, most_turns = 8, most_surfaces = 64;

  // The index around a point, by one walk; none if the walk met no body.
  std::optional<float> index_around(PatchPoint at, std::uint64_t key) const {
    const PatchMesh& mesh = caster_.mesh();
    Ray ray = away_from(at, key);
    std::vector<float> entered;
    std::optional<float> index;
    int turns = 0;
    for (int surface = 0; surface < most_surfaces; ++surface) {
      ElementHit hit;
      caster_.closest_elements({&ray, 1}, {&hit, 1});
      if (hit.facet < 0) return index;
      const Eigen::Vector3d point = ray.origin + hit.t * ray.direction;
      const auto facet = static_cast<std::size_t>(hit.facet);
      if (index_[facet] > 0.0f) {
        cross(index_[facet], hit.from_back, entered, index);
      } else if (passes_[facet] == 0) {
        if (index || hit.element < 0 || ++turns > most_turns) return index;
        at = element_center(mesh, hit.element);
        at.position = point;
        ray = away_from(at, random_key(key, static_cast<std::uint64_t>(turns) + 2));
        continue;
      }
      ray = {.origin = point, .direction = ray.direction, .origin_group = hit.facet};
    }
    return index;
  }

  static void cross(float body, bool from_back, std::vector<float>& entered,
                    std::optional<float>& index) {
    if (!index) index = 1.0f;
    if (!from_back) {
      entered.push_back(body);
    } else if (entered.empty()) {
      *index *= body;
    } else {
      entered.pop_back();
    }
  }

  Ray away_from(const PatchPoint& at, std::uint64_t key) const {
    const std::uint64_t turn = random_key(key, 1);
    return cosine_ray(caster_.mesh(), at, static_cast<float>(random_uniform(random_key(turn, 1))),
                      static_cast<float>(random_uniform(random_key(turn, 2))));
  }

  const ElementCaster& caster_;
  std::vector<float> index_;  // per facet: of the body that it bounds; 0: it bounds none
  std::vector<char> passes_;  // per facet: 1 for panes and bodies
  bool bends_ = false;
};

}  // namespace

Eigen::ArrayXd squared_indices(const Scene& scene, const ElementCaster& caster) {
  const MediumWalks walks(scene, caster);
  if (!walks.bends()) return {};
  const int patches = caster.mesh().patch_count();
  Eigen::ArrayXd result(patches);
  constexpr int grain = 64;
  parallel_for(patches, grain, [&](int begin, int end) {
    for (int p = begin; p < end; ++p) result[p] = walks.squared_index(p);
  });
  return (result != 1.0).any() ? result : Eigen::ArrayXd();
}

}  // namespace lightwell
