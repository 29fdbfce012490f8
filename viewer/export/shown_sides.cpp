#include "viewer/export/shown_sides.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/mesh_bounds.h"
#include "mesh/patches/patch_sampler.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"
#include "viewer/export/baked_channels.h"

namespace lightwell {
namespace {

constexpr int rays_per_patch = 64, patch_grain = 64;
/// Ends of rays that meet no element: nothing, or the black back of a one-sided surface.
constexpr int way_out = -1, black_back = -2;

/// Sight from a patch, and of a patch.
struct PatchView {
  float escaped = 0.0f;     // share of the rays that leave the scene
  bool sees_light = false;  // a side that is not dark, glass or the outside
  bool is_seen = false;     // by a camera that looks around at its place
};

class SideChooser {
 public:
  SideChooser(const SolvedScene& solved, const Scene& scene, const ElementCaster& caster,
              const std::vector<ElementKind>& kinds)
      : mesh_(solved.mesh),
        solution_(solved.solution),
        scene_(scene),
        kinds_(kinds),
        caster_(caster),
        met_(static_cast<std::size_t>(mesh_.patch_count())),
        view_(static_cast<std::size_t>(mesh_.patch_count())),
        lux_(
            element_lux(mesh_, luminous_rows(irradiance_with_all_on(solution_), solution_.bands))) {
    for_each_patch([this](int p) { cast(p); });
    limit_ = 1e-4 * mean_within();
    for_each_patch([this](int p) { look_from(p); });
  }

  std::vector<SideUse> choose(Sides sides) const {
    std::vector<SideUse> use(static_cast<std::size_t>(mesh_.element_count()), SideUse::in_place);
    for (int e = 0; e < mesh_.element_count(); ++e) {
      const int twin = mesh_.twin[e];
      if (twin < 0) continue;
      const bool is_out = is_left_out(e, sides), is_twin_out = is_left_out(twin, sides);
      use[e] = is_out ? SideUse::left_out : is_twin_out ? SideUse::in_place : SideUse::moved;
    }
    return use;
  }

 private:
  template <class F>
  void for_each_patch(const F& look) {
    parallel_for(mesh_.patch_count(), patch_grain, [&](int begin, int end) {
      for (int p = begin; p < end; ++p) {
        if (mesh_.twin[mesh_.first_element[p]] >= 0) look(p);
      }
    });
  }

  /// The largest illuminance at the corners of each element, lx.
  static std::vector<float> element_lux(const PatchMesh& mesh, const std::vector<float>& at) {
    std::vector<float> lux(static_cast<std::size_t>(mesh.element_count()), 0.0f);
    for (int e = 0; e < mesh.element_count(); ++e) {
      for (int c = 0; c < mesh.corner_count(e); ++c) {
        lux[e] = std::max(lux[e], finite_or_black(at[mesh.corners[e][c]]));
      }
    }
    return lux;
  }

  /// Keeps what the rays of a patch meet, and the share that leaves the scene.
  void cast(int patch) {
    static const SobolPoints sobol(rays_per_patch);
    const std::uint64_t key =
        random_key(static_cast<std::uint64_t>(patch), RandomPurpose::side_rays);
    const PatchSampler sampler(mesh_, patch);
    std::array<Ray, rays_per_patch> rays;
    for (int r = 0; r < rays_per_patch; ++r) {
      const Eigen::Array4f u = sobol.point(r, key);
      rays[static_cast<std::size_t>(r)] = cosine_ray(mesh_, sampler.point(u[0], u[1]), u[2], u[3]);
    }
    std::array<ElementHit, rays_per_patch> hits;
    caster_.closest_elements(rays, hits);
    std::vector<int>& met = met_[patch];
    for (const ElementHit& hit : hits) {
      met.push_back(hit.facet < 0 ? way_out : hit.element < 0 ? black_back : hit.element);
    }
    view_[patch].escaped = static_cast<float>(std::ranges::count(met, way_out)) / rays_per_patch;
  }

  void look_from(int patch) {
    view_[patch].sees_light = std::ranges::any_of(met_[patch], [this](int element) {
      return element == way_out || (element >= 0 && !is_dark(element));
    });
    constexpr int looks = 4;
    static const SobolPoints sobol(looks);
    const PatchSampler sampler(mesh_, patch);
    for (int i = 0; i < looks && !view_[patch].is_seen; ++i) {
      const Eigen::Array4f u = sobol.point(i, 0);
      const PatchPoint at = sampler.point(u[0], u[1]);
      view_[patch].is_seen = std::ranges::any_of(
          scene_.cameras, [&](const Camera& camera) { return sees(camera.position, at); });
    }
  }

  bool sees(const Eigen::Vector3d& eye, const PatchPoint& at) const {
    Ray ray{.origin = at.position,
            .direction = eye - at.position,
            .t_max = 1.0,
            .origin_group = mesh_.facet[at.element]};
    if (at.normal.dot(ray.direction) <= 0.0) return false;
    constexpr int most_panes = 8;
    for (int pane = 0; pane < most_panes; ++pane) {
      ElementHit hit;
      caster_.closest_elements({&ray, 1}, {&hit, 1});
      if (hit.facet < 0) return true;
      if (hit.element < 0 || kinds_[hit.element] != ElementKind::glass) return false;
      ray.origin += hit.t * ray.direction;
      ray.direction = eye - ray.origin;
      ray.origin_group = hit.facet;
    }
    return false;
  }

  /// Mean illuminance of the lit sides that are not outside, lx.
  double mean_within() const {
    double area = 0.0, sum = 0.0, whole_area = 0.0, whole_sum = 0.0;
    for (int e = 0; e < mesh_.element_count(); ++e) {
      if (kinds_[e] != ElementKind::lit) continue;
      const double light = mesh_.element_area[e] * double{lux_[e]};
      whole_area += mesh_.element_area[e];
      whole_sum += light;
      if (is_outside(e)) continue;
      area += mesh_.element_area[e];
      sum += light;
    }
    if (sum > 0.0) return sum / area;
    return whole_area > 0.0 ? whole_sum / whole_area : 0.0;
  }

  const PatchView& view(int element) const { return view_[mesh_.patch[element]]; }

  bool is_outside(int element) const {
    constexpr float least = 0.25f, of_twin = 0.5f;
    const int twin = mesh_.twin[element];
    if (twin < 0) return false;
    const float escaped = view(element).escaped;
    return escaped > least && view(twin).escaped < of_twin * escaped;
  }

  bool emits(int element) const {
    const RadiositySolution& s = solution_;
    const BandArray& emission = s.channels.empty() ? mesh_.emission : s.full_emission;
    return (emission.row(mesh_.patch[element]) > 0.0f).any();
  }

  bool is_dark(int element) const {
    if (kinds_[element] != ElementKind::lit) return kinds_[element] == ElementKind::unlit;
    return double{lux_[element]} < limit_ && !emits(element);
  }

  bool is_shut_in(int element) const {
    return is_dark(element) && !view(element).sees_light && !view(element).is_seen;
  }

  bool is_unlit(int element) const {
    return kinds_[element] == ElementKind::unlit || is_shut_in(element);
  }

  /// True if another surface lies on this side, as furniture on a floor.
  bool is_covered(int element) const {
    const bool is_back = mesh_.is_back[mesh_.patch[element]] != 0;
    return caster_.is_hidden(is_back ? mesh_.twin[element] : element, is_back);
  }

  /// True if a side outside is left out for its twin.
  bool yields(int element) const {
    const int twin = mesh_.twin[element];
    return is_outside(element) && !view(element).is_seen && (!is_dark(twin) || is_covered(twin));
  }

  bool is_left_out(int element, Sides sides) const {
    const int twin = mesh_.twin[element];
    if (is_shut_in(element) && is_shut_in(twin)) return true;
    if (sides == Sides::front && yields(element)) return true;
    if (sides == Sides::front && yields(twin)) return false;
    if (is_unlit(element)) return !is_unlit(twin) || mesh_.is_back[mesh_.patch[element]] != 0;
    return false;
  }

  const PatchMesh& mesh_;
  const RadiositySolution& solution_;
  const Scene& scene_;
  const std::vector<ElementKind>& kinds_;
  const ElementCaster& caster_;
  std::vector<std::vector<int>> met_;  // by the rays of each patch
  std::vector<PatchView> view_;
  std::vector<float> lux_;  // of each element, the largest at its corners
  double limit_ = 0.0;      // lx, below which a side is dark
};

/// An unlit side is left out if another lies on it, unless both are unlit and it is the front.
std::vector<SideUse> lit_sides(const PatchMesh& mesh, const std::vector<ElementKind>& kinds) {
  std::vector<SideUse> use;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int twin = mesh.twin[e];
    const bool is_out = twin >= 0 && kinds[e] == ElementKind::unlit &&
                        (kinds[twin] != ElementKind::unlit || mesh.is_back[mesh.patch[e]] != 0);
    use.push_back(is_out ? SideUse::left_out : SideUse::in_place);
  }
  return use;
}

}  // namespace

double half_gap(const PatchMesh& mesh) {
  return std::min(5e-4, 1e-4 * mesh_bounds(mesh).diagonal());
}

std::vector<SideUse> choose_sides(const SolvedScene& solved, const Scene& scene,
                                  const ElementCaster& caster,
                                  const std::vector<ElementKind>& kinds, Sides sides) {
  if (sides == Sides::lit) return lit_sides(solved.mesh, kinds);
  return SideChooser(solved, scene, caster, kinds).choose(sides);
}

}  // namespace lightwell
