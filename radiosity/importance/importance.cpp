#include "radiosity/importance/importance.h"

#include <algorithm>
#include <optional>

#include "mesh/patches/patch_sampler.h"
#include "mesh/patches/translucency.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// The patches at which one view ray and the random walk after it arrive, in order.
using Walk = std::vector<int>;

class ImportanceWalks {
 public:
  ImportanceWalks(const ElementCaster& caster, const LightPaths& paths)
      : caster_(caster), paths_(paths) {}

  Walk walk(const Ray& view_ray, std::uint64_t number) const {
    // Light of 16 reflections at 0.7 is 0.3 % of that of the first.
    constexpr std::size_t most = 16;
    Walk visited;
    Ray ray = view_ray;
    while (visited.size() < most) {
      const std::uint64_t key = random_key(number, RandomPurpose::importance_walks, visited.size());
      const auto end = arrival(ray, key);
      if (!end) break;
      const PatchMesh& mesh = caster_.mesh();
      const int patch = mesh.patch[end->element];
      visited.push_back(patch);
      const auto random = [&](std::uint64_t i) { return random_uniform(random_key(key, i)); };
      const double reflected = double{mesh.reflectance.row(patch).mean()};
      if (random(1) >= double{scattered_share(mesh, patch).mean()}) break;
      PatchPoint from = *end;
      if (random(1) >= reflected) {
        from = behind(*end);
        visited.push_back(mesh.patch[from.element]);
      }
      ray = cosine_ray(mesh, from, static_cast<float>(random(2)), static_cast<float>(random(3)));
    }
    return visited;
  }

 private:
  // The diffuse place that a ray arrives at, also through mirrors and glass.
  std::optional<PatchPoint> arrival(const Ray& ray, std::uint64_t key) const {
    ElementHit hit;
    caster_.closest_elements({&ray, 1}, {&hit, 1});
    if (hit.facet < 0) return std::nullopt;
    if (hit.element >= 0 && paths_.is_diffuse(hit.facet)) {
      return place(hit.element, ray.origin + hit.t * ray.direction);
    }
    std::optional<PatchPoint> found;
    if (!paths_.is_specular(hit.facet)) return found;
    paths_.follow(ray, hit, random_key(key, 4), [&](const LightArrival& at) {
      if (!found && at.hit.element >= 0) found = place(at.hit.element, at.position);
    });
    return found;
  }

  // The same point on the other side of a sheet.
  PatchPoint behind(PatchPoint at) const {
    at.element = caster_.mesh().twin[at.element];
    at.normal = -at.normal;
    return at;
  }

  PatchPoint place(int element, const Eigen::Vector3d& position) const {
    PatchPoint at = element_center(caster_.mesh(), element);
    at.position = position;
    return at;
  }

  const ElementCaster& caster_;
  const LightPaths& paths_;
};

// Counts of each patch, and its radiosity: view rays that end there, walks that arrive there.
struct PatchArrivals {
  std::vector<double> view_rays{}, walks{};
  std::span<const float> brightness{};
};

// 1 for each part that somebody looks into, or that sends a notable share of the light seen there.
std::vector<char> parts_that_count(const SceneParts& parts, const PatchArrivals& of) {
  const auto count = static_cast<std::size_t>(parts.judged_count());
  if (count == 1) return {1};
  std::vector<double> seen(count, 0.0), light(count, 0.0);
  double all_seen = 0.0, all_light = 0.0;
  for (std::size_t p = 0; p < of.walks.size(); ++p) {
    const auto part = static_cast<std::size_t>(parts.judged_with(static_cast<int>(p)));
    seen[part] += of.view_rays[p];
    all_seen += of.view_rays[p];
    light[part] += of.walks[p] * double{of.brightness[p]};
  }
  // A hundredth of a picture is a door far away. A part that sends a twentieth of the light has to
  // be wrong by its half before what is seen is off by 2.5 %.
  constexpr double share_seen = 0.01, share_of_light = 0.05;
  std::vector<char> counts(count, 0);
  for (std::size_t p = 0; p < count; ++p) {
    counts[p] = seen[p] >= share_seen * all_seen ? 1 : 0;
    if (counts[p] != 0) all_light += light[p];
  }
  for (std::size_t p = 0; p < count; ++p) {
    if (light[p] > 0.0 && light[p] >= share_of_light * all_light) counts[p] = 1;
  }
  return counts;
}

}  // namespace

std::vector<float> find_importance(const ElementCaster& caster, const LightPaths& paths,
                                   const SceneParts& parts, std::span<const Ray> view_rays,
                                   std::span<const float> brightness) {
  const PatchMesh& mesh = caster.mesh();
  const ImportanceWalks walks(caster, paths);
  std::vector<Walk> walk(view_rays.size());
  parallel_for(static_cast<int>(view_rays.size()), 64, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const auto r = static_cast<std::size_t>(i);
      walk[r] = walks.walk(view_rays[r], r);
    }
  });
  const auto count = static_cast<std::size_t>(mesh.patch_count());
  PatchArrivals arrivals{.view_rays = std::vector<double>(count, 0.0),
                         .walks = std::vector<double>(count, 0.0),
                         .brightness = brightness};
  for (const Walk& visited : walk) {
    if (!visited.empty()) arrivals.view_rays[static_cast<std::size_t>(visited.front())] += 1.0;
    for (const int patch : visited) arrivals.walks[static_cast<std::size_t>(patch)] += 1.0;
  }
  double seen_walks = 0.0, seen_area = 0.0, seen_light = 0.0;
  for (std::size_t p = 0; p < count; ++p) {
    if (!(arrivals.view_rays[p] > 0.0)) continue;
    seen_walks += arrivals.walks[p];
    seen_area += mesh.area[p];
    seen_light += mesh.area[p] * double{brightness[p]};
  }
  std::vector<float> importance(count, 1.0f);
  if (!(seen_area > 0.0)) return importance;
  const std::vector<char> counts = parts_that_count(parts, arrivals);
  // A patch that sends a quarter of what seen patches send is as important as they are: few walks
  // end on a patch, and too little importance costs more than too much.
  constexpr double scale = 4.0;
  for (std::size_t p = 0; p < count; ++p) {
    const bool in_view = counts[static_cast<std::size_t>(parts.judged_with(static_cast<int>(p)))];
    const bool is_seen = arrivals.view_rays[p] > 0.0;
    if ((in_view && (is_seen || parts.judged_count() > 1)) || !(mesh.area[p] > 0.0)) continue;
    const double density = arrivals.walks[p] / mesh.area[p] * seen_area / seen_walks;
    const double light = seen_light > 0.0 ? double{brightness[p]} * seen_area / seen_light : 1.0;
    const float least = in_view ? least_in_view : least_importance;
    importance[p] = static_cast<float>(
        std::clamp(scale * density * light, double{least}, double{most_unseen_importance}));
  }
  return importance;
}

}  // namespace lightwell
