#pragma once

#include <cstddef>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/sky/noise_goal.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// Irradiance that errors at a point are relative to, W/m^2: the mean irradiance of the part of the
/// scene or a quarter of the point's own, whichever is more. (With the mean alone, the inside of a
/// lamp shade, a thousand times as bright as the room, would decide over the whole room.)
double error_reference(double mean_irradiance, double own_irradiance);

/// The goal of a noise that is `share` of error_reference() for a part's mean irradiance, W/m^2.
NoiseGoal noise_goal(double mean_irradiance, double share);

/// Per patch, 1 if errors of its irradiance count: if it reflects, since others see its light;
/// where nothing reflects, if it does not emit, since such surfaces are there to be measured. 0
/// where SceneParts::is_judged() is false.
std::vector<char> judged_patches(const PatchMesh& mesh, const SceneParts& parts);

/// The mean irradiance of each part of a scene, by which errors in the part are judged. A part with
/// less than 1e-4 of the brightest part's mean is judged by that share of the mean: 10 lx beside
/// sunlit ground of 100 000 lx. Parts with less than 2 % of all area, such as the inside of a
/// lamp's housing, are not the brightest. Keeps a reference to the parts.
class PartMeans {
 public:
  explicit PartMeans(const SceneParts& parts);

  /// Counts irradiance, W/m^2, of an area, m^2, of a patch.
  void add(int patch, double area, double irradiance);
  /// Forms the references, after the last add().
  void finish();

  /// The irradiance by which errors on a patch or in a part are judged, W/m^2.
  double of_patch(int patch) const { return of_part(parts_.judged_with(patch)); }
  double of_part(int part) const { return judged_by_[static_cast<std::size_t>(part)]; }
  /// Area counted in a part, m^2.
  double area(int part) const { return area_[static_cast<std::size_t>(part)]; }
  /// 1e-4 of the brightest part's mean, W/m^2.
  double least() const { return least_; }

 private:
  const SceneParts& parts_;
  std::vector<double> sum_, area_, judged_by_;
  double least_ = 0.0;
};

/// The means of the parts, for `irradiance` at vertices (vertices x bands), over all
/// judged_patches().
PartMeans part_means(const PatchMesh& mesh, const BandArray& irradiance, const SceneParts& parts);

/// error_reference() of every element, W/m^2, for `irradiance` at vertices (vertices x bands). The
/// mean of a part is taken over its judged_patches(), an element's own irradiance over its corners.
Eigen::ArrayXd error_references(const PatchMesh& mesh, const BandArray& irradiance,
                                const SceneParts& parts = {});

/// The squared range of `irradiance` (vertices x bands) over the corners of an element, mean of the
/// bands, (W/m^2)^2: linear interpolation errs by a share of the range.
double squared_range(const PatchMesh& mesh, const BandArray& irradiance, int element);

/// Range of irradiance, relative to error_reference(), that stands for shadows that no corner of an
/// element sees.
inline constexpr double unseen_range = 0.05;

}  // namespace lightwell
