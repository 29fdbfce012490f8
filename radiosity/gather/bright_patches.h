#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_mesh.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/gather/bright_cavities.h"
#include "scene/round_shape.h"

namespace lightwell {

/// Patches that reflect far more light per area than most, such as the place that a spotlight falls
/// on or the inside of a lamp's shade. Rays over a hemisphere find small bright patches by chance,
/// which leaves blotches. So a gather draws some directions towards them as well, and weighs both
/// kinds of rays by the balance heuristic (Veach & Guibas 1995), which has no bias.
///
/// Directions go to points of the patches. Most of these are hidden if the patch lies in a
/// BrightCavity, so points before a mouth of the cavity mostly draw directions through the mouth
/// instead, which count for whatever bright patch they meet.
class BrightPatches {
 public:
  /// Brightness from which on a patch is bright, over the median and the mean of the lit area.
  /// Dimmer patches add less noise to cosine-distributed rays than the many patches of ordinary
  /// brightness.
  static constexpr double times_median = 32.0, times_mean = 2.0;
  static constexpr int most = 256;  ///< most bright patches: those that would leave the most noise

  /// No bright patches.
  BrightPatches() = default;
  /// `radiosity` is the light that rays read, vertices x columns, W/m^2. Moving surfaces are left
  /// out. Patches
  /// whose rays mostly meet other bright patches, as within a lampshade, are drawn less often:
  /// points of the room hardly see them. Keeps a reference to the caster's mesh.
  BrightPatches(const Scene& scene, const ElementCaster& caster, const BandArray& radiosity);

  bool is_empty() const { return patches_.empty(); }

  struct Aim {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    int element = -1;                                      ///< see counts()
    /// Distance of the point that is aimed at, m; 0: the element is flat, or -1.
    double distance = 0.0;
  };
  /// Returns whether a ray along `aim` counts that meets `hit` first: at the point that is aimed at
  /// or, where the aim has no element, on any bright patch. A ray to the far side of a ball may
  /// meet the same element on the near side.
  bool counts(const Aim& aim, const ElementHit& hit) const;

  /// The probability of each bright patch in draws from one point.
  class View {
   public:
    bool is_empty() const { return up_to_.empty(); }

   private:
    friend class BrightPatches;
    Eigen::Vector3d from_ = Eigen::Vector3d::Zero();
    // Running sum of the probabilities of patches, then of mouths; ends at 1. Empty: none is seen.
    std::vector<float> up_to_{};
    std::vector<int> mouths_{};  // those that the point lies before
    double chance(std::size_t place) const {
      return up_to_[place] - (place > 0 ? up_to_[place - 1] : 0.0f);
    }
  };
  /// The view from a point with unit normal `normal`, beside `rays` cosine-distributed rays. The
  /// probability of a patch is proportional to its approximate unoccluded irradiance, and falls
  /// with the number of those rays that meet the patch.
  View view(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, int rays) const;

  /// A direction by three random numbers in [0,1): `which` picks patch and element, or a mouth; u
  /// and v a point. The view must not be empty.
  Aim draw(const View& view, double which, double u, double v) const;
  /// Probability density q of draw()'s directions, 1/sr, for a unit direction that hits `element`
  /// at `distance` metres and counts; 0 if the element is not part of a bright patch.
  double density(const View& view, int element, const Eigen::Vector3d& direction,
                 double distance) const;

  /// Number of aimed rays beside `rays` cosine-distributed ones.
  static int aimed(int rays) { return std::max(1, rays / 4); }
  /// Balance-heuristic weight of a ray of either kind: N p / (N p + aimed(N) q) with N = `rays`,
  /// the densities p = `cosine` / pi and q = density(). Irradiance is then E = (1/N) sum weight B
  /// over the N cosine-distributed and the aimed(N) other rays. `others` is added to the
  /// denominator: the number times the density, 1/sr, of rays aimed at other things. The direction
  /// of `ray` is a unit vector.
  double share(const View& view, double cosine, int rays, const Ray& ray, const ElementHit& hit,
               double others = 0.0) const;

 private:
  struct Patch {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // zero: the patch is not flat
    double radius2 = 0.0;                              // m^2, of a sphere around the corners
    double area = 0.0;                                 // m^2
    double power = 0.0;                                // W, all columns
    double openness = 1.0;                             // see BrightPatch
    int cavity = -1;                                   // of cavities_; -1: in none
    int first = 0, end = 0;                            // indices in elements_
  };
  struct Element {
    int number = -1;
    double up_to = 0.0;           // running sum of shares of the patch's power
    double share_per_area = 0.0;  // 1/m^2
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // of a polygon
    int round = -1;                                     // in round_; -1: a polygon
  };
  // The exact shape of an element, which rays hit in place of the element.
  struct RoundElement {
    RoundShape shape;
    PatchSampler points;
  };

  // `of_element`: brightness of every element of the mesh.
  void add_patch(const BrightPatch& bright, const std::vector<double>& of_element);
  Eigen::Vector3d normal_at(const Element& element, const Eigen::Vector3d& point) const;
  Eigen::Vector3d point_on(const Element& element, double u, double v) const;
  bool is_bright(int element) const { return of_element_[static_cast<std::size_t>(element)] >= 0; }
  double add_mouths(const Eigen::Vector3d& normal, int rays, double sum, View& view) const;

  const PatchMesh* mesh_ = nullptr;
  std::vector<Patch> patches_{};
  std::vector<Element> elements_{};
  std::vector<int> of_element_{};  // index in elements_ of each element of the mesh; -1: none
  std::vector<int> patch_of_{};    // index in patches_ of each of elements_
  std::vector<RoundElement> round_{};
  BrightCavities cavities_{};
};

}  // namespace lightwell
