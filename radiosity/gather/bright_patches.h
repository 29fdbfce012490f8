#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "mesh/patches/patch_mesh.h"

namespace lightwell {

/// Patches that reflect far more light per area than most, such as the place that a spotlight
/// falls on or the inside of a lamp's shade. Rays over a hemisphere find what is small and bright
/// by chance, which leaves blotches; so a gather draws some directions towards such patches as well
/// and weighs both by the balance heuristic (Veach & Guibas 1995), which has no bias.
class BrightPatches {
 public:
  /// Of a patch's brightness, over the median and the mean of the area that is lit: with rays that
  /// are spread by the cosine, anything dimmer adds less noise than the many patches of ordinary
  /// brightness do.
  static constexpr double times_median = 32.0, times_mean = 2.0;
  static constexpr int most = 256;  ///< patches; those that would leave the most noise

  /// None.
  BrightPatches() = default;
  /// `radiosity` is vertices x columns, W/m^2: what rays read where they end. What moves is left
  /// out, and spheres, which are met where they are round and not where their elements are.
  BrightPatches(const Scene& scene, const PatchMesh& mesh, const BandArray& radiosity);

  bool is_empty() const { return patches_.empty(); }

  /// How likely each is to be drawn from one place.
  class View {
   public:
    bool is_empty() const { return up_to_.empty(); }

   private:
    friend class BrightPatches;
    Eigen::Vector3d from_ = Eigen::Vector3d::Zero();
    std::vector<float> up_to_{};  // running sum of chances, which ends at 1; empty: none is seen
  };
  /// From a place that faces along `normal`, unit, beside `rays` cosine-distributed rays: what
  /// those find anyway is drawn less often.
  View view(const Eigen::Vector3d& from, const Eigen::Vector3d& normal, int rays) const;

  struct Aim {
    Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< unit
    int element = -1;  ///< that it counts for: no other in its way
  };
  /// Three numbers in [0,1); the view is not empty.
  Aim draw(const View& view, double which, double u, double v) const;
  /// Of draw()'s directions, 1/sr, towards a place on an element that is met `distance` metres away
  /// in a unit direction; 0 if the element is of no bright patch.
  double density(const View& view, int element, const Eigen::Vector3d& direction,
                 double distance) const;

  /// How many rays to aim beside `rays` cosine-distributed ones.
  static int aimed(int rays) { return std::max(1, rays / 4); }
  /// Of B where a ray ends, what counts of it in E = (1/N) sum B over both N = `rays`
  /// cosine-distributed rays and aimed(N) others, for a ray of either kind: N p / (N p + aimed(N)
  /// q), with the densities p = `cosine` / pi and q of its direction, which is a unit vector.
  double share(const View& view, double cosine, int rays, const Ray& ray,
               const ElementHit& hit) const;

 private:
  struct Patch {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // zero: it is not flat
    double radius2 = 0.0;                              // m^2, of a sphere around its corners
    double area = 0.0;                                 // m^2
    double power = 0.0;                                // W, all columns
    int first = 0, end = 0;                            // elements_
  };
  struct Element {
    int number = -1;
    double up_to = 0.0;           // running sum of shares of the patch's power
    double share_per_area = 0.0;  // 1/m^2
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  };

  // `of_element`: brightness of every element of the mesh.
  void add_patch(int p, const std::vector<double>& of_element);

  const PatchMesh* mesh_ = nullptr;
  std::vector<Patch> patches_{};
  std::vector<Element> elements_{};
  std::vector<int> of_element_{};  // in elements_; -1: none
  std::vector<int> patch_of_{};    // of elements_, in patches_
};

}  // namespace lightwell
