#pragma once

#include <span>
#include <vector>

#include "daylight/annual_metrics.h"
#include "daylight/daylight_glare.h"
#include "daylight/operated_year.h"

namespace lightwell {

/// Collects what the glare of eyes needs while a year is computed. The eyes are sensors of the
/// model, which face where the eyes look.
class GlareCount {
 public:
  /// Keeps references. `first_sensor` is the model's sensor of the first eye.
  GlareCount(std::span<const Camera> eyes, Eigen::Index first_sensor,
             std::span<const SkyHour> hours, double ground_reflectance);

  /// Adds the contrast of sky and ground in a computation; computations come in order.
  void add_computation(const DaylightModel& model);
  /// Adds the light of a block of the year; blocks come in order.
  void add_light(const HourBlock& block);
  /// Glare of each eye, for `states` of the windows in each hour. `occupied_hours` is their number
  /// in the year.
  std::vector<GlareOfYear> finish(const WindowPlan& plan, const Eigen::ArrayXXi& states,
                                  const Occupancy& occupancy, int occupied_hours) const;

 private:
  std::span<const Camera> eyes_;
  Eigen::Index first_sensor_;
  std::span<const SkyHour> hours_;
  double ground_reflectance_;
  std::vector<Eigen::ArrayXXd> contrast_{};  // of each computation, hours x eyes
  Eigen::ArrayXXf vertical_, sunlight_;      // lx, hours x eyes
  Eigen::Index added_ = 0;                   // hours of light
};

}  // namespace lightwell
