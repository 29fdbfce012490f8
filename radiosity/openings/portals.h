#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <span>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/geometry/box_tree.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/openings/find_openings.h"

namespace lightwell {

/// Openings between bright and dim parts of a scene, such as the slit beside a door. Rays over a
/// hemisphere find a narrow opening by chance: of 10 000 rays one passes a slit of 1 mm beside a
/// door, and carries all the light that the room behind has. So some rays are aimed at points of
/// the openings, and the balance heuristic (Veach & Guibas 1995) weighs both kinds, which has no
/// bias.
class Portals {
 public:
  /// Brightness seen through an opening over that seen the other way, from which on the opening is
  /// a portal. Through openings between parts that are lit more alike, rays over the hemisphere
  /// find more light on their own side.
  static constexpr double least_contrast = 16.0;
  static constexpr int most = 1024;  ///< most portals: those that pass the most light

  /// `brightness` is the radiosity of each element, W/m^2, in any sum of bands. What an opening
  /// shows is sampled by paths from its points, which go on as diffuse reflection would until they
  /// are out of the passage behind the opening.
  Portals(const ElementCaster& caster, const std::vector<float>& brightness,
          const std::vector<Opening>& openings);

  bool is_empty() const { return portals_.empty(); }
  int size() const { return static_cast<int>(portals_.size()); }

  /// The probability of each portal in draws from one place.
  class View {
   public:
    bool is_empty() const { return entries_.empty(); }

   private:
    friend class Portals;
    struct Entry {
      int portal;
      double up_to;  // running sum of probabilities, ends at 1
    };
    std::vector<Entry> entries_{};
  };
  /// The view of a receiver with unit normal `normal` on the dim sides of portals, beside `rays`
  /// cosine-distributed rays. The probability of a portal is proportional to its approximate
  /// irradiance, and falls with the number of those rays that pass it.
  View view(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, int rays) const;
  /// view() of the portals within about `reach`, metres, alone: for a single ray from a place where
  /// light varies fast because of them. The cost grows with these portals, not with all.
  View view_near(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, double reach) const;
  /// The view of the sender of a row of form factors, from either side of portals: the probability
  /// of a portal is proportional to its approximate form factor.
  View view_both_ways(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, int rays) const;

  /// A direction to a point of a portal.
  struct Aim {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    int portal = -1;
  };
  /// Draws a direction, from a point near that of the view. `which`, u and v are random numbers in
  /// [0,1). The view must not be empty.
  Aim draw(const View& view, const Eigen::Vector3d& from, double which, double u, double v) const;
  /// True if an aimed ray that ends `distance` metres away passes its portal before. Others do not
  /// count, even if they pass further portals on their way: density() is that of rays that do.
  bool passes(const Aim& aim, const Eigen::Vector3d& from, double distance) const;
  /// Probability density, 1/sr, of draw()'s directions, for a ray that ends `distance` metres away:
  /// of the portals that it passes before. 0 if it passes none.
  double density(const View& view, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                 double distance) const;

  /// True if the two points, such as centres of patches, lie in the two parts that a portal joins.
  bool part(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;

  /// Distance from a portal, in sizes of an element, below which light varies too fast for it.
  static constexpr double near_sizes = 2.0;
  /// True if a point on the dim side of a narrow portal is nearer to the portal than near_sizes
  /// times `size`, metres, and not in the portal's plane.
  bool is_near(const Eigen::Vector3d& at, double size) const;

  /// Number of aimed rays beside `rays` cosine-distributed ones.
  static int aimed(int rays) { return std::max(1, rays / 4); }

 private:
  struct Portal {
    Opening shape{};
    // 1/m: half-axes over their squared lengths, by which a point has coordinates in [-1, 1].
    Eigen::Vector3d along = Eigen::Vector3d::Zero(), across = Eigen::Vector3d::Zero();
    double area = 0.0;                            // m^2
    std::array<double, 2> brightness{};           // W/m^2, seen before the front and behind
    std::array<char, 2> is_dim{};                 // the side is the dim one
    bool is_narrow = false;                       // by narrow_for_rows
    std::array<Eigen::AlignedBox3d, 2> region{};  // what the portal sees on each side
  };
  static double distance_to(const Portal& portal, const Eigen::Vector3d& from,
                            const Eigen::Vector3d& direction);
  template <class Numbers, class Weight>
  View view_of(const Numbers& portals, const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
               int rays, Weight weight) const;
  double light_towards(int portal, int side) const;

  std::vector<Portal> portals_{};
  BoxTree boxes_{std::vector<BoxTree::Box>{}};  // of the rectangles
};

/// Width of openings over the mean distance to what is seen through either side, below which rays
/// are aimed at them.
/// - Rows of form factors are means over patches, and rays over the hemisphere meet wider openings
///   often enough.
/// - A gather has light of one point. From the far wall of a dim room a door ajar by 30 cm is half
///   a hundredth of the hemisphere and may send a quarter of the light: one ray of 256 meets it, on
///   average, and the light of such gathers has 15 % noise.
inline constexpr double narrow_for_rows = 0.1, narrow_for_gathers = 0.5;

/// The openings that are less wide than `share` of the mean distance to what is seen through either
/// side. The processes of `run` share the openings; no journal keeps the result.
std::vector<Opening> narrow_openings(const ElementCaster& caster, std::vector<Opening> openings,
                                     double share, const RunControl& run = {});

/// The openings but for those that let in less light than could matter on their dim side, where the
/// irradiance that comes through, B A / A_seen, is less than a thousandth of what errors are
/// relative to. A model whose seams leak has hundreds, such as into the insides of furniture, and
/// to aim rays at their light takes most of the time of gathers. `brightness` is as in Portals,
/// `reference` the irradiance that errors on each element are relative to, W/m^2, in the same sum
/// of bands; infinite: none matter.
std::vector<Opening> notable_openings(const ElementCaster& caster,
                                      const std::vector<float>& brightness,
                                      const std::vector<float>& reference,
                                      std::vector<Opening> openings);

/// The ones of `openings` that are narrow for gathers and are portals; null if there are none.
/// `brightness` as in Portals.
std::shared_ptr<const Portals> find_portals(const ElementCaster& caster,
                                            const std::vector<float>& brightness,
                                            const std::vector<Opening>& openings,
                                            const RunControl& run = {});

/// The portals of a scene, among its find_openings().
std::shared_ptr<const Portals> find_portals(const Scene& scene, const ElementCaster& caster,
                                            const std::vector<float>& brightness);

/// Brightness of elements, the sum of bands: mean of the radiosity at their vertices (vertices x
/// bands), or the radiosity of their patches (patches x bands) without the emission that
/// `direct_light` accounts for.
std::vector<float> brightness_of_vertices(const PatchMesh& mesh, const BandArray& radiosity);
std::vector<float> brightness_of_patches(const PatchMesh& mesh, const DirectLight& direct_light,
                                         const BandArray& radiosity);

}  // namespace lightwell
