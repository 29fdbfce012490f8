#include "daylight/glare_of_year.h"

#include <algorithm>

namespace lightwell {

GlareCount::GlareCount(std::span<const Camera> eyes, Eigen::Index first_sensor,
                       std::span<const SkyHour> hours, double ground_reflectance)
    : eyes_(eyes),
      first_sensor_(first_sensor),
      hours_(hours),
      ground_reflectance_(ground_reflectance) {
  vertical_.resize(static_cast<Eigen::Index>(hours.size()), static_cast<Eigen::Index>(eyes.size()));
  sunlight_.resizeLike(vertical_);
}

void GlareCount::add_computation(const DaylightModel& model) {
  Eigen::ArrayXXd contrast(vertical_.rows(), vertical_.cols());
  for (std::size_t e = 0; e < eyes_.size(); ++e) {
    contrast.col(static_cast<Eigen::Index>(e)) =
        sky_contrast(model, glare_view(model, eyes_[e]), hours_, ground_reflectance_);
  }
  contrast_.push_back(std::move(contrast));
}

void GlareCount::add_light(const HourBlock& block) {
  const auto hours = static_cast<Eigen::Index>(block.hours.size()), eyes = vertical_.cols();
  vertical_.middleRows(added_, hours) = block.total.middleRows(first_sensor_, eyes).transpose();
  sunlight_.middleRows(added_, hours) = block.sunlight.middleRows(first_sensor_, eyes).transpose();
  added_ += hours;
}

std::vector<GlareOfYear> GlareCount::finish(const WindowPlan& plan, const Eigen::ArrayXXi& states,
                                            const Occupancy& occupancy, int occupied_hours) const {
  std::vector<GlareOfYear> found;
  for (std::size_t e = 0; e < eyes_.size(); ++e) {
    GlareOfYear glare{.name = eyes_[e].name};
    const auto eye = static_cast<Eigen::Index>(e);
    for (std::size_t n = 0; n < hours_.size(); ++n) {
      const auto hour = static_cast<Eigen::Index>(n);
      const WindowStates in_hour = states_of_hour(states, hour);
      double contrast = 0.0;
      for (std::size_t c = 0; c < contrast_.size(); ++c) {
        contrast += plan.weight(c, in_hour) * contrast_[c](hour, eye);
      }
      contrast =
          std::max(contrast, 0.0) + sun_contrast(eyes_[e], hours_[n], double{sunlight_(hour, eye)});
      const float lux = vertical_(hour, eye);
      glare.vertical_lux.push_back(lux);
      glare.dgp.push_back(static_cast<float>(daylight_glare_probability(double{lux}, contrast)));
    }
    count_glare(hours_, occupancy, occupied_hours, glare);
    found.push_back(std::move(glare));
  }
  return found;
}

}  // namespace lightwell
