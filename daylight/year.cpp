#include "daylight/year.h"

#include <algorithm>
#include <vector>

namespace lightwell {
namespace {

// Hours whose suns are solved together.
constexpr std::size_t block_hours = 512;

}  // namespace

void simulate_year(const DaylightModel& model, const SkyCoefficients& sky,
                   std::span<const SkyHour> hours, double ground_reflectance,
                   const std::function<void(const HourBlock&)>& visit) {
  for (std::size_t first = 0; first < hours.size(); first += block_hours) {
    HourBlock block{.hours = hours.subspan(first, std::min(block_hours, hours.size() - first))};
    block.total =
        (sky.matrix() * hour_luminances(model.sky(), block.hours, ground_reflectance).matrix())
            .array();
    block.sunlight = Eigen::ArrayXXf::Zero(block.total.rows(), block.total.cols());
    std::vector<SunDisc> suns;
    std::vector<Eigen::Index> hour_of_sun;
    for (std::size_t h = 0; h < block.hours.size(); ++h) {
      if (!(block.hours[h].sun_lux > 0.0)) continue;
      suns.emplace_back(model.sky(), block.hours[h].sun);
      hour_of_sun.push_back(static_cast<Eigen::Index>(h));
    }
    const SensorLight sun = model.sun_coefficients(suns);
    for (std::size_t s = 0; s < suns.size(); ++s) {
      const Eigen::Index h = hour_of_sun[s];
      const auto column = static_cast<Eigen::Index>(s);
      const auto lux = static_cast<float>(block.hours[static_cast<std::size_t>(h)].sun_lux);
      block.sunlight.col(h) = lux * sun.direct.col(column);
      block.total.col(h) += block.sunlight.col(h) + lux * sun.reflected.col(column);
    }
    visit(block);
  }
}

Eigen::ArrayXf daylight_factors(const DaylightModel& model, const SkyCoefficients& sky,
                                double ground_reflectance) {
  return (sky.matrix() * overcast_luminances(model.sky(), ground_reflectance).matrix()).array();
}

}  // namespace lightwell
