#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/gather/gap_exits.h"
#include "radiosity/gather/gap_sizes.h"
#include "radiosity/gather/read_radiosity.h"
#include "radiosity/openings/portals.h"
#include "radiosity/paths/light_path.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Aims of the rays of paths in a gap, beside cosine-distributed ones.
struct GapAims {
  const GapExits* exits = nullptr;   ///< of the point that the path begins at; null: not known
  const Portals* portals = nullptr;  ///< null: none are to be aimed at
};

/// Light that gathers find in gaps. Between two surfaces that face each other, such as a desk and
/// the foot of a monitor, light falls off within about the width of the gap. Elements that are much
/// larger than the gap cannot hold this light: their vertices stand in the open, and their
/// interpolated light would shine into the gap. Rays that end in a gap are followed one bounce
/// further instead, until they leave it:
///
///     B = rho (E_direct + B'),   B' at the end of one cosine-distributed ray
///
/// Light that a coat mirrors comes beside that, from the end of the mirrored ray in the gap or
/// outside.
class GapLight {
 public:
  /// `radiosity` is that of gather_irradiance(); `widest` is the greatest width of a gap as a share
  /// of gap_sizes(). Keeps references to the scene and the paths.
  GapLight(const LitScene& lit, ReadRadiosity radiosity, const LightPaths& paths,
           double widest = widest_gap)
      : lit_(lit),
        radiosity_(radiosity),
        paths_(paths),
        sizes_(gap_sizes(lit.mesh())),
        absorptances_(facet_absorptances(lit.mesh())),
        widest_(widest) {}

  /// True if a ray from a point of unit normal `normal` ends in a gap: on a surface that faces the
  /// point, reflects and does not emit, and whose distance from the point along its own normal is
  /// less than `widest` of the size at the element that was hit (see gap_sizes), less between two
  /// white surfaces (see widest_between), and more than 1e-4 of that size.
  bool is_gap(const Eigen::Vector3d& normal, const Ray& ray, const ElementHit& hit) const;

  /// True if a ray ends in a gap that it entered from outside, such as the passage between a door
  /// and its frame: as is_gap(), but for the surface that faces the one that was hit.
  bool is_narrow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit) const;

  /// The directions out of the gap that a point lies in; empty if it lies in none. `count` is the
  /// number of the gather's rays, of which fewer than GapExits::fewest_rays are not worth the
  /// search. `key` decides the rays of the search, which differ from those of the gather.
  std::optional<GapExits> exits(const ElementCaster& caster, const SurfacePoint& at, int count,
                                std::uint64_t key) const;

  /// exits() without pilot rays: directions that are even over the scales of the gap.
  std::optional<GapExits> even_exits(const ElementCaster& caster, const SurfacePoint& at,
                                     std::uint64_t key) const;

  /// True if a ray from a point of unit normal `normal` ends in a gap. In the gap of `exits` (null:
  /// not known) that is also where the gap is closed, such as on the floor between a cupboard and
  /// the wall.
  bool stays_in(const ElementCaster& caster, const GapExits* exits, const Eigen::Vector3d& normal,
                const Ray& ray, const ElementHit& hit) const {
    return is_gap(normal, ray, hit) ||
           (exits && is_closed_end(caster, exits->across(), exits->width(), ray, hit));
  }

  /// A place that a path in a gap comes to: a surface in the gap, or the end of its last ray.
  struct Stop {
    SurfacePoint at{};  // on a surface in the gap
    Ray ray{};          // that ended here
    ElementHit hit{};   // its end
    Spectrum share{};   // of the radiosity here in that where the path began
    std::uint64_t key = 0;
    int bounce = 0;  // surfaces of the path before this one
  };
  /// Callbacks of follow().
  struct Visitor {
    /// Called on surfaces, with the share that the irradiance there has. (After some bounces one
    /// surface of several stands for all.)
    std::function<void(const Stop&)> at_surface;
    /// Called where a ray has met a coat: the light that the coat mirrors has the share, and the
    /// path does not follow it. `at` is not set.
    std::function<void(const Stop&)> at_coat;
    /// Called at the end of the last ray, unless the path ends before or meets nothing.
    std::function<void(const Stop&)> at_end;
  };
  /// Follows a path from the end of a ray in a gap until a ray leaves the gap. `key` decides the
  /// path. Some of the rays are aimed as `aims` says, weighed by the balance heuristic.
  void follow(const ElementCaster& caster, const Ray& ray, const ElementHit& hit, std::uint64_t key,
              const GapAims& aims, const Visitor& visitor) const;

  /// Adds the radiosity B at the end of a ray in a gap to the columns of `sum`. `key` decides the
  /// further rays. `caster` is that of the scene or its ElementCaster::at().
  void add(const ElementCaster& caster, const Ray& ray, const ElementHit& hit, std::uint64_t key,
           Eigen::ArrayXd& sum, const GapAims& aims) const;

  /// True if a ray ends on a surface that reflects, so near a portal that its element does not show
  /// how light varies there (see Portals::is_near).
  bool is_near_portal(const Portals& portals, const Ray& ray, const ElementHit& hit) const;

  /// Adds the radiosity B = rho (E_direct + B') where a ray ends near a portal: E_direct is
  /// computed there, and one further ray, cosine-distributed or aimed at a portal, finds B'.
  void add_near_portal(const ElementCaster& caster, const Portals& portals, const Ray& ray,
                       const ElementHit& hit, std::uint64_t key, Eigen::ArrayXd& sum) const;

 private:
  struct GapSize {
    double width = 0.0, reach = 0.0;  // metres
  };
  std::optional<GapSize> gap_around(const ElementCaster& caster, const SurfacePoint& at,
                                    std::uint64_t key) const;
  void add_direct(const ElementCaster& caster, const Stop& stop, Eigen::ArrayXd& sum) const;
  void dim(const Ray& ray, const ElementHit& hit, Spectrum& share) const;
  double next_ray(const ElementCaster& caster, const GapAims& aims, const Portals::View& view,
                  double share, Stop& stop) const;
  void add_end(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
               std::uint64_t key, const Spectrum& share, Eigen::ArrayXd& sum) const;
  void add_base(const ElementCaster& caster, const Ray& ray, const ElementHit& hit,
                const Stop& from, Eigen::ArrayXd& sum) const;
  void add_mirrored(const ElementCaster& caster, const Stop& stop, Eigen::ArrayXd& sum) const;
  bool is_closed_end(const ElementCaster& caster, const Eigen::Vector3d& across, double width,
                     const Ray& ray, const ElementHit& hit) const;
  bool may_be_followed(const ElementHit& hit) const;
  double widest(const Ray& ray, const ElementHit& hit) const;
  Eigen::Vector3d normal_towards(const Ray& ray, const ElementHit& hit) const;

  LitScene lit_;
  ReadRadiosity radiosity_;
  const LightPaths& paths_;
  std::vector<float> sizes_, absorptances_;  // gap_sizes(), facet_absorptances()
  double widest_;                            // share of the sizes
};

}  // namespace lightwell
